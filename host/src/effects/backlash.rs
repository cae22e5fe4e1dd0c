//! Backlash: play between joint and encoder.

use super::{Effect, EffectInfo, Encoded, Needs, Parameter, Scope, SenseMemory, Site};

/// Play operator: the reading stays while the angle is within gap / 2 of it, else it follows gap /
/// 2 behind.
#[derive(Debug)]
pub struct Backlash;

static INFO: EffectInfo = EffectInfo {
    id: "backlash",
    title: "backlash before the encoder",
    site: Site::Sensor,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    law: "the reading stays while |q - reading| <= gap_rad / 2, else it follows at that distance",
    parameters: &[Parameter {
        key: "gap_rad",
        unit: "rad",
        meaning: "free play, from flank to flank",
        off: Some(0.0),
        typical: (0.002, 0.05),
        bounds: (0.0, 0.5),
        starts: &[0.01, 0.03],
    }],
    looks_like: "after each reversal the reading stands still over a fixed angle, whatever the \
     amplitude, the load or the speed",
    confused_with: &[
        "grip_slip: both lose the way; backlash comes back to the same reading, a slip does not",
        "gear_backlash: play of the gear behind the encoder shows in how the arm moves, not in \
         what is read",
        "dead_zone: both leave a plateau; a dead zone has a fixed width in command and lets the \
         arm drift in angle",
        "stribeck: both halt the reading at reversal; stiction lasts until a fixed torque, not \
         over a fixed angle",
        "time_offset: both trail the motion; an offset trails farther the faster the motion, and \
         not at all where it turns back slowly",
        "sensor_lag: both trail the motion; a lag is wider the faster the motion, backlash always \
         the same",
    ],
    experiment: "move in triangles of three amplitudes, slowly: the width of the loop must not \
     change",
    reference: "Nordin, Gutman, Automatica 38 (2002) 1633",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "the reading stays while |q - reading| <= gap_m / 2, else it follows at that distance",
    parameters: &[Parameter {
        key: "gap_m",
        unit: "m",
        meaning: "free play, from flank to flank",
        off: Some(0.0),
        typical: (0.0001, 0.005),
        bounds: (0.0, 0.1),
        starts: &[0.001, 0.003],
    }],
    ..INFO
};

impl Effect for Backlash {
    fn info(&self) -> &'static EffectInfo {
        &INFO
    }

    fn slide_info(&self) -> Option<&'static EffectInfo> {
        Some(&ON_SLIDE)
    }

    fn slipped(&self, [encoded_rad, reading_rad, ..]: SenseMemory) -> [f64; 2] {
        [encoded_rad - reading_rad, 0.0]
    }

    fn sense(
        &self,
        values: &[f64],
        memory: &mut Option<SenseMemory>,
        encoded: Encoded,
        _step_s: f64,
    ) -> f64 {
        let angle_rad = encoded.angle_rad;
        let half_rad = values[0] / 2.0;
        let before_rad = memory.map_or(angle_rad, |[_, reading_rad, ..]| reading_rad);
        // Not by `clamp`, which panics where a simulation has diverged to no number.
        let reading_rad = match (angle_rad - half_rad, angle_rad + half_rad) {
            _ if angle_rad.is_nan() => angle_rad,
            (low_rad, _) if before_rad < low_rad => low_rad,
            (_, high_rad) if before_rad > high_rad => high_rad,
            _ => before_rad,
        };
        *memory = Some([angle_rad, reading_rad, 0.0, 0.0]);
        reading_rad
    }
}
