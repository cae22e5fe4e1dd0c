//! A placebo regressor, which can't be the cause: the measured speed of another moment.
//!
//! Placebos run along with the real candidates. Whatever a placebo gains, chance gains: if one
//! ranks, nothing is named (permutation control).

use super::{EffectInfo, JointState, Law, Needs, OnSlide, Parameter, Scope, Site};

/// tau = c * (measured speed, turned in time by `shift` of the motion).
#[derive(Debug)]
pub struct Placebo;

/// Id of the placebo regressor.
pub const PLACEBO: &str = "placebo";

pub(super) static INFO: EffectInfo = EffectInfo {
    id: PLACEBO,
    title: "placebo (shuffled speed)",
    aliases: &[],
    site: Site::Joint,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "torque = coefficient_nm_s_rad * speed measured at another moment",
    parameters: &[
        Parameter::of("coefficient_nm_s_rad", "weight of the shuffled speed")
            .off(0.0)
            .typical(-0.1, 0.1)
            .bounds(-10.0, 10.0)
            .starts(&[0.003, -0.003]),
    ],
    looks_like: "nothing: it has no cause",
    confused_with: &[],
    experiment: "none",
    reference: "permutation control; Good, Permutation, Parametric and Bootstrap Tests of \
     Hypotheses, 3rd ed. (2005)",
};

impl Law for Placebo {
    fn torque(&self, values: &[f64], at: &JointState) -> f64 {
        values[0] * at.shuffled_rad_s
    }
}
