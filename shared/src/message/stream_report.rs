//! One tick as the CM-5 reports it.

use super::report::{Cause, Condition};
use crate::packed::Positions;
use serde::{Deserialize, Serialize};

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
    /// The gyro's voltage, ADC code 0..=1023: before the servos were read, while balancing when the
    /// law took it.
    #[serde(with = "postcard::fixint::le")]
    pub gyro: u16,
}

impl StreamReport {
    /// Whether the servo at this place of the servo list answered.
    pub fn is_present(&self, place: usize) -> bool {
        (self.missing.get(place / 8)).is_some_and(|bits| bits >> (place % 8) & 1 == 0)
    }

    /// Whether torque was on when the servos were read in this tick, the last report heard before
    /// it being `before`; none where it is not known. While balancing, it comes on with the law's
    /// first command and goes off where the law gives up: after the reading, while `condition` is
    /// that of the tick's end, so that a report that was lost leaves it open. Servos that do not
    /// balance have it up to six ticks later.
    pub fn torque_was_on(&self, before: Option<&StreamReport>) -> Option<bool> {
        let last = before.map(|before| before.condition);
        let is_next = before.is_some_and(|before| self.tick == before.tick.wrapping_add(1));
        let was_balancing = last == Some(Condition::BalanceArmed);
        match self.condition {
            Condition::Bridge => None,
            Condition::BalanceArmed if was_balancing => Some(true),
            Condition::BalanceArmed => is_next.then_some(false),
            Condition::StreamArmed | Condition::Soft => Some(true),
            Condition::Fault(
                Cause::Fallen | Cause::JointRange | Cause::JointSpeed | Cause::ServoLost,
            ) if is_next => Some(was_balancing),
            Condition::Fault(
                Cause::Fallen | Cause::JointRange | Cause::JointSpeed | Cause::ServoLost,
            ) => (last == Some(self.condition)).then_some(false),
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
