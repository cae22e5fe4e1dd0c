//! Grip slip: the bar, or the shaft of an encoder, slips in what turns it.

use super::{
    EffectInfo, Encoded, Law, Needs, OnSlide, Parameter, Scope, SenseMemory, Site, StartUnknown,
};

/// Coulomb friction carries the sensor's shaft along, which it can speed up by no more than a; else
/// it slips until both turn alike again. a is the friction's torque over the shaft's inertia: the
/// joint feels nothing of so light a shaft.
#[derive(Debug)]
pub struct GripSlip;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "grip_slip",
    title: "slip of the grip or of the encoder's shaft",
    aliases: &["slip", "slippage", "coupling slip", "shaft slip", "grip"],
    site: Site::Sensor,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "d(w_s)/dt = acceleration_rad_s2 * sgn(w - w_s) while the shaft slips, else w_s = w; \
     d(reading)/dt = w_s",
    parameters: &[Parameter::of(
        "acceleration_rad_s2",
        "largest acceleration that the grip passes on: its torque over the shaft's \
             inertia",
    )
    .off(f64::INFINITY)
    .typical(8.0, 200.0)
    .bounds(1.0, 1e5)
    .starts(&[30.0, 80.0])],
    looks_like: "the zero of the reading jumps wherever the motion is hard, and stays where it \
     jumped to; gentle motion is read rightly",
    confused_with: &[
        "backlash: both lose the way; backlash comes back to the same reading, a slip does not",
        "encoder_zero: a zero that is off is off from the beginning and stays so",
        "sensor_lag: both trail where the motion is fast; a lag is back once the arm rests",
    ],
    experiment: "mark the bar and the hand, swing hard between two stops, and read both at rest: \
     the mark and the reading move together",
    reference: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "d(w_s)/dt = acceleration_m_s2 * sgn(w - w_s) while the tape slips, else w_s = w; \
     d(reading)/dt = w_s",
    parameters: &[Parameter::of(
        "acceleration_m_s2",
        "largest acceleration that the grip passes on: its force over the tape's mass",
    )
    .off(f64::INFINITY)
    .typical(0.5, 20.0)
    .bounds(0.02, 1e4)
    .starts(&[1.0, 4.0])],
    ..INFO
};

impl Law for GripSlip {
    fn difference(&self) -> f64 {
        5e-3
    }

    /// What a shaft has slipped stays: a motion that turns within a step is off ever after.
    fn longest_step_s(&self) -> f64 {
        0.0021
    }

    fn slipped(&self, memory: SenseMemory) -> [f64; 2] {
        memory.ahead_rad()
    }

    /// A motion begins with its zero where the log has it, and held.
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
        let Encoded {
            angle_rad,
            speed_rad_s,
            ..
        } = encoded;
        let before = memory.unwrap_or(SenseMemory::reads(angle_rad, angle_rad));
        let [ahead_rad, speed_ahead_rad_s] = before.ahead_rad();
        let mut slip = Slip {
            ahead_rad,
            speed_rad_s: speed_ahead_rad_s,
        };
        // Between two stretches of a motion no time passes, and the shaft slips on as it did.
        if step_s > 0.0 {
            let mean_rad_s = (angle_rad - before.encoded) / step_s;
            let began_rad_s = 2.0 * mean_rad_s - speed_rad_s;
            if let Some(shaft_rad_s) = before.shaft_rad_s.filter(|speed| speed.is_finite()) {
                slip.speed_rad_s = began_rad_s - shaft_rad_s;
            }
            let gained_rad_s2 = (speed_rad_s - began_rad_s) / step_s;
            slip.go_on(gained_rad_s2, values[0], step_s);
        }
        let reading_rad = angle_rad - slip.ahead_rad;
        *memory = Some(SenseMemory {
            draws_away_rad_s: slip.speed_rad_s,
            shaft_rad_s: Some(speed_rad_s - slip.speed_rad_s),
            ..SenseMemory::reads(reading_rad, angle_rad)
        });
        reading_rad
    }
}

/// How far the joint is ahead of the shaft, rad, and how fast it draws away, rad/s.
struct Slip {
    ahead_rad: f64,
    speed_rad_s: f64,
}

impl Slip {
    /// Goes on for `span_s` in which the joint speeds up by `joint_rad_s2` and the shaft by no more
    /// than `grip_rad_s2`.
    fn go_on(&mut self, joint_rad_s2: f64, grip_rad_s2: f64, span_s: f64) {
        let mut left_s = span_s;
        // Once until it holds, once from there on if it lets go again.
        for _ in 0..2 {
            let holds = self.speed_rad_s == 0.0 && joint_rad_s2.abs() <= grip_rad_s2;
            if holds || grip_rad_s2 == f64::INFINITY {
                self.speed_rad_s = 0.0;
                return;
            }
            let direction = if self.speed_rad_s == 0.0 {
                joint_rad_s2.signum()
            } else {
                self.speed_rad_s.signum()
            };
            let change_rad_s2 = joint_rad_s2 - direction * grip_rad_s2;
            let until_s = -self.speed_rad_s / change_rad_s2;
            let ends = self.speed_rad_s != 0.0 && until_s > 0.0 && until_s < left_s;
            let way_s = if ends { until_s } else { left_s };
            self.ahead_rad += way_s * (self.speed_rad_s + 0.5 * way_s * change_rad_s2);
            self.speed_rad_s += way_s * change_rad_s2;
            if !ends {
                return;
            }
            self.speed_rad_s = 0.0;
            left_s -= way_s;
        }
    }
}
