//! Balancing a simulated robot whose line dies.

use super::*;
use crate::deploy::{self, Board, BoardLaw};
use crate::error::Result;
use crate::link::SerialLink;
use crate::link::virtual_cm5::{Cm5Port, SimLink, set_up, spec};
use crate::model::Model;
use crate::synth::controllers::BoardTiming;
use handstand_cm5_sim::RobotState;
use handstand_shared::message::ArmLimits;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::sync::{Arc, mpsc::channel};
use std::time::Duration;

/// A line that somebody cuts: nothing passes any more, but time does.
struct Cut<L> {
    inner: L,
    is_cut: Arc<AtomicBool>,
}

impl<L: SerialLink> SerialLink for Cut<L> {
    fn send(&mut self, bytes: &[u8]) -> Result<()> {
        if self.is_cut.load(Ordering::Relaxed) {
            Ok(())
        } else {
            self.inner.send(bytes)
        }
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
        if !self.is_cut.load(Ordering::Relaxed) {
            return self.inner.receive(bytes, wait);
        }
        self.inner.pause(wait);
        self.inner.clear()?;
        Ok(0)
    }

    fn name(&self) -> &str {
        self.inner.name()
    }

    fn baud(&self) -> u32 {
        self.inner.baud()
    }

    fn set_baud(&mut self, baud: u32) -> Result<()> {
        self.inner.set_baud(baud)
    }

    fn clear(&mut self) -> Result<()> {
        self.inner.clear()
    }

    fn now(&self) -> Duration {
        self.inner.now()
    }

    fn pause(&mut self, time: Duration) {
        self.inner.pause(time);
    }

    fn latency(&self) -> Duration {
        self.inner.latency()
    }
}

/// A robot that is balanced, its true states, and how its line is cut.
type Standing = (
    Balancer<Cut<SimLink<Cm5Port>>>,
    Receiver<RobotState>,
    Arc<AtomicBool>,
);

fn standing() -> Standing {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/handstand.toml");
    let spec = spec(&format!("ids=1-18,delay=0,robot={file},start=held")).unwrap();
    let mut bus = set_up(&spec).unwrap();
    let (tell, states) = channel();
    let (pass, passed) = channel();
    bus.robot().unwrap().watch_every(1e-3, tell);
    let upright_rad = std::f64::consts::FRAC_PI_2;
    let ask = move || {
        let state: RobotState = states.try_iter().last()?;
        let attitude = handstand_shared::message::Attitude {
            angle: ((state.angle_rad[0] - upright_rad) * 1e4).round() as i16,
            rate: (state.speed_rad_s[0] * 1e3).round() as i16,
        };
        let _ = pass.send(state);
        Some(attitude)
    };
    let is_cut = Arc::new(AtomicBool::new(false));
    let link = Cut {
        inner: SimLink(Cm5Port::new(bus)),
        is_cut: is_cut.clone(),
    };
    let source = AttitudeSource::Simulated(Box::new(ask));
    let ids: Vec<u8> = (1..=18).collect();
    let mut balancer = Balancer::new(link, &ids, source).unwrap();
    let board = Board {
        dead_zone: [0.0; 2],
        ..Board::BIOLOID
    };
    let model = Model::load(file.as_ref()).unwrap();
    let machine = deploy::observer_design(&model, &board, &BoardTiming::HOST_ATTITUDE).unwrap();
    let plan = deploy::plan(&model, BoardLaw::Observer(&machine), &board).unwrap();
    assert!(balancer.deploy(&plan, |_| {}).unwrap());
    assert!(!balancer.deploy(&plan, |_| {}).unwrap(), "it is there");
    let changes = balancer.wheel_changes(&plan).unwrap();
    assert_eq!(changes.len(), 4, "{changes:?}");
    balancer.set_up(&changes).unwrap();
    assert_eq!(balancer.wheel_changes(&plan).unwrap(), []);
    balancer.make_ready(&plan).unwrap();
    balancer.arm(ArmLimits::FULL).unwrap();
    for _ in 0..200 {
        balancer.step().unwrap();
        assert_eq!(balancer.end().unwrap(), None);
    }
    (balancer, passed, is_cut)
}

#[test]
fn a_robot_is_let_down_when_told() {
    let (mut balancer, states, _) = standing();
    let begun = balancer.link().now();
    let outcome = balancer.let_down(BalanceEnd::Finished).unwrap();
    assert_eq!(outcome.end, BalanceEnd::Finished);
    assert!((1.9..2.2).contains(&outcome.balanced_s), "{outcome:?}");
    let took = balancer.link().now() - begun;
    assert!(took > Duration::from_millis(150), "{took:?}: softly");
    assert!(took < Duration::from_millis(600), "{took:?}");
    let last = states.try_iter().last().unwrap();
    assert!(last.drive.iter().flatten().all(|drive| !drive.torque_on));
}

#[test]
fn a_dead_line_lets_the_robot_down() {
    let (mut balancer, _, is_cut) = standing();
    let begun = balancer.link().now();
    is_cut.store(true, Ordering::Relaxed);
    let error = balancer.step().unwrap_err();
    assert_eq!(error.exit_code(), 4);
    assert!(error.to_string().contains("sent nothing"), "{error}");
    // When the line is back, the CM-5 has done it by itself, and says why.
    balancer.link().pause(Duration::from_millis(100));
    is_cut.store(false, Ordering::Relaxed);
    balancer.step().unwrap();
    let outcome = balancer.end().unwrap().unwrap();
    assert!(outcome.is_safety_stop());
    let words = outcome.words();
    // Balancing, it misses the attitude sooner than the line.
    assert!(words.contains("no attitude came"), "{words}");
    let silence_ms = outcome.account.unwrap().longest_silence_ms;
    assert!(
        (160..=300).contains(&silence_ms),
        "until torque is off: {silence_ms} ms"
    );
    assert!(balancer.link().now() - begun < Duration::from_secs(2));
}
