//! From the host to the CM-5.

use crate::packed::{Positions, SERVOS, Speeds};
use crate::raw::{MovingSpeed, TorqueLimit};
use serde::{Deserialize, Serialize};

/// Bytes of gain table in one message.
pub const PLAN_CHUNK: usize = 32;

/// What the host may say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Command {
    /// Opens the talk; answered by [`super::Report::Hello`]. Its form never changes.
    Hello {
        /// [`super::VERSION`] of the host.
        version: u8,
    },
    /// Changes the state; torque goes off on the way.
    Mode(Mode),
    /// Says which servos there are.
    ServoList(ServoList),
    /// Goal positions, in the servo list's order. Obeyed from the next tick on, if armed.
    Goals(Positions),
    /// Speed commands for wheel mode, as [`crate::raw::Signed`], in the servo list's order.
    Speeds(Speeds),
    /// The first link's attitude, where the host measures it.
    Attitude(Attitude),
    /// The host is there and has nothing to say.
    KeepAlive,
    /// Torque off, now.
    Disarm,
    /// Asks for a report.
    Ask(Subject),
    /// Asks for a piece of the stored gain table.
    PlanRead {
        /// Its first byte.
        offset: u16,
    },
    /// Torque on. Critical.
    Arm {
        /// The token of the last [`super::Hello`]. It serves once, so that an old frame arms
        /// nothing.
        token: u16,
        /// What the servos may do.
        limits: ArmLimits,
    },
    /// A piece of a new gain table. Critical; refused while armed.
    PlanChunk {
        /// Its first byte, a multiple of [`PLAN_CHUNK`].
        offset: u16,
        /// The piece; what lies behind the table's end is ignored.
        bytes: [u8; PLAN_CHUNK],
    },
    /// The table is complete: check it, then keep it. Critical; answered when it is in EEPROM.
    PlanStore {
        /// Bytes of the table.
        length: u16,
        /// CRC-32 of them.
        check: u32,
    },
    /// Lets an armed robot down softly: positions held, or stopped in wheel mode, the torque limit
    /// falling to nothing.
    LetDown,
    /// Asks for an entry of the fault log. Refused while armed.
    FaultRead {
        /// Which: 0 the newest, 1 the one before it.
        back: u8,
    },
}

impl Command {
    /// Whether it shows that the host is in command: an armed robot that hears no such command is
    /// let down.
    pub fn is_life(&self) -> bool {
        match self {
            Command::Goals(_) | Command::Speeds(_) | Command::Attitude(_) | Command::KeepAlive => {
                true
            }
            Command::Hello { .. }
            | Command::Mode(_)
            | Command::ServoList(_)
            | Command::Disarm
            | Command::LetDown
            | Command::Ask(_)
            | Command::PlanRead { .. }
            | Command::Arm { .. }
            | Command::PlanChunk { .. }
            | Command::PlanStore { .. }
            | Command::FaultRead { .. } => false,
        }
    }
}

/// What the servos may do once they are armed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ArmLimits {
    /// Torque limit of every servo, 1 to 1023.
    pub torque: TorqueLimit,
    /// Largest speed of a servo on the way to its goal, 1 to 1023; none is not to be had.
    pub speed: MovingSpeed,
}

impl ArmLimits {
    /// As much as a servo has.
    pub const FULL: ArmLimits = ArmLimits {
        torque: TorqueLimit::FULL,
        speed: MovingSpeed::MOST,
    };

    /// No torque, at the least speed; no robot is armed so.
    pub const NONE: ArmLimits = ArmLimits {
        torque: TorqueLimit::NONE,
        speed: MovingSpeed::LEAST,
    };

    /// Whether both are limits a servo knows; [`MovingSpeed::UNLIMITED`] is none.
    pub fn is_sound(&self) -> bool {
        (1..=TorqueLimit::FULL.0).contains(&self.torque.0)
            && (MovingSpeed::LEAST.0..=MovingSpeed::MOST.0).contains(&self.speed.0)
    }
}

/// What the firmware does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mode {
    /// A plain adapter: bytes go through.
    Bridge,
    /// Group reads and goals at 100 Hz.
    Stream,
    /// Balance on board.
    Balance,
}

/// What a report can be asked about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Subject {
    /// [`super::Telemetry`].
    Telemetry,
    /// [`super::Statistics`].
    Statistics,
}

/// The servos, in the order of goals and positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ServoList {
    /// How many of `ids` count, at most [`SERVOS`].
    pub count: u8,
    /// Their ids.
    pub ids: [u8; SERVOS],
}

impl ServoList {
    /// The first `count` ids, at most [`SERVOS`] of them.
    pub fn ids(&self) -> &[u8] {
        let count = usize::from(self.count).min(SERVOS);
        self.ids.get(..count).unwrap_or(&self.ids)
    }

    /// Whether it can be used: 1 to [`SERVOS`] different ids below 254.
    pub fn is_sound(&self) -> bool {
        let ids = self.ids();
        let differs = |at: usize, id: u8| ids.iter().skip(at + 1).all(|other| *other != id);
        (1..=SERVOS as u8).contains(&self.count)
            && (ids.iter().enumerate()).all(|(at, id)| *id < 254 && differs(at, *id))
    }
}

impl Default for ServoList {
    /// The Bioloid humanoid: 1 to 18.
    fn default() -> Self {
        let mut ids = [0; SERVOS];
        (ids.iter_mut().zip(1..)).for_each(|(slot, id)| *slot = id);
        ServoList {
            count: SERVOS as u8,
            ids,
        }
    }
}

/// The first link against upright.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Attitude {
    /// Angle from upright, [`Attitude::ANGLE_LSB_RAD`] each.
    pub angle: i16,
    /// Angular velocity, [`Attitude::RATE_LSB_RAD_S`] each.
    pub rate: i16,
}

impl Attitude {
    /// One unit of `angle`, rad; the range is +-3.27 rad.
    pub const ANGLE_LSB_RAD: f64 = 1e-4;
    /// One unit of `rate`, rad/s; the range is +-32.7 rad/s.
    pub const RATE_LSB_RAD_S: f64 = 1e-3;
}
