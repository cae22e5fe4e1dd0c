//! Sensor lag: the reading is low-pass filtered.

use super::{Effect, EffectInfo, Encoded, Needs, Parameter, Scope, SenseMemory, Site};

/// T y' + y = q: a first-order low-pass filter, solved exactly for an angle that moves in a
/// straight line over the step.
#[derive(Debug)]
pub struct SensorLag;

static INFO: EffectInfo = EffectInfo {
    id: "sensor_lag",
    title: "lag of the sensor",
    site: Site::Sensor,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    law: "time_constant_s * d(reading)/dt + reading = q",
    parameters: &[Parameter {
        key: "time_constant_s",
        unit: "s",
        meaning: "time constant of the filter",
        off: Some(0.0),
        typical: (0.01, 0.1),
        bounds: (0.0, 1.0),
        starts: &[0.02, 0.08],
    }],
    looks_like: "the reading trails in proportion to the speed and rounds off fast motion; a \
     resting arm is read rightly",
    confused_with: &[
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

impl Effect for SensorLag {
    fn info(&self) -> &'static EffectInfo {
        &INFO
    }

    fn slide_info(&self) -> Option<&'static EffectInfo> {
        Some(&INFO)
    }

    fn trail_rad(&self, values: &[f64], speed_rad_s: f64) -> Option<f64> {
        Some(values[0] * speed_rad_s)
    }

    fn sense(
        &self,
        values: &[f64],
        memory: &mut Option<SenseMemory>,
        encoded: Encoded,
        step_s: f64,
    ) -> f64 {
        filtered(values[0], memory, encoded.angle_rad, step_s)
    }
}

/// What a filter of this time constant, s, reads `step_s` after what `memory` holds, where its
/// input has come to be `angle_rad`, or a rate, rad/s.
pub(super) fn filtered(
    constant_s: f64,
    memory: &mut Option<SenseMemory>,
    angle_rad: f64,
    step_s: f64,
) -> f64 {
    let reading_rad = match *memory {
        Some([from_rad, reading_rad, ..]) if constant_s > 0.0 => {
            follow(reading_rad, from_rad, angle_rad, step_s, constant_s)
        }
        _ => angle_rad,
    };
    *memory = Some([angle_rad, reading_rad, 0.0, 0.0]);
    reading_rad
}

/// Output of the filter after a step over which its input goes straight `from_rad` -> `to_rad`.
fn follow(reading_rad: f64, from_rad: f64, to_rad: f64, step_s: f64, constant_s: f64) -> f64 {
    if step_s <= 0.0 {
        return reading_rad;
    }
    let trail_rad = constant_s * (to_rad - from_rad) / step_s;
    let start_rad = reading_rad - (from_rad - trail_rad);
    to_rad - trail_rad + start_rad * (-step_s / constant_s).exp()
}
