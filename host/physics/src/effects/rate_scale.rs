//! Rate scale: a gyro or tachometer reads a share of the rate.

use super::{EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site};

/// s w.
#[derive(Debug)]
pub struct RateScale;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "rate_scale",
    title: "scale of the rate sensor",
    aliases: &[
        "gyro scale",
        "gyro gain",
        "gyroscope scale factor",
        "tachometer gain",
        "gain",
        "gain error",
    ],
    site: Site::Rate,
    scope: Scope::AnyJoint,
    needs: Needs::RateSensor,
    on_slide: OnSlide::Never,
    law: "reading = factor * d(q)/dt",
    parameters: &[Parameter::of("factor", "rate read over true rate")
        .off(1.0)
        .typical(0.95, 1.05)
        .bounds(0.5, 2.0)
        .starts(&[0.98, 1.02])],
    looks_like: "an error of the rate in proportion to the rate, none at rest; the angle of the \
     same joint is read rightly",
    confused_with: &[
        "rate_lag: both lower the reading of fast motion; a filter reads a steady rate rightly",
    ],
    experiment: "turn steadily through a known angle and integrate the rate: it comes out larger \
     or smaller by the factor",
    reference: "IEEE Std 952-1997, section 5.3",
};

impl Law for RateScale {
    fn rate_scale(&self, values: &[f64]) -> f64 {
        values[0]
    }
}
