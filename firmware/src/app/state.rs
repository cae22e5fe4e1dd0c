//! The states, what lives only while torque is on, and how the host is told of them.

use crate::age::Age;
use handstand_shared::message::{Cause, Condition};
use handstand_shared::packed::{Positions, Speeds};
use handstand_shared::raw::TorqueLimit;

/// The states. Torque is on in `On` and `Fading` only.
#[derive(Debug, Clone, Copy)]
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
#[derive(Debug, Clone, Copy)]
pub enum Torque {
    /// Torque off.
    Off,
    /// Torque on.
    On(Armed),
    /// Positions held, torque limit falling.
    Fading(Fading),
}

/// What lives from arming until torque begins to fall, or goes off, and no longer.
#[derive(Debug, Clone, Copy)]
pub struct Armed {
    /// What the host wants of the servos.
    pub(super) goal: Goal,
    /// Sequence number of the frame `goal` came in: of arming itself at first.
    pub(super) obeyed: u8,
    /// How far torque has come on.
    pub(super) onset: Onset,
    /// Since a round of the housekeeping told of a low supply, if every one has since then.
    pub(super) low: Option<Age>,
}

/// What lives while torque falls.
#[derive(Debug, Clone, Copy)]
pub struct Fading {
    /// Why.
    pub(super) cause: Cause,
    /// Since it began.
    pub(super) since: Age,
    /// The torque limit that it fell from.
    pub(super) from: TorqueLimit,
    /// Sequence number of the last goals that were obeyed.
    pub(super) obeyed: u8,
}

/// What the host wants of the servos.
#[derive(Debug, Clone, Copy)]
pub(super) enum Goal {
    /// Nothing since arming: stay.
    Hold,
    Positions(Positions),
    Speeds(Speeds),
}

/// Torque comes on in steps, a tick each: in one tick all of it would make its report late, and
/// with it the host's attitude for the next one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Onset {
    /// It comes on in those that balance, with the law's first command.
    Balance,
    /// The others get goals where they stand, a third of the servo list from this place on.
    Goals(u8),
    /// The others have torque, too, a third of the list from this place on.
    Others(u8),
    /// While streaming all have their goals, and get torque in the next tick.
    Torque,
    /// All have it.
    Done,
}

impl Armed {
    /// Nothing but to stay, by this frame.
    pub(super) fn by(obeyed: u8, onset: Onset) -> Self {
        Armed {
            goal: Goal::Hold,
            obeyed,
            onset,
            low: None,
        }
    }
}

impl State {
    /// As the host is told.
    pub fn condition(&self) -> Condition {
        match self {
            State::Bridge => Condition::Bridge,
            State::Stream(Torque::Off) => Condition::Stream,
            State::Stream(Torque::On(_)) => Condition::StreamArmed,
            State::Balance(Torque::Off) => Condition::Balance,
            State::Balance(Torque::On(_)) => Condition::BalanceArmed,
            State::Stream(Torque::Fading(_)) | State::Balance(Torque::Fading(_)) => Condition::Soft,
            State::Fault(cause) => Condition::Fault(*cause),
        }
    }

    /// Whether torque is on, falling included.
    pub fn is_armed(&self) -> bool {
        matches!(self.torque(), Some(Torque::On(_) | Torque::Fading(_)))
    }

    /// Sequence number of the goals that are reported as obeyed; 0 while torque is off.
    pub(super) fn obeyed(&self) -> u8 {
        match self.torque() {
            Some(Torque::On(armed)) => armed.obeyed,
            Some(Torque::Fading(fading)) => fading.obeyed,
            Some(Torque::Off) | None => 0,
        }
    }

    /// Of a state that has any.
    pub(super) fn torque(&self) -> Option<&Torque> {
        match self {
            State::Stream(torque) | State::Balance(torque) => Some(torque),
            State::Bridge | State::Fault(_) => None,
        }
    }

    /// Of a state that has any.
    pub(super) fn torque_mut(&mut self) -> Option<&mut Torque> {
        match self {
            State::Stream(torque) | State::Balance(torque) => Some(torque),
            State::Bridge | State::Fault(_) => None,
        }
    }

    /// What lives while torque is on, if it is.
    pub(super) fn armed_mut(&mut self) -> Option<&mut Armed> {
        match self.torque_mut() {
            Some(Torque::On(armed)) => Some(armed),
            Some(Torque::Off | Torque::Fading(_)) | None => None,
        }
    }

    /// Time passes.
    pub(super) fn pass(&mut self, clock: u16) {
        match self.torque_mut() {
            Some(
                Torque::On(Armed { low: Some(age), .. })
                | Torque::Fading(Fading { since: age, .. }),
            ) => {
                age.pass(clock);
            }
            Some(Torque::On(_) | Torque::Off) | None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_are_obeyed_while_torque_is_on_or_falls() {
        let fading = Fading {
            cause: Cause::LinkLost,
            since: Age::NEVER,
            from: TorqueLimit::FULL,
            obeyed: 9,
        };
        let obeyed = |torque| State::Stream(torque).obeyed();
        assert_eq!(obeyed(Torque::On(Armed::by(7, Onset::Done))), 7);
        assert_eq!(obeyed(Torque::Fading(fading)), 9);
        assert_eq!(obeyed(Torque::Off), 0);
        assert_eq!(State::Bridge.obeyed(), 0);
    }
}
