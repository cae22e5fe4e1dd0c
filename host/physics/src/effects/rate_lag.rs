//! Rate lag: the reading of a gyro or tachometer is low-pass filtered.

use super::sensor_lag::filtered;
use super::{
    EffectInfo, Encoded, Law, Needs, OnSlide, Parameter, Scope, SenseMemory, Site, StartUnknown,
};

/// T y' + y = w, as `sensor_lag` filters an angle.
#[derive(Debug)]
pub struct RateLag;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "rate_lag",
    title: "lag of the rate sensor",
    aliases: &[
        "gyro lag",
        "gyro filter",
        "gyro bandwidth",
        "tachometer filter",
        "lag",
        "low-pass",
        "low-pass filter",
    ],
    site: Site::Rate,
    scope: Scope::AnyJoint,
    needs: Needs::RateSensor,
    on_slide: OnSlide::Never,
    law: "time_constant_s * d(reading)/dt + reading = d(q)/dt",
    parameters: &[
        Parameter::of("time_constant_s", "time constant of the filter")
            .off(0.0)
            .typical(0.002, 0.05)
            .bounds(0.0, 1.0)
            .starts(&[0.01, 0.04]),
    ],
    looks_like: "the rate trails in proportion to the acceleration and rounds off fast motion; a \
     steady rate, and the angle of the same joint, are read rightly",
    confused_with: &[
        "rate_scale: both lower the reading of fast motion; a scale lowers slow motion's alike",
    ],
    experiment: "drive a chirp: the rate shrinks and trails the slope of the angle by at most a \
     quarter of a period",
    reference: "Ljung, System Identification, 2nd ed., section 4.2",
};

impl Law for RateLag {
    fn trail_rad(&self, values: &[f64], speed_rad_s: f64) -> Option<f64> {
        Some(values[0] * speed_rad_s)
    }

    /// It trails as the slope of its readings says.
    fn start_unknown(&self, _values: &[f64]) -> Option<StartUnknown> {
        Some(StartUnknown::Nothing)
    }

    fn sense(
        &self,
        values: &[f64],
        memory: &mut Option<SenseMemory>,
        encoded: Encoded,
        step_s: f64,
    ) -> f64 {
        filtered(values[0], memory, encoded, step_s)
    }
}
