//! Names and units of states and inputs, and the default limits of inputs.

use super::integral::Integral;
use crate::model::{Drive, JointNames, Model};
use std::f64::consts::{FRAC_PI_2, PI};

/// What a weight is by definition, m/s^2.
const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// A state or an input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signal {
    /// `q1`, `dq1`, `u2(k-1)`; inputs by their joint: `u2`. Where joints have names `q_elbow`,
    /// `dq_elbow`, `u_elbow`.
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
}

/// The name of a signal of a joint, counted from 0.
pub(super) fn of_joint(prefix: &str, model: &Model, joint: usize) -> String {
    match JointNames::of(model).joint(joint + 1) {
        Some(name) => format!("{prefix}_{name}"),
        None => format!("{prefix}{}", joint + 1),
    }
}

/// The input of a driven joint.
pub(super) fn input(model: &Model, joint: usize) -> Signal {
    Signal {
        name: of_joint("u", model, joint),
        unit: {
            let [place, speed, torque] = model.joints[joint].units();
            match model.joints[joint].drive {
                Drive::Passive | Drive::Duty(_) => "1",
                Drive::Torque => torque,
                Drive::Position { .. } => place,
                Drive::Speed { .. } => speed,
            }
        },
    }
}

/// The largest input that makes sense for a drive whose pose takes `held`: its torque limit where
/// the model has one, else 2 N m (the torque at which the paper's servos saturate), of a slide the
/// weight of what it carries, and twice what the pose takes at least; full duty; half a turn, and a
/// quarter beyond what the pose takes at least, or a metre and half of one; the no-load speed.
pub(super) fn default_limit(model: &Model, joint: usize, held: f64) -> f64 {
    let limit = model
        .effects_at(joint)
        .find(|e| e.effect.info().id == "torque_saturation")
        .and_then(|e| e.values.first().copied());
    let slides = model.joints[joint].slide.is_some();
    match &model.joints[joint].drive {
        Drive::Passive | Drive::Duty(_) => 1.0,
        Drive::Torque => limit.unwrap_or_else(|| {
            let usual = if slides {
                STANDARD_GRAVITY_M_S2 * model.carried_kg(joint)
            } else {
                2.0
            };
            usual.max(2.0 * held.abs())
        }),
        Drive::Position { .. } if slides => (held.abs() + 0.5).max(1.0),
        Drive::Position { .. } => (held.abs() + FRAC_PI_2).max(PI),
        Drive::Speed { motor, .. } if motor.no_load_speed_rad_s.is_finite() => {
            motor.no_load_speed_rad_s
        }
        Drive::Speed { .. } => 10.0,
    }
}

/// Angles, speeds, sums of angles, then past inputs, the latest first.
pub(super) fn states(
    model: &Model,
    inputs: &[Signal],
    integral: Option<&Integral>,
    delayed: usize,
) -> Vec<Signal> {
    let of = |prefix: &'static str, order: usize| {
        (0..model.link_count()).map(move |joint| Signal {
            name: of_joint(prefix, model, joint),
            unit: model.joints[joint].units()[order],
        })
    };
    let past = (1..=delayed).flat_map(|k| {
        inputs.iter().map(move |input| Signal {
            name: format!("{}(k-{k})", input.name),
            unit: input.unit,
        })
    });
    let sums = integral.map(|integral| integral.signals(model));
    let own = of("q", 0).chain(of("dq", 1));
    own.chain(sums.into_iter().flatten()).chain(past).collect()
}
