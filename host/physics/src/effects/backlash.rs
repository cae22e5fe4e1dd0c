//! Backlash: play between joint and encoder.

use super::{
    EffectInfo, Encoded, Law, Needs, OnSlide, Parameter, Scope, SenseMemory, Site, StartUnknown,
};

/// Play operator: the reading stays while the angle is within gap / 2 of it, else it follows gap /
/// 2 behind.
#[derive(Debug)]
pub struct Backlash;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "backlash",
    title: "backlash before the encoder",
    aliases: &[
        "play",
        "encoder backlash",
        "lash",
        "slop",
        "free play",
        "hysteresis",
        "lost motion",
    ],
    site: Site::Sensor,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "the reading stays while |q - reading| <= gap_rad / 2, else it follows at that distance",
    parameters: &[Parameter::of("gap_rad", "free play, from flank to flank")
        .off(0.0)
        .typical(0.002, 0.05)
        .bounds(0.0, 0.5)
        .starts(&[0.01, 0.03])],
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
    parameters: &[Parameter::of("gap_m", "free play, from flank to flank")
        .off(0.0)
        .typical(0.0001, 0.005)
        .bounds(0.0, 0.1)
        .starts(&[0.001, 0.003])],
    ..INFO
};

impl Law for Backlash {
    fn slipped(&self, memory: SenseMemory) -> [f64; 2] {
        memory.ahead_rad()
    }

    fn start_unknown(&self, values: &[f64]) -> Option<StartUnknown> {
        Some(StartUnknown::Displacement {
            most: values[0] / 2.0,
        })
    }

    fn slip(&self, values: &[f64], [ahead_rad, draws_away_rad_s]: [f64; 2]) -> SenseMemory {
        let play = Play::at(values[0], ahead_rad);
        let draws_away_rad_s = play.free_rad_s(draws_away_rad_s);
        SenseMemory {
            draws_away_rad_s,
            ..SenseMemory::reads(-play.ahead_rad, 0.0)
        }
    }

    fn sense(
        &self,
        values: &[f64],
        memory: &mut Option<SenseMemory>,
        encoded: Encoded,
        step_s: f64,
    ) -> f64 {
        let angle_rad = encoded.angle_rad;
        let before = memory.unwrap_or(SenseMemory::reads(angle_rad, angle_rad));
        // Between two stretches of a motion no time passes: the reading is put where the next one
        // begins, and the joint is as far ahead of it as it was.
        let reached_rad = if step_s > 0.0 {
            angle_rad
        } else {
            before.encoded
        };
        let play = Play::at(values[0], reached_rad - before.reading);
        let reading_rad = angle_rad - play.ahead_rad;
        let draws_away_rad_s = play.free_rad_s(encoded.speed_rad_s);
        *memory = Some(SenseMemory {
            draws_away_rad_s,
            ..SenseMemory::reads(reading_rad, angle_rad)
        });
        reading_rad
    }
}

/// Where a joint is in its play.
struct Play {
    /// How far ahead of the reading.
    ahead_rad: f64,
    /// Whether it touches neither flank.
    is_free: bool,
}

impl Play {
    /// Nearer to a flank than by this share of the gap it touches it, for rounding's sake.
    const TOUCHES: f64 = 1e-9;

    /// Ahead of the reading by this much, which the flanks keep within half the gap.
    fn at(gap_rad: f64, ahead_rad: f64) -> Play {
        let half_rad = gap_rad / 2.0;
        Play {
            // Not by `clamp`, which panics where a simulation has diverged to no number.
            ahead_rad: ahead_rad.max(-half_rad).min(half_rad),
            is_free: ahead_rad.abs() < half_rad - Play::TOUCHES * gap_rad,
        }
    }

    /// How fast the joint draws away from the reading where it turns at this speed: in its play it
    /// does and the reading stands still; no reading tells how fast.
    fn free_rad_s(&self, joint_rad_s: f64) -> f64 {
        if self.is_free { joint_rad_s } else { 0.0 }
    }
}
