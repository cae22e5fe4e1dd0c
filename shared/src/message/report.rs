//! From the CM-5 to the host.

use super::command::PLAN_CHUNK;
use super::fault::FaultEntry;
use super::stream_report::StreamReport;
use crate::packed::SERVOS;
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
    /// A servo that the plan drives is not in wheel mode.
    Wheel,
    /// A servo has not yet said whether it is in wheel mode.
    ServoMode,
    /// A servo reports overload or overheating.
    ServoError,
    /// A servo was read, and its torque or speed limit is not the one it was written.
    Registers,
    /// The gyro is at a rail, far from the plan's zero, or was not at rest for 100 ms.
    Gyro,
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
    /// Bytes of servos that found no room towards the host while it was an adapter: of answers
    /// longer than its queue.
    pub cut: u16,
    /// Per servo, how often a tick passed without its answer.
    pub missed: [u8; SERVOS],
}
