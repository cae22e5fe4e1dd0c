//! The states, and how the host is told of them.

use handstand_shared::message::{Cause, Condition};

/// The states. Torque is on in `On` and `Soft` only.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// Plain adapter between PC and servos.
    Bridge,
    /// Reads the servos and obeys the host's goals.
    Stream(Drive),
    /// Reads the servos and balances.
    Balance(Drive),
    /// Torque is off and stays off until the host greets, chooses a mode and arms anew.
    Fault(Cause),
}

/// Torque within a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drive {
    /// Torque off.
    Off,
    /// Torque on.
    On,
    /// Positions held, torque limit falling.
    Soft {
        /// Ticks until torque is off.
        left: u8,
        /// Why.
        cause: Cause,
    },
}

impl State {
    /// As the host is told.
    pub fn condition(self) -> Condition {
        match self {
            State::Bridge => Condition::Bridge,
            State::Stream(Drive::Off) => Condition::Stream,
            State::Stream(Drive::On) => Condition::StreamArmed,
            State::Balance(Drive::Off) => Condition::Balance,
            State::Balance(Drive::On) => Condition::BalanceArmed,
            State::Stream(Drive::Soft { .. }) | State::Balance(Drive::Soft { .. }) => {
                Condition::Soft
            }
            State::Fault(cause) => Condition::Fault(cause),
        }
    }
}
