//! Direction asymmetry: one direction resists more than the other.

use super::{EffectInfo, FrictionState, Law, Needs, OnSlide, Parameter, Scope, Site};

/// tau_d sgn(w): the friction is tau_c + tau_d forwards and tau_c - tau_d backwards.
#[derive(Debug)]
pub struct DirectionAsymmetry;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "direction_asymmetry",
    title: "direction asymmetry of friction",
    aliases: &[
        "asymmetric friction",
        "friction asymmetry",
        "direction-dependent friction",
        "friction",
    ],
    site: Site::Friction,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "friction += half_difference_nm * sgn(w)",
    parameters: &[Parameter::of(
        "half_difference_nm",
        "half of forward minus backward friction",
    )
    .off(0.0)
    .typical(-0.05, 0.05)
    .bounds(-5.0, 5.0)
    .starts(&[0.01, -0.01])],
    looks_like: "the residual torque has one constant sign while the joint moves, whichever way it \
     goes, and none while it rests",
    confused_with: &[
        "torque_offset: they are one law as long as friction is larger than the offset; take the \
         friction away, and only an offset moves the joint from rest",
        "encoder_zero: gravity at a shifted angle is a near constant torque too, but it is there \
         at rest and changes with the angle",
        "com_angle: a shifted centre of mass pulls one way too, also at rest; turn the arm to \
         another angle",
    ],
    experiment: "move slowly both ways through the same angles, then mount the joint reversed and \
     repeat: the sign must turn",
    reference: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "friction += half_difference_n * sgn(w)",
    parameters: &[Parameter::of(
        "half_difference_n",
        "half of forward minus backward friction",
    )
    .off(0.0)
    .typical(-2.0, 2.0)
    .bounds(-500.0, 500.0)
    .starts(&[0.3, -0.3])],
    ..INFO
};

impl Law for DirectionAsymmetry {
    fn friction(&self, values: &[f64], at: &FrictionState) -> f64 {
        values[0] * at.direction
    }

    fn friction_is_constant(&self) -> bool {
        true
    }
}
