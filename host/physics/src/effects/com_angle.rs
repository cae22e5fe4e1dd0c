//! Centre-of-mass angle: the centre of mass lies beside the line between the joints.

use super::{EffectInfo, Law, Needs, OnSlide, Parameter, Rig, Scope, Site};

/// m g l_c sin(q + a), for a link that hangs at q = 0.
#[derive(Debug)]
pub struct ComAngle;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "com_angle",
    title: "angle of the centre of mass",
    aliases: &[
        "centre of mass offset",
        "center of mass offset",
        "COM offset",
        "off-axis mass",
        "eccentricity",
        "imbalance",
        "unbalance",
    ],
    site: Site::Body,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "the centre of mass of the link is turned by angle_rad about its joint",
    parameters: &[Parameter::of(
        "angle_rad",
        "angle of the centre of mass off its place in the model",
    )
    .off(0.0)
    .typical(-0.2, 0.2)
    .bounds(-3.2, 3.2)
    .starts(&[0.05, -0.05])],
    looks_like: "a static error that follows the cosine of the angle from hanging; the arm hangs \
     off its zero",
    confused_with: &[
        "torque_offset: near hanging both pull one way; turn the arm by 90 degrees",
        "encoder_zero: both shift the angle at which gravity vanishes; in a chain an encoder \
         offset turns the outer links too",
        "base_tilt: both shift the angle at which gravity vanishes; turn the rig by 180 degrees: \
         a tilt keeps its side in the world, this one its side of the body",
        "cable_spring: both shift where the arm rests; turn the rig, and the cable keeps its \
         angle at the joint",
        "cogging: a ripple of one period per turn looks the same; with the axis upright only the \
         ripple remains",
        "direction_asymmetry: both pull one way; the asymmetry is gone at rest",
    ],
    experiment: "let the arm hang freely and read its angle, then turn the rig by 180 degrees and \
     read it again",
    reference: "An, Atkeson, Hollerbach, Model-Based Control of a Robot Manipulator (1988)",
};

impl Law for ComAngle {
    fn acts_in_space(&self) -> bool {
        false
    }

    fn body(&self, values: &[f64], joint: usize, rig: &mut Rig) {
        rig.chain.links[joint].com_angle_rad += values[0];
    }
}
