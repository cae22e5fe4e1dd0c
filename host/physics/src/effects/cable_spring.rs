//! Cable spring: a cable across the joint pulls it toward a rest angle.

use super::{AtRest, EffectInfo, JointState, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};

/// -k (q - q_0).
#[derive(Debug)]
pub struct CableSpring;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "cable_spring",
    title: "cable spring",
    aliases: &[
        "cable",
        "cable drag",
        "wire stiffness",
        "harness",
        "hose",
        "wire",
        "parallel spring",
        "joint spring",
        "spring",
        "stiffness",
    ],
    site: Site::Joint,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "torque = -stiffness_nm_rad * (q - rest_angle_rad)",
    parameters: &[
        Parameter::of("stiffness_nm_rad", "torque per angle")
            .off(0.0)
            .typical(0.002, 0.1)
            .bounds(0.0, 50.0)
            .starts(&[0.01, 0.05]),
        Parameter::of("rest_angle_rad", "angle at which the cable does not pull")
            .typical(-1.6, 1.6)
            .bounds(-3.2, 3.2)
            .starts(&[0.0, -1.0, 1.0]),
    ],
    looks_like: "a static error that is a straight line over the joint angle, the same at every \
     speed",
    confused_with: &[
        "torque_offset: over a short range far from its rest angle a spring pulls alike; go \
         further",
        "pre_sliding: both are sprung about a point; that of a cable stays where it is",
        "mass: near hanging, gravity is a straight line over angle too; turn the rig or add a \
         mass, which leaves the cable alone",
        "com_angle: both shift where the arm rests; the cable keeps its angle at the joint when \
         the rig is turned",
        "cogging: over a short range one ripple is a straight line too; go around a wider range",
    ],
    experiment: "hold the joint still at many angles over its whole range, then repeat with the \
     cable loosened",
    reference: "Hooke, Lectures de Potentia Restitutiva (1678)",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "force = -stiffness_n_m * (q - rest_m)",
    parameters: &[
        Parameter::of("stiffness_n_m", "force per displacement")
            .off(0.0)
            .typical(0.1, 50.0)
            .bounds(0.0, 100000.0)
            .starts(&[1.0, 10.0]),
        Parameter::of("rest_m", "displacement at which the cable does not pull")
            .typical(-0.5, 0.5)
            .bounds(-10.0, 10.0)
            .starts(&[0.0, -0.3, 0.3]),
    ],
    ..INFO
};

impl Law for CableSpring {
    fn torque(&self, values: &[f64], at: &JointState) -> f64 {
        let [stiffness_nm_rad, rest_rad] = values else {
            return 0.0;
        };
        -stiffness_nm_rad * (at.angle_rad - rest_rad)
    }

    fn slope(&self, values: &[f64], _at: &AtRest) -> Option<Slope> {
        Some(Slope {
            per_rad: -values[0],
            ..Slope::NONE
        })
    }
}
