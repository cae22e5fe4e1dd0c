//! Runs from starts next to each other: what a joint's drive and friction take away of a difference
//! need not be simulated twice.

use super::Run;
use crate::motion::Motion;
use crate::sim::memory::PlantMemory;
use crate::sim::plant::Plant;
use crate::sim::rows::Rows;
use crate::sim::run::StartState;
use std::ops::Range;

/// What a run of the same stretch from another start read.
#[derive(Debug, Clone, Copy)]
pub struct KnownRun<'a> {
    /// Signal after signal, as [`predict`](super::predict) leaves them; not a number where unknown.
    pub readings: &'a [f64],
    /// Per signal: readings as near as this are the same, rad or rad/s.
    pub near: &'a [f64],
}

/// Samples one after the other that must be near: angles that stay so have the same speeds.
const MEETING: usize = 3;

impl KnownRun<'_> {
    /// Whether the readings of sample `at` of `samples` are near those of the known run.
    fn meets(&self, readings: &[f64], at: usize, samples: usize) -> bool {
        self.near.iter().enumerate().all(|(signal, near)| {
            let place = signal * samples + at;
            (readings[place] - self.readings[place]).abs() <= *near
        })
    }
}

/// See [`predict_beside`](super::predict_beside).
pub(super) fn predicted<R: Rows>(
    plant: &Plant,
    motion: &Motion,
    stretch: Range<usize>,
    start: &StartState,
    known: &KnownRun,
    readings: &mut [f64],
) {
    let samples = stretch.len();
    let mut run = Run::<R>::new(plant, motion, start, PlantMemory::default());
    run.sensors.record(readings, 0, samples);
    let mut met = 0;
    for at in 1..samples {
        run.follow(stretch.start + at - 1);
        if run.has_diverged() {
            for reading in readings.chunks_mut(samples) {
                reading[at..].fill(f64::NAN);
            }
            return;
        }
        run.sensors.record(readings, at, samples);
        let meets = known.meets(readings, at, samples);
        met = if meets { met + 1 } else { 0 };
        if met == MEETING {
            let signals = readings.chunks_mut(samples);
            for (own, known) in signals.zip(known.readings.chunks(samples)) {
                own[at + 1..].copy_from_slice(&known[at + 1..]);
            }
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::model::Model;
    use crate::motion::Motion;
    use crate::sim::{KnownRun, Plant, PlantMemory, StartState, predict, predict_beside};
    use std::path::Path;

    const SAMPLES: usize = 200;
    const NEAR_RAD: f64 = 1e-7;

    /// Two links behind servos, or behind torques alone.
    fn plant(drive: &str) -> (Plant, Motion) {
        let text = format!(
            "[rig]\nname = \"a\"\nangle_zero = \"hanging\"\n\
             [[link]]\nlength_m = 0.2\ncom_m = 0.1\nmass_kg = 0.3\ninertia_kg_m2 = 1e-3\n\
             [[link]]\ncom_m = 0.1\nmass_kg = 0.2\ninertia_kg_m2 = 8e-4\n\
             [[joint]]\n{drive}[[joint]]\n{drive}\
             [log]\ntime = {{ column = \"t\", unit = \"s\" }}\n\
             [[log.joint]]\nposition = {{ column = \"q1\", unit = \"rad\" }}\n\
             input = {{ column = \"u1\", unit = \"rad\" }}\n\
             [[log.joint]]\nposition = {{ column = \"q2\", unit = \"rad\" }}\n\
             input = {{ column = \"u2\", unit = \"rad\" }}\n"
        );
        let text = if drive.contains("torque\"") {
            text.replace("u1\", unit = \"rad", "u1\", unit = \"N m")
                .replace("u2\", unit = \"rad", "u2\", unit = \"N m")
        } else {
            text
        };
        let model = Model::parse(&text, Path::new("a.toml")).unwrap();
        let time_s: Vec<f64> = (0..SAMPLES).map(|k| k as f64 * 0.01).collect();
        let input = |speed: f64| time_s.iter().map(|t| 0.4 * (speed * t).sin()).collect();
        let motion = Motion {
            position_rad: vec![vec![0.0; SAMPLES]; 2],
            velocity_rad_s: vec![None; 2],
            input: vec![Some(input(3.0)), Some(input(5.0))],
            time_s,
            ..Motion::default()
        };
        (Plant::new(&model, &motion), motion)
    }

    const SERVO: &str = "drive = \"position\"\ngain_per_rad = 5.0\nstall_torque_nm = 2.0\n\
                         no_load_speed_rad_s = 7.0\n";

    /// Readings of a run from this angle of joint 2, rad; beside a known one, or whole.
    fn read((plant, motion): &(Plant, Motion), from_rad: f64, known: Option<&[f64]>) -> Vec<f64> {
        let start = StartState {
            angle_rad: vec![0.1, from_rad],
            speed_rad_s: vec![0.0; 2],
            reading_slope: None,
        };
        let mut readings = vec![0.0; 2 * SAMPLES];
        if let Some(known) = known {
            let near = &[NEAR_RAD; 2];
            let known = KnownRun {
                readings: known,
                near,
            };
            predict_beside(plant, motion, 0..SAMPLES, &start, &known, &mut readings);
        } else {
            let mut memory = PlantMemory::default();
            predict(
                plant,
                motion,
                0..SAMPLES,
                &start,
                &mut memory,
                &mut readings,
            );
        }
        readings
    }

    #[test]
    fn a_run_that_comes_to_a_known_one_goes_on_as_that_does() {
        let arm = plant(SERVO);
        assert!(arm.0.forgets_its_start());
        let known = read(&arm, 0.2, None);
        let (whole, beside) = (read(&arm, 0.21, None), read(&arm, 0.21, Some(&known)));
        for signal in 0..2 {
            let [known, whole, beside] = [&known, &whole, &beside]
                .map(|readings| &readings[signal * SAMPLES..(signal + 1) * SAMPLES]);
            assert_eq!(whole[..10], beside[..10]);
            assert_eq!(known[180..], beside[180..]);
            for (whole, beside) in whole.iter().zip(beside) {
                // What swings may be near for a while on its way.
                assert!(
                    (whole - beside).abs() <= 10.0 * NEAR_RAD,
                    "{whole} {beside}"
                );
            }
        }
    }

    #[test]
    fn runs_that_cross_or_stay_apart_are_simulated_to_their_end() {
        let arm = plant("drive = \"torque\"\n");
        assert!(!arm.0.forgets_its_start());
        let known = read(&arm, 0.2, None);
        let (whole, beside) = (read(&arm, 0.21, None), read(&arm, 0.21, Some(&known)));
        assert_eq!(whole, beside);
        // What is not known is not met.
        let servo = plant(SERVO);
        let unknown = vec![f64::NAN; 2 * SAMPLES];
        let whole = read(&servo, 0.21, None);
        assert_eq!(whole, read(&servo, 0.21, Some(&unknown)));
    }
}
