//! Cogging and gear ripple: a torque that repeats around the turn.

use super::{AtRest, EffectInfo, JointState, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};
use crate::dynamics::Lane;
use std::f64::consts::PI;

/// A sin(N q + p).
#[derive(Debug)]
pub struct Cogging;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "cogging",
    title: "cogging and gear ripple",
    aliases: &[
        "cogging torque",
        "detent torque",
        "torque ripple",
        "gear ripple",
        "ripple",
        "reluctance torque",
    ],
    site: Site::Joint,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Never,
    law: "torque = amplitude_nm * sin(periods_per_turn * q + phase_rad)",
    parameters: &[
        Parameter::of("amplitude_nm", "height of the ripple")
            .off(0.0)
            .typical(0.002, 0.1)
            .bounds(0.0, 5.0)
            .starts(&[0.01, 0.05]),
        Parameter::of(
            "periods_per_turn",
            "ripples in one turn of the joint; one or two would be gravity, not teeth or \
             poles",
        )
        .typical(4.0, 60.0)
        .bounds(3.0, 200.0)
        .starts(&[
            12.0, 4.0, 6.0, 8.0, 16.0, 20.0, 24.0, 32.0, 40.0, 48.0, 60.0, 80.0, 100.0, 150.0,
        ]),
        Parameter::of("phase_rad", "phase of the ripple at angle zero")
            .typical(-PI, PI)
            .bounds(-20.0, 20.0)
            .starts(&[0.0, PI / 2.0, PI, -PI / 2.0]),
    ],
    looks_like: "the residual torque repeats over the joint angle at every speed; in time its \
     frequency grows with the speed",
    confused_with: &[
        "cable_spring: over a short range one ripple is a straight line too; go around a wider \
         range",
        "com_angle: one period per turn is a shifted centre of mass; more than one cannot be",
        "encoder_scale: an angle read wrongly makes gravity look wrong periodically too; turn the \
         axis upright, where only the ripple remains",
    ],
    experiment: "turn slowly at two constant speeds and plot the torque over the angle: the curves \
     must lie on each other",
    reference: "Holtz, Springob, IEEE Transactions on Industrial Electronics 43 (1996) 309",
};

impl Law for Cogging {
    fn torque(&self, values: &[f64], at: &JointState) -> f64 {
        let [amplitude_nm, periods_per_turn, phase_rad] = values else {
            return 0.0;
        };
        amplitude_nm * Lane::sin_cos(periods_per_turn * at.angle_rad + phase_rad).0
    }

    fn slope(&self, values: &[f64], at: &AtRest) -> Option<Slope> {
        let [amplitude_nm, periods_per_turn, phase_rad] = values else {
            return None;
        };
        let slope = (periods_per_turn * at.angle_rad + phase_rad).cos();
        Some(Slope {
            per_rad: amplitude_nm * periods_per_turn * slope,
            ..Slope::NONE
        })
    }
}
