//! Motions for tests.

use super::{Motion, MotionSource};
use std::path::PathBuf;

/// A swing sampled at 100 Hz that follows its goal.
/// A swing of one joint, sampled every 10 ms, its goal 20 ms ahead.
pub fn motion(name: &str, samples: usize) -> Motion {
    let time_s: Vec<f64> = (0..samples).map(|i| i as f64 * 0.01).collect();
    let swing = |t: &f64| 0.7 * (3.0 * t).sin();
    Motion {
        name: name.into(),
        source: MotionSource {
            path: PathBuf::from(name),
            sha256: String::new(),
            lines: (2, samples + 1),
        },
        position_rad: vec![time_s.iter().map(swing).collect()],
        velocity_rad_s: vec![None],
        rate_rad_s: vec![None],
        input: vec![Some(time_s.iter().map(|t| swing(&(t + 0.02))).collect())],
        supply_v: None,
        torque_on: None,
        payload_kg: 0.0,
        turned: false,
        time_s,
    }
}
