//! Servos that do not answer a CM-5, from the beginning or from some moment on.

use super::*;
use crate::error::Result;
use crate::virtual_cm5::{Cm5Port, SimLink, set_up, spec};

fn stream(words: &str, ids: &[u8]) -> Stream<SimLink<Cm5Port>> {
    let bus = set_up(&spec(words).unwrap()).unwrap();
    Stream::new(SimLink(Cm5Port::new(bus)), ids).unwrap()
}

/// Servos of which the second falls silent after so many samples of a motion.
struct Fading {
    source: Stream<SimLink<Cm5Port>>,
    samples: usize,
}

impl SampleSource for Fading {
    fn sample(&mut self, goals_rad: Option<&[f64]>) -> Result<Option<RobotSample>> {
        let mut sample = self.source.sample(goals_rad)?;
        if self.samples == 0 {
            let joints = sample.iter_mut().flat_map(|sample| &mut sample.joints);
            joints
                .skip(1)
                .for_each(|joint| *joint = ServoSample::default());
        }
        self.samples = self.samples.saturating_sub(1);
        Ok(sample)
    }

    fn may_reach(&mut self, goals: &[GoalRange]) -> Result<()> {
        self.source.may_reach(goals)
    }

    fn arm(&mut self) -> Result<()> {
        self.source.arm()
    }

    fn disarm(&mut self) -> Result<()> {
        self.source.disarm()
    }

    fn emergency_off(&mut self) -> Option<EmergencyOff> {
        None
    }

    fn danger(&self) -> Option<String> {
        self.source.danger()
    }
}

#[test]
fn a_cm5_is_not_armed_where_a_servo_never_answers() {
    for (words, ids, silent) in [
        ("ids=1-2,delay=0", [1, 2, 11, 12], 11),
        ("ids=1-4,delay=0,dead=3", [1, 2, 3, 4], 3),
    ] {
        let mut source = stream(words, &ids);
        let error = source.arm().unwrap_err();
        let said = format!("servo {silent}: no status packet");
        assert_eq!(error.to_string(), said, "{words}");
        assert_eq!(error.exit_code(), 4, "{words}");
        assert!(error.remedy().unwrap().contains("bus doctor"), "{words}");
        let sample = source.sample(None).unwrap().unwrap();
        assert_ne!(sample.torque_on, Some(true), "{words}");
    }
    // Answers that are lost now and then are no silence.
    stream("ids=1-4,delay=0,drop=0.2", &[1, 2, 3, 4])
        .arm()
        .unwrap();
}

#[test]
fn a_servo_that_falls_silent_on_the_way_is_told() {
    let times = (0..=100).map(|k| f64::from(k) * 0.01);
    let motion = GoalMotion {
        time_s: times.collect(),
        goals_rad: vec![vec![0.0; 2]; 101],
        measured_rad: vec![vec![None; 2]; 101],
        torque_on: vec![true; 101],
    };
    for (samples, missed) in [(usize::MAX, [None, None]), (40, [None, Some(0.6)])] {
        let mut source = Fading {
            source: stream("ids=1-2,delay=0", &[1, 2]),
            samples,
        };
        let followed = follow(&motion, &mut source, None, &|| true, &|_| {}).unwrap();
        assert_eq!(followed.stopped, None);
        for (silence, missed) in followed.silences.iter().zip(missed) {
            let (share, missed) = (silence.share(), missed.unwrap_or(-1.0));
            assert!((share.unwrap_or(-1.0) - missed).abs() < 0.05, "{share:?}");
        }
        assert_eq!(followed.silences.len(), 2);
    }
}
