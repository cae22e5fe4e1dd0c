//! The states, and how the host is told of them.

use handstand_shared::message::{Cause, Condition};

/// The states. Torque is on in `On` and `Soft` only.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// Plain adapter between PC and servos.
    Bridge,
    /// Reads the servos and obeys the host's goals.
    Stream(Torque),
    /// Reads the servos and balances.
    Balance(Torque),
    /// Torque is off and stays off until the host greets, chooses a mode and arms again.
    Fault(Cause),
}

/// Torque within a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Torque {
    /// Torque off.
    Off,
    /// Torque on.
    On,
    /// Positions held, torque limit falling.
    Fading {
        /// Why.
        cause: Cause,
    },
}

impl State {
    /// As the host is told.
    pub fn condition(self) -> Condition {
        match self {
            State::Bridge => Condition::Bridge,
            State::Stream(Torque::Off) => Condition::Stream,
            State::Stream(Torque::On) => Condition::StreamArmed,
            State::Balance(Torque::Off) => Condition::Balance,
            State::Balance(Torque::On) => Condition::BalanceArmed,
            State::Stream(Torque::Fading { .. }) | State::Balance(Torque::Fading { .. }) => {
                Condition::Soft
            }
            State::Fault(cause) => Condition::Fault(cause),
        }
    }
}
