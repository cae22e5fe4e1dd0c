//! Torque offset: something pulls at the joint, always alike.

use super::{AtRest, EffectInfo, JointState, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};

/// A constant torque.
#[derive(Debug)]
pub struct TorqueOffset;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "torque_offset",
    title: "constant torque offset",
    aliases: &[
        "bias",
        "torque bias",
        "offset",
        "constant torque",
        "constant disturbance",
        "load bias",
    ],
    site: Site::Joint,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "torque = offset_nm, at every angle and speed, whether the drive is on or off",
    parameters: &[Parameter::of("offset_nm", "torque on the joint")
        .off(0.0)
        .typical(-0.05, 0.05)
        .bounds(-5.0, 5.0)
        .starts(&[0.01, -0.01])],
    looks_like: "the same error of torque everywhere: the joint rests beside where it should, and \
     goes one way more easily than the other",
    confused_with: &[
        "rate_bias: both show to one side; a bias of the sensor does not move the point of rest",
        "direction_asymmetry: they are one law as long as friction is larger than the offset; take \
         the friction away, and only an offset moves the joint from rest",
        "com_angle: near hanging both pull one way; turn the arm by 90 degrees",
        "cable_spring: over a short range a spring far from its rest angle pulls alike; go further",
        "encoder_zero: near hanging both move the point of rest; far from it gravity tells",
    ],
    experiment: "hold the joint still at angles all around: the difference to the model must be \
     the same torque at each",
    reference: "Gautier, Khalil, Proc. IEEE CDC (1988) 2331: offset of a joint's amplifier",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "force = offset_n, everywhere, whether the drive is on or off",
    parameters: &[Parameter::of("offset_n", "force on the joint")
        .off(0.0)
        .typical(-5.0, 5.0)
        .bounds(-1000.0, 1000.0)
        .starts(&[0.1, -0.1])],
    ..INFO
};

impl Law for TorqueOffset {
    fn torque(&self, values: &[f64], _at: &JointState) -> f64 {
        values[0]
    }

    /// What the drive holds against it is found with the pose.
    fn slope(&self, _values: &[f64], _at: &AtRest) -> Option<Slope> {
        Some(Slope::NONE)
    }
}
