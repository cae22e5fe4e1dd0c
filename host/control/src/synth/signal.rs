//! Names and units of states and inputs, and the default limits of inputs.

use super::integral::Integral;
use crate::model::{Drive, Model};

/// What a weight is by definition, m/s^2.
const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

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

/// The largest input that makes sense for a drive: its torque limit where the model has one, else 2
/// N m (the torque at which the paper's servos saturate), of a slide the weight of what it carries;
/// full duty; half a turn, or a metre; the no-load speed.
pub(super) fn default_limit(model: &Model, joint: usize) -> f64 {
    let limit = model
        .effects_at(joint)
        .find(|e| e.effect.info().id == "torque_saturation")
        .and_then(|e| e.values.first().copied());
    let slides = model.joints[joint].slide.is_some();
    match &model.joints[joint].drive {
        Drive::Passive | Drive::Duty(_) => 1.0,
        Drive::Torque if slides => limit.unwrap_or_else(|| {
            let carried = model.links[joint..].iter().map(|link| link.mass_kg);
            STANDARD_GRAVITY_M_S2 * carried.sum::<f64>()
        }),
        Drive::Torque => limit.unwrap_or(2.0),
        Drive::Position { .. } if slides => 1.0,
        Drive::Position { .. } => std::f64::consts::PI,
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
            name: format!("{prefix}{}", joint + 1),
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
