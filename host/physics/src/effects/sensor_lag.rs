//! Sensor lag: the reading is low-pass filtered.

use super::{
    EffectInfo, Encoded, Law, Needs, OnSlide, Parameter, Scope, SenseMemory, Site, StartUnknown,
};

/// T y' + y = q: a first-order low-pass filter, solved exactly for an angle that moves in a
/// straight line over the step, or a rate along a parabola.
#[derive(Debug)]
pub struct SensorLag;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "sensor_lag",
    title: "lag of the sensor",
    aliases: &[
        "lag",
        "filter lag",
        "low-pass",
        "low-pass filter",
        "sensor filter",
        "encoder filter",
        "phase lag",
    ],
    site: Site::Sensor,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "time_constant_s * d(reading)/dt + reading = q",
    parameters: &[
        Parameter::of("time_constant_s", "time constant of the filter")
            .off(0.0)
            .typical(0.01, 0.1)
            .bounds(0.0, 1.0)
            .starts(&[0.02, 0.08]),
    ],
    looks_like: "the reading trails in proportion to the speed and rounds off fast motion; a \
     resting arm is read rightly",
    confused_with: &[
        "drive_lag: both trail and round off; a filter of the input leaves a free fall as it is",
        "delay: both trail; a delay shifts without rounding, and only what is driven",
        "viscous: both make the reading trail; friction takes energy from a free swing, a lag \
         does not",
        "time_offset: both trail in proportion to the speed; an offset shifts fast motion without \
         rounding it",
        "backlash: both trail the motion; backlash trails by the same angle at every speed",
        "grip_slip: both trail where the motion is fast; a lag is back once the arm rests",
    ],
    experiment: "drive a chirp: the reading of a filter shrinks and trails by at most a quarter of \
     a period; then watch a free swing, which it trails too",
    reference: "Ljung, System Identification, 2nd ed., section 4.2",
};

impl Law for SensorLag {
    fn trail_rad(&self, values: &[f64], speed_rad_s: f64) -> Option<f64> {
        Some(values[0] * speed_rad_s)
    }

    /// It trails as the speed of its readings says.
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

/// What a filter of this time constant, s, reads `step_s` after what `memory` holds, where its
/// input, an angle or a rate, has come to be `encoded`.
pub(super) fn filtered(
    constant_s: f64,
    memory: &mut Option<SenseMemory>,
    encoded: Encoded,
    step_s: f64,
) -> f64 {
    let to = encoded.angle_rad;
    let reading = match *memory {
        Some(before) if constant_s > 0.0 && step_s > 0.0 => {
            let from = before.encoded;
            let mean = encoded.mean.unwrap_or(0.5 * (from + to));
            follow(before.reading, [from, to, mean], step_s, constant_s)
        }
        Some(before) if constant_s > 0.0 => before.reading,
        _ => to,
    };
    *memory = Some(SenseMemory::reads(reading, to));
    reading
}

/// Output of the filter after a step over which its input is the parabola of this start, end and
/// mean.
fn follow(reading: f64, [from, to, mean]: [f64; 3], step_s: f64, constant_s: f64) -> f64 {
    let bend = 6.0 * mean - 3.0 * (from + to);
    // What it trails by in the long run: T u' - T^2 u''.
    let curved = 2.0 * bend * (constant_s / step_s).powi(2);
    let trail = |slope: f64| constant_s * slope / step_s + curved;
    let start = reading - (from - trail(to - from + bend));
    to - trail(to - from - bend) + start * (-step_s / constant_s).exp()
}
