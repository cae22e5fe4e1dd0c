//! From the CM-5 to the host.

use super::command::PLAN_CHUNK;
use super::fault::FaultEntry;
use crate::packed::{Positions, SERVOS};
use serde::{Deserialize, Serialize};

/// What the firmware may say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Report {
    /// Answers [`super::Command::Hello`].
    Hello(Hello),
    /// The outcome of a command that can be refused.
    Answer(Answer),
    /// Once per tick while streaming or balancing.
    Stream(StreamReport),
    /// When asked for.
    Telemetry(Telemetry),
    /// When asked for.
    Statistics(Statistics),
    /// A piece of the stored gain table. Critical.
    PlanChunk {
        /// Its first byte.
        offset: u16,
        /// Bytes of the whole table; 0 if there is none.
        length: u16,
        /// The piece, filled up with zeros.
        bytes: [u8; PLAN_CHUNK],
    },
    /// Answers [`super::Command::FaultRead`].
    Fault {
        /// Which was asked for.
        back: u8,
        /// It; none where there are not so many.
        entry: Option<FaultEntry>,
    },
}

/// Who is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hello {
    /// [`super::VERSION`] of the firmware.
    pub version: u8,
    /// What an [`super::Command::Arm`] must bring.
    pub token: u16,
    /// What it is doing.
    pub condition: Condition,
    /// Fingerprint of the plan it balances with; 0 if it has none.
    pub plan: u32,
}

/// What the firmware is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Condition {
    /// Plain adapter.
    Bridge,
    /// Reading servos, torque off.
    Stream,
    /// Reading servos and obeying goals.
    StreamArmed,
    /// Ready to balance, torque off.
    Balance,
    /// Balancing.
    BalanceArmed,
    /// It must stop: positions held, torque limit falling.
    Soft,
    /// Torque off until armed again.
    Fault(Cause),
}

/// Why torque went off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cause {
    /// No valid frame for too long.
    LinkLost,
    /// The supply fell below the limit.
    LowSupply,
    /// A servo that is balanced with stopped answering.
    ServoLost,
    /// A servo reported overload or overheating, and tripped.
    ServoError,
    /// The robot left the range in which its gains hold.
    Fallen,
    /// The watchdog reset the controller.
    Watchdog,
    /// The host said no attitude for too long, and the robot was balanced with it.
    AttitudeLost,
    /// A joint left the range of its plan.
    JointRange,
    /// A joint turned faster than its plan allows.
    JointSpeed,
    /// A servo that was commanded said that its torque was off.
    TorqueLost,
    /// The host let the robot down.
    LetDown,
}

/// The outcome of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Answer {
    /// Sequence number of the command.
    pub sequence: u8,
    /// Nothing, or why not.
    pub outcome: Result<(), Refusal>,
}

/// Why a command is not obeyed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Refusal {
    /// No `Hello` with this firmware's version came first.
    Version,
    /// Not in this state.
    State,
    /// Not while armed.
    Armed,
    /// Not the token of the last `Hello`.
    Token,
    /// The supply is too low to arm, or no servo has told it yet.
    Supply,
    /// A servo that is needed does not answer.
    Servo,
    /// There are no valid gains.
    NoPlan,
    /// The uploaded table's check, length or content is wrong.
    BadPlan,
    /// The servo list is empty, too long, or names an id twice.
    ServoList,
    /// The robot is too far from the pose its gains are for.
    Pose,
    /// A plan is being written.
    Busy,
    /// A button is held down.
    Button,
    /// Ticks took longer than their period lately.
    Overrun,
    /// The host said no attitude lately, and the plan needs it.
    Attitude,
    /// A torque or speed limit that no servo knows.
    Limits,
    /// A servo that the plan drives is not in wheel mode, or has not said so.
    Wheel,
}

/// One tick's measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct StreamReport {
    /// Number of the tick, modulo 65536.
    #[serde(with = "postcard::fixint::le")]
    pub tick: u16,
    /// What the firmware is doing.
    pub condition: Condition,
    /// Sequence number of the goals obeyed in this tick.
    pub obeyed: u8,
    /// Positions, in the servo list's order; where one is missing, the last one known.
    pub positions: Positions,
    /// Who did not answer in this tick: a bit each, the lowest first.
    pub missing: [u8; 3],
    /// Place in the servo list of the first of `housekeeping`; the second follows it, around the
    /// end.
    pub housekeeping_from: u8,
    /// Slower channels of two servos in turn.
    pub housekeeping: [Housekeeping; 2],
    /// The gyro's voltage, ADC code 0..=1023.
    #[serde(with = "postcard::fixint::le")]
    pub gyro: u16,
}

impl StreamReport {
    /// Whether the servo at this place of the servo list answered.
    pub fn is_present(&self, place: usize) -> bool {
        (self.missing.get(place / 8)).is_some_and(|bits| bits >> (place % 8) & 1 == 0)
    }

    /// Whether torque was on when the servos were read in this tick, the report before being
    /// `before`; none where it is not known. While balancing, torque comes on with the law's first
    /// command and goes off where the law gives up: after the reading, while `condition` is that of
    /// the tick's end.
    pub fn torque_was_on(&self, before: Option<&StreamReport>) -> Option<bool> {
        let before = before.filter(|before| self.tick == before.tick.wrapping_add(1));
        let was = |condition| before.is_some_and(|before| before.condition == condition);
        match self.condition {
            Condition::Bridge => None,
            Condition::BalanceArmed => Some(!was(Condition::Balance)),
            Condition::StreamArmed | Condition::Soft => Some(true),
            Condition::Fault(
                Cause::Fallen | Cause::JointRange | Cause::JointSpeed | Cause::ServoLost,
            ) => Some(was(Condition::BalanceArmed)),
            Condition::Stream | Condition::Balance | Condition::Fault(_) => Some(false),
        }
    }

    /// Position code of the servo at this place, if it answered.
    pub fn position(&self, place: usize) -> Option<u16> {
        self.positions
            .codes()
            .nth(place)
            .filter(|_| self.is_present(place))
    }

    /// The housekeeping in this report, each with its place in a servo list of `count`.
    pub fn housekeeping(&self, count: usize) -> impl Iterator<Item = (usize, Housekeeping)> {
        let first = usize::from(self.housekeeping_from);
        let places = [first, if first + 1 < count { first + 1 } else { 0 }];
        places.into_iter().zip(self.housekeeping).take(count)
    }
}

/// Registers 38 to 43 of one servo and its error bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Housekeeping {
    /// [`crate::dynamixel::ErrorBits`] of its last answer; all ones if it never answered.
    pub error: u8,
    /// Present speed, the lower byte first; [`crate::raw::Signed`].
    pub speed: [u8; 2],
    /// Present load, the lower byte first; [`crate::raw::Signed`].
    pub load: [u8; 2],
    /// [`crate::raw::Supply`].
    pub supply: u8,
    /// [`crate::raw::Temperature`].
    pub temperature: u8,
}

/// The controller's own state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Telemetry {
    /// Why it last started.
    pub reset: ResetCause,
    /// What it is doing.
    pub condition: Condition,
    /// Ticks since the start.
    pub ticks: u32,
    /// Ticks that took longer than their period.
    pub overruns: u16,
    /// Duration of the last tick, us.
    pub tick_us: u16,
    /// The longest tick since the last telemetry, us.
    pub longest_tick_us: u16,
    /// The longest control law (reading to command) since the last telemetry, us.
    pub longest_law_us: u16,
    /// The deepest the stack has been, bytes.
    pub stack_used: u16,
    /// Bytes between the static data and the top of the stack.
    pub stack_size: u16,
    /// The lowest supply a servo reported lately; [`crate::raw::Supply`].
    pub supply: u8,
    /// The gyro's last reading, ADC code.
    pub gyro: u16,
    /// Its code at rest, as the plan has it; 0 without a plan.
    pub gyro_zero: u16,
    /// [`super::Attitude::RATE_LSB_RAD_S`] per code, times 16, as the plan has it; 0 without a
    /// plan.
    pub gyro_scale: i16,
    /// The servo that let the robot down, until it is armed again.
    pub tripped: Option<TrippedServo>,
    /// The longest time without a sign of life from the host since arming, ms.
    pub longest_silence_ms: u16,
}

/// A servo that gave up under torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrippedServo {
    /// Its id.
    pub id: u8,
    /// What it said: [`crate::dynamixel::ErrorBits`]. Without overload and overheat its torque was
    /// off and nobody had switched it off.
    pub error: u8,
}

/// Why the controller started: bits of the ATmega128's MCUCSR.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ResetCause(pub u8);

impl ResetCause {
    /// Power-on.
    pub const POWER: u8 = 1;
    /// The MODE button.
    pub const BUTTON: u8 = 2;
    /// The supply broke down.
    pub const BROWN_OUT: u8 = 4;
    /// The watchdog.
    pub const WATCHDOG: u8 = 8;

    /// Whether it was the watchdog.
    pub fn is_watchdog(self) -> bool {
        self.0 & Self::WATCHDOG != 0
    }
}

/// What was counted since the start; counters stop at their largest value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Statistics {
    /// Frames from the host that were sound.
    pub frames: u16,
    /// Frames from the host that were not.
    pub bad_frames: u16,
    /// Frames from the host whose number was skipped.
    pub lost_frames: u16,
    /// Bytes from the host that came too fast.
    pub overruns: u16,
    /// Servo answers that were sound.
    pub answers: u16,
    /// Requests no servo answered in time.
    pub timeouts: u16,
    /// Answers with a wrong checksum or form.
    pub garbled: u16,
    /// Answers of another servo than the one asked.
    pub strangers: u16,
    /// Requests sent a second time.
    pub retries: u16,
    /// Per servo, how often a tick passed without its answer.
    pub missed: [u8; SERVOS],
}
