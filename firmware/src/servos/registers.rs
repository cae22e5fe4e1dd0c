//! Whether a servo's registers are what they were written: one that restarts loses them, and one
//! that missed a packet never had them.

use super::mode::ServoMode;
use crate::bus::MOST_READ;
use crate::design::GOAL_SLEW;
use handstand_shared::control_table::{
    GOAL_POSITION, MOVING_SPEED, Register, TORQUE_ENABLE, TORQUE_LIMIT,
};
use handstand_shared::message::ArmLimits;
use handstand_shared::raw::Position;

/// Goals that a servo may have missed and is not taken for one that restarted: as many ticks as it
/// may be silent.
const MISSED_GOALS: u16 = 3;

/// What is known of the registers of a servo that is commanded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Registers {
    /// They were read and are as they were written.
    AsWritten,
    /// They were written, or the servo was silent for a tick, since they were read.
    Unread,
    /// They were read before torque was on, and are not what they were written.
    Differ,
    /// The same after a silence of three ticks: it gets no goal before they were read.
    Withheld,
}

impl Registers {
    /// After a tick without an answer.
    pub fn after_silence(self, is_short: bool) -> Self {
        match (self, is_short) {
            (Registers::AsWritten | Registers::Unread, true) => Registers::Unread,
            (Registers::Differ, true) => Registers::Differ,
            (Registers::Withheld, _) | (_, false) => Registers::Withheld,
        }
    }
}

/// Registers from torque enable on.
pub(super) type Reading = [u8; MOST_READ];

/// What a servo was written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Written {
    pub mode: ServoMode,
    pub goal: Position,
    pub limits: ArmLimits,
    pub has_torque: bool,
}

impl Written {
    /// Whether the registers hold it. A wheel's speed is its command, another one in every tick: it
    /// counts before torque is on.
    pub fn is_in(&self, reading: &Reading) -> bool {
        let holds = |register, code| code_of(reading, register) == code;
        let speed = self.mode.moving_speed(self.limits);
        let has_speed = speed.is_some_and(|code| holds(MOVING_SPEED, code));
        let has_limit = holds(TORQUE_LIMIT, self.limits.torque.0);
        if !self.has_torque {
            return has_limit && has_speed;
        }
        let has_torque = code_of(reading, TORQUE_ENABLE) & 0xff != 0;
        let off = code_of(reading, GOAL_POSITION).abs_diff(self.goal.0);
        let is_wheel = self.mode == ServoMode::Wheel;
        has_torque && has_limit && (is_wheel || has_speed && off <= MISSED_GOALS * GOAL_SLEW)
    }
}

/// A register's two bytes.
fn code_of(reading: &Reading, register: Register) -> u16 {
    let at = usize::from(register.address.wrapping_sub(TORQUE_ENABLE.address));
    match reading.get(at..).and_then(<[u8]>::first_chunk) {
        Some(bytes) => u16::from_le_bytes(*bytes),
        None => 0,
    }
}
