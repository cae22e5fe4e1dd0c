//! Time offset: the column of a reading holds what the encoder read at another time.

use super::{AtRest, EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};

/// y(t) = q(t - T), of either sign. The offset is one of the log: a loop that reads the encoder
/// itself, in a servo or on a board, knows nothing of it.
#[derive(Debug)]
pub struct TimeOffset;

/// Largest offset, s, of either sign.
const MOST_S: f64 = 0.1;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "time_offset",
    title: "time offset of the reading",
    aliases: &[
        "latency",
        "time shift",
        "clock offset",
        "timestamp offset",
        "synchronisation",
        "synchronization",
        "sensor delay",
        "measurement delay",
        "skew",
        "offset",
    ],
    site: Site::Sensor,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "reading(t) = q(t - offset_s)",
    parameters: &[Parameter::of(
        "offset_s",
        "age of the reading at the time of its row; below 0 it is taken after that time",
    )
    .off(0.0)
    .typical(-0.02, 0.02)
    .bounds(-MOST_S, MOST_S)
    .starts(&[0.01, -0.01])],
    looks_like: "an error in proportion to the speed, in a free swing too; the whole motion of the \
     joint is early or late against the inputs and the other joints, its shape unchanged",
    confused_with: &[
        "delay: a late reading and a late input look alike while the drive moves the joint; only \
         the offset shifts what needs no input: a fall after the torque is off, a passive joint",
        "sensor_lag: both trail in proportion to the speed; a filter also rounds off fast motion, \
         and it is never ahead",
        "backlash: both trail the motion; backlash trails by the same angle at every speed",
    ],
    experiment: "hold the arm out, switch its torque off and let it swing: the reading begins to \
     fall early or late by the offset; `shift_s = -offset_s` of the log's column undoes it",
    reference: "Furgale, Rehder, Siegwart, IROS 2013, 1280 (temporal calibration of sensors)",
};

impl Law for TimeOffset {
    /// The columns of one log need not be off by the same time, and a log whose readings are all
    /// late by the same time is one whose inputs act late: a `delay`.
    fn comes_with_servo(&self) -> Option<bool> {
        Some(false)
    }

    fn reading_offset_s(&self, values: &[f64]) -> Option<f64> {
        Some(values[0].clamp(-MOST_S, MOST_S))
    }

    /// None: it does not act in a loop.
    fn slope(&self, _values: &[f64], _at: &AtRest) -> Option<Slope> {
        Some(Slope::NONE)
    }
}
