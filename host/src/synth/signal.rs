//! Names and units of states and inputs, and the default limits of inputs.

use crate::model::{Drive, Model};

/// A state or an input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signal {
    /// `q1`, `dq1`, `u2(k-1)`; inputs by their joint: `u2`.
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
}

/// The input of a driven joint.
pub(super) fn input(model: &Model, joint: usize) -> Signal {
    Signal {
        name: format!("u{}", joint + 1),
        unit: match model.joints[joint].drive {
            Drive::Passive | Drive::Duty(_) => "1",
            Drive::Torque => "N m",
            Drive::Position { .. } => "rad",
            Drive::Speed { .. } => "rad/s",
        },
    }
}

/// The largest input that makes sense for a drive: its torque limit where the model has one, else 2
/// N m (the torque at which the paper's servos saturate); full duty; half a turn; the no-load
/// speed.
pub(super) fn default_limit(model: &Model, joint: usize) -> f64 {
    let limit = model
        .effects_at(joint)
        .find(|e| e.effect.info().id == "torque_saturation")
        .and_then(|e| e.values.first().copied());
    match &model.joints[joint].drive {
        Drive::Passive | Drive::Duty(_) => 1.0,
        Drive::Torque => limit.unwrap_or(2.0),
        Drive::Position { .. } => std::f64::consts::PI,
        Drive::Speed { motor, .. } if motor.no_load_speed_rad_s.is_finite() => {
            motor.no_load_speed_rad_s
        }
        Drive::Speed { .. } => 10.0,
    }
}

/// Angles, speeds, then past inputs, the latest first.
pub(super) fn states(joints: usize, inputs: &[Signal], delayed: usize) -> Vec<Signal> {
    let of = |prefix: &'static str, unit: &'static str| {
        (1..=joints).map(move |joint| Signal {
            name: format!("{prefix}{joint}"),
            unit,
        })
    };
    let past = (1..=delayed).flat_map(|k| {
        inputs.iter().map(move |input| Signal {
            name: format!("{}(k-{k})", input.name),
            unit: input.unit,
        })
    });
    of("q", "rad")
        .chain(of("dq", "rad/s"))
        .chain(past)
        .collect()
}
