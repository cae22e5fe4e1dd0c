//! Friction over position: gears, cables and bearings run heavier at some angles than at others.

use super::{EffectInfo, FrictionState, Law, Needs, OnSlide, Parameter, Scope, Site};

/// A table of three entries: 0 at the model's zero, two values at +-span, straight lines between
/// them, and constant beyond.
#[derive(Debug)]
pub struct PositionFriction;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "position_friction",
    title: "friction that changes with the angle",
    aliases: &[
        "position-dependent friction",
        "angle-dependent friction",
        "tight spot",
        "binding",
        "friction",
    ],
    site: Site::Friction,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "friction = below_nm * min(-q / span_rad, 1) for q < 0, above_nm * min(q / span_rad, 1) \
     for q > 0",
    parameters: &[
        Parameter::of("below_nm", "what is added at -span_rad and beyond")
            .off(0.0)
            .typical(0.0, 0.06)
            .bounds(-5.0, 5.0)
            .starts(&[0.02, 0.004]),
        Parameter::of("above_nm", "what is added at +span_rad and beyond")
            .off(0.0)
            .typical(0.0, 0.06)
            .bounds(-5.0, 5.0)
            .starts(&[0.01]),
        Parameter::of("span_rad", "angle from which on it grows no more")
            .typical(0.3, 1.5)
            .bounds(0.05, 6.3)
            .starts(&[0.6]),
    ],
    looks_like: "the loop over angle is wide at some angles and narrow at others, at every speed \
     and load",
    confused_with: &[
        "coulomb: both oppose the motion at every speed; compare the width of the loop over angle",
        "load_friction: gravity loads the gear more the farther the arm is raised; change the mass",
        "drive_asymmetry: lifting and lowering differ over angle too; change the mass",
    ],
    experiment: "move in slow triangles over the whole range: the width of the loop must change \
     with the angle, and stay so under another load",
    reference: "Armstrong, Proc. IEEE ICRA (1988) 1188: friction over the position of a PUMA's \
     joints",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "friction = below_n * min(-q / span_m, 1) for q < 0, above_n * min(q / span_m, 1) for \
     q > 0",
    parameters: &[
        Parameter::of("below_n", "what is added at -span_m and beyond")
            .off(0.0)
            .typical(0.0, 5.0)
            .bounds(-1000.0, 1000.0)
            .starts(&[0.3, 0.05]),
        Parameter::of("above_n", "what is added at +span_m and beyond")
            .off(0.0)
            .typical(0.0, 5.0)
            .bounds(-1000.0, 1000.0)
            .starts(&[0.1]),
        Parameter::of("span_m", "displacement from which on it grows no more")
            .typical(0.05, 0.5)
            .bounds(0.001, 10.0)
            .starts(&[0.2]),
    ],
    ..INFO
};

impl Law for PositionFriction {
    fn difference(&self) -> f64 {
        5e-3
    }

    fn friction(&self, values: &[f64], at: &FrictionState) -> f64 {
        let [below, above, span] = values else {
            return 0.0;
        };
        let side = if at.angle_rad < 0.0 { below } else { above };
        side * (at.angle_rad.abs() / span).min(1.0)
    }
}
