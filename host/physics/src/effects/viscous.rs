//! Viscous friction: resistance in proportion to speed.

use super::{AtRest, EffectInfo, JointState, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};

/// -c w.
#[derive(Debug)]
pub struct Viscous;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "viscous",
    title: "viscous friction",
    aliases: &[
        "damping",
        "damper",
        "viscous damping",
        "viscous drag",
        "linear damping",
        "linear drag",
        "dashpot",
        "friction",
    ],
    site: Site::Joint,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "torque = -coefficient_nm_s_rad * w",
    parameters: &[
        Parameter::of("coefficient_nm_s_rad", "resistance per speed")
            .off(0.0)
            .typical(0.001, 0.1)
            .bounds(0.0, 10.0)
            .starts(&[0.01, 0.05]),
    ],
    looks_like: "the residual torque is a straight line over speed; a free swing shrinks by the \
     same share every period",
    confused_with: &[
        "speed_limit: both are linear in speed; repeat the drop with the torque on and off: \
         friction remains with it off",
        "air_drag: both grow with speed; drag is weak while slow and grows with the square",
        "delay: both trail the input; friction trails less as the motion slows",
        "sensor_lag: both make the reading trail; a lag in the sensor leaves the loss of energy \
         of a free swing unchanged",
    ],
    experiment: "let the arm swing freely with the torque off and plot the logarithm of its \
     amplitude over time: a straight line",
    reference: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "force = -coefficient_n_s_m * w",
    parameters: &[Parameter::of("coefficient_n_s_m", "resistance per speed")
        .off(0.0)
        .typical(0.05, 20.0)
        .bounds(0.0, 10000.0)
        .starts(&[0.5, 5.0])],
    ..INFO
};

impl Law for Viscous {
    fn comes_with_servo(&self) -> Option<bool> {
        Some(true)
    }

    fn torque(&self, values: &[f64], at: &JointState) -> f64 {
        -values[0] * at.speed_rad_s
    }

    fn slope(&self, values: &[f64], _at: &AtRest) -> Option<Slope> {
        Some(Slope {
            per_rad_s: -values[0],
            ..Slope::NONE
        })
    }
}
