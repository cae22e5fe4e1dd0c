//! Errors of a session with the CM-5's firmware, and its states in words.

use crate::error::Error;
use handstand_shared::message::{Cause, Condition, Refusal, VERSION};

/// A session with the firmware that failed.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// No Handstand firmware responds on this port.
    #[error("{port}: no Handstand firmware answers")]
    NoFirmware {
        /// The port.
        port: String,
    },
    /// The firmware has another protocol version.
    #[error("{port}: the firmware has protocol version {theirs}, this program version {VERSION}")]
    Version {
        /// The port.
        port: String,
        /// The firmware's version.
        theirs: u8,
    },
    /// The firmware refused a command.
    #[error("the CM-5 refuses to {action}: {}", refusal_words(*refusal).0)]
    Refused {
        /// What it was asked to do.
        action: String,
        /// Why not.
        refusal: Refusal,
    },
    /// No answer to a command after all tries.
    #[error("{port}: no answer when asked to {action}")]
    NoAnswer {
        /// The port.
        port: String,
        /// What it was asked to do.
        action: String,
    },
    /// The report asked for did not come after all tries.
    #[error("{port}: the CM-5 does not answer")]
    NoReport {
        /// The port.
        port: String,
    },
    /// The port failed.
    #[error(transparent)]
    Port(#[from] Error),
}

impl From<SessionError> for Error {
    fn from(error: SessionError) -> Self {
        let remedy = match &error {
            SessionError::Port(_) => "",
            SessionError::NoFirmware { .. } => {
                "is it flashed (docs/flash.md), switched on, the cable in, and the speed right (--baud 57600)?"
            }
            SessionError::Version { .. } => {
                "build and flash the firmware that belongs to this program: docs/flash.md"
            }
            SessionError::Refused { refusal, .. } => refusal_words(*refusal).1,
            SessionError::NoAnswer { .. } | SessionError::NoReport { .. } => {
                "the line is disturbed or the CM-5 was reset: `handstand latency` measures the line"
            }
        };
        match error {
            SessionError::Port(error) => error,
            error => Error::device(error.to_string(), remedy),
        }
    }
}

/// Why a command is refused, and what to do.
pub fn refusal_words(refusal: Refusal) -> (&'static str, &'static str) {
    match refusal {
        Refusal::Version => (
            "no greeting of its version came first",
            "reset the CM-5 and try again",
        ),
        Refusal::State => (
            "not in this state",
            "choose a mode first; after a fault, greet again",
        ),
        Refusal::Armed => ("torque is on", "disarm first"),
        Refusal::Token => ("the greeting is out of date", "try again"),
        Refusal::Supply => (
            "the supply is too low, or no servo has told it",
            "charge the battery: `handstand bus monitor` shows the voltage",
        ),
        Refusal::Servo => (
            "a servo it needs does not answer",
            "`handstand bus scan` shows who does",
        ),
        Refusal::NoPlan => (
            "there are no gains on it",
            "`handstand deploy` puts them there",
        ),
        Refusal::BadPlan => (
            "the gain table is unsound",
            "make it again; if it stays so, firmware and program do not belong together",
        ),
        Refusal::ServoList => (
            "the list of servos is empty, too long, or names an id twice",
            "give 1 to 18 different ids",
        ),
        Refusal::Busy => ("a plan is being written", "wait a second and try again"),
        Refusal::Button => ("a button is held down", "let it go: any button stops"),
        Refusal::Overrun => (
            "its ticks last longer than their period",
            "`handstand bus setup` sets the servos' return delay to 0; noise or absent servos cost time too",
        ),
        Refusal::Attitude => (
            "no attitude of the first link came in the last 30 ms",
            "send it 100 times a second, before arming too",
        ),
        Refusal::Limits => (
            "a torque or speed limit lies outside 1 to 1023",
            "give limits a servo knows",
        ),
        Refusal::Wheel => (
            "a servo that the plan drives is not in wheel mode",
            "write 0 to both its angle limits: `handstand bus write`",
        ),
        Refusal::ServoMode => (
            "a servo has not said whether it is in wheel mode",
            "try again; if it stays so, its answers are disturbed: `handstand bus monitor` counts \
             them",
        ),
        Refusal::ServoError => (
            "a servo reports overload or overheating",
            "let it cool: `handstand bus monitor` shows which",
        ),
        Refusal::Registers => (
            "a servo does not hold the torque and speed limits it was written",
            "try again; if it stays so, requests to it are disturbed: look at its cable and plug",
        ),
        Refusal::Gyro => (
            "the gyro is not connected, far from the plan's zero, or not at rest",
            "hold the robot still for 0.1 s; `handstand bus monitor` shows the code, `gains deploy` \
             sets the zero",
        ),
        Refusal::Pose => (
            "the robot is too far from the pose its gains are for",
            "bring it there by hand, then arm",
        ),
    }
}

/// What the firmware is doing, in words.
pub fn condition_words(condition: Condition) -> &'static str {
    match condition {
        Condition::Bridge => "adapter",
        Condition::Stream => "streaming, torque off",
        Condition::StreamArmed => "streaming, torque on",
        Condition::Balance => "ready to balance, torque off",
        Condition::BalanceArmed => "balancing",
        Condition::Soft => "letting down",
        Condition::Fault(Cause::LinkLost) => "stopped: the link was lost",
        Condition::Fault(Cause::LowSupply) => "stopped: the supply is low",
        Condition::Fault(Cause::ServoLost) => "stopped: a servo stopped answering",
        Condition::Fault(Cause::ServoError) => "stopped: a servo is overloaded or too hot",
        Condition::Fault(Cause::Fallen) => "stopped: it left the range its gains hold in",
        Condition::Fault(Cause::AttitudeLost) => "stopped: no attitude came",
        Condition::Fault(Cause::JointRange) => "stopped: a joint left its range",
        Condition::Fault(Cause::JointSpeed) => "stopped: a joint turned too fast",
        Condition::Fault(Cause::TorqueLost) => "stopped: a servo lost its torque",
        Condition::Fault(Cause::LetDown) => "let down, as it was told",
        Condition::Fault(Cause::Watchdog) => "stopped: the watchdog reset the controller",
    }
}
