//! Rate bias: a gyro reads a rate at rest.

use super::{EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site};

/// w + b.
#[derive(Debug)]
pub struct RateBias;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "rate_bias",
    title: "bias of the rate sensor",
    aliases: &[
        "gyro bias",
        "gyro offset",
        "gyroscope bias",
        "gyro drift",
        "bias",
    ],
    site: Site::Rate,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "reading = d(q)/dt + bias_rad_s",
    parameters: &[Parameter::of("bias_rad_s", "reading at rest")
        .off(0.0)
        .typical(-0.05, 0.05)
        .bounds(-5.0, 5.0)
        .starts(&[0.02, -0.02])],
    looks_like: "a constant error of the rate, at rest, too; the angle that is integrated from it \
     drifts away",
    confused_with: &[
        "torque_offset: both show to one side; an offset of torque moves the point of rest, where \
         the rate is zero",
    ],
    experiment: "read the rate for a minute at rest, cold and warm",
    reference: "IEEE Std 952-1997, section 5.3",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "reading = d(q)/dt + bias_m_s",
    parameters: &[Parameter::of("bias_m_s", "reading at rest")
        .off(0.0)
        .typical(-0.02, 0.02)
        .bounds(-5.0, 5.0)
        .starts(&[0.01, -0.01])],
    ..INFO
};

impl Law for RateBias {
    fn rate_bias_rad_s(&self, values: &[f64]) -> f64 {
        values[0]
    }
}
