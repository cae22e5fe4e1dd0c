//! The servos as a group: who they are, where they are, and what they last said.

use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::message::{ArmLimits, Cause, Housekeeping, ServoList, TrippedServo};
use handstand_shared::packed::{Positions, SERVOS};
use handstand_shared::plan::Joint;
use handstand_shared::raw::{Position, ReturnDelay, Supply};

mod commands;
mod mode;
mod registers;
mod round;

pub use commands::Limit;
use mode::ServoMode;
use registers::Registers;

/// Error bits of a servo that drops its torque, or is about to.
const GAVE_UP: u8 = ErrorBits::OVERLOAD.0 | ErrorBits::OVERHEAT.0;

/// Requests in a row that a servo may leave unanswered and is commanded all the same. Three ticks.
const MOST_UNANSWERED: u8 = 4;

/// Answers that a servo may miss until its mode is known and is waited for all the same: with a
/// fifth of them lost, eight are 1 in 400,000.
const MOST_MODE_MISSES: u8 = 8;

/// The lowest supply of a round that is not heard whole: none.
const PART_OF_A_ROUND: Supply = Supply(0);

/// One servo.
#[derive(Debug, Clone, Copy)]
pub struct Servo {
    /// Its id on the bus.
    pub id: u8,
    /// Its return delay; the factory's until it was asked.
    delay: ReturnDelay,
    /// Unknown until it was asked.
    mode: ServoMode,
    /// Answers it did not give since its mode was asked for; counted until it is known.
    mode_misses: u8,
    /// Where it was when it last answered.
    pub position: Position,
    /// Requests in a row that it did not answer: two in the first tick in which it is silent, then
    /// one a tick.
    unanswered: u8,
    /// Whether it is commanded.
    pub armed: bool,
    /// Whether its registers were read, and are as they were written.
    registers: Registers,
    /// The goal it was last sent.
    pub goal: Position,
}

impl Servo {
    /// Of which nothing but its id is known.
    fn unknown(id: u8) -> Self {
        Servo {
            id,
            delay: ReturnDelay::FACTORY,
            mode: ServoMode::Unknown,
            mode_misses: 0,
            position: Position::CENTRE,
            unanswered: u8::MAX,
            armed: false,
            registers: Registers::Unread,
            goal: Position::CENTRE,
        }
    }

    /// Whether it answered in this tick.
    pub fn is_present(&self) -> bool {
        self.unanswered == 0
    }

    fn hear(&mut self, has_answered: bool) {
        if has_answered {
            self.unanswered = 0;
        } else {
            self.unanswered = self.unanswered.saturating_add(1);
            self.registers = self.registers.after_silence(self.was_heard_lately());
            self.miss_mode();
        }
    }

    /// Whether it answered in one of the last three ticks: an answer that is lost as torque comes
    /// on would leave a joint to one of its two servos.
    fn was_heard_lately(&self) -> bool {
        self.unanswered <= MOST_UNANSWERED
    }

    fn miss_mode(&mut self) {
        if self.mode == ServoMode::Unknown {
            self.mode_misses = self.mode_misses.saturating_add(1);
        }
    }

    /// Whether it would be commanded if only its mode were known. Two servos of one id never say
    /// it: they are left out.
    fn owes_mode(&self) -> bool {
        let is_unknown = self.mode == ServoMode::Unknown;
        is_unknown && self.was_heard_lately() && self.mode_misses < MOST_MODE_MISSES
    }

    /// Whether it gets goals: one that was silent for longer has its torque off, or another goal,
    /// until it was read.
    fn takes_goals(&self) -> bool {
        self.armed && self.registers != Registers::Withheld
    }
}

/// The servos that balancing commands: of each joint the one that measures and drives, and the one
/// that drives along, if one does.
#[derive(Debug, Clone, Copy)]
pub struct Driven {
    ids: [u8; 4],
    count: u8,
}

impl Driven {
    /// Those of these joints.
    pub fn of(joints: &[Joint; 2]) -> Self {
        let mut driven = Driven {
            ids: [0; 4],
            count: 0,
        };
        let ids = joints.iter().flat_map(Joint::servos).flatten();
        for (slot, id) in driven.ids.iter_mut().zip(ids) {
            *slot = id;
            driven.count += 1;
        }
        driven
    }

    /// Their ids.
    pub fn ids(&self) -> &[u8] {
        self.ids.get(..usize::from(self.count)).unwrap_or(&[])
    }
}

/// All of them, in the servo list's order.
#[derive(Debug, Clone)]
pub struct Servos {
    servos: [Servo; SERVOS],
    /// Places in the order in which they are read.
    order: [u8; SERVOS],
    count: u8,
    /// Their positions, as they are reported.
    pub positions: Positions,
    /// Place of the servo that was asked last for its return delay and mode.
    asked: u8,
    /// Place of the first servo whose housekeeping are read in this tick.
    pub housekeeping_from: u8,
    housekeeping_second: u8,
    /// Places of those whose registers are read in this tick: one in turn, and one that must be.
    whole_in_turn: Option<u8>,
    whole_unread: Option<u8>,
    /// The housekeeping read in this tick.
    pub housekeeping: [Housekeeping; 2],
    /// The lowest supply in the round of housekeeping before this one.
    pub supply: Option<Supply>,
    lowest: Supply,
    /// Rounds of housekeeping so far, modulo 256.
    pub rounds: u8,
    /// The first commanded servo since arming that said it was overloaded or too hot, or that its
    /// torque was off.
    pub tripped: Option<TrippedServo>,
    /// Whether torque was switched on in all that are commanded.
    has_torque: bool,
    /// What those that are commanded were written.
    limits: ArmLimits,
}

impl Servos {
    /// Nothing is known of them but their ids.
    pub fn new(list: &ServoList) -> Self {
        let mut new = Servos {
            servos: [Servo::unknown(0); SERVOS],
            order: [0; SERVOS],
            count: 0,
            positions: Positions::default(),
            asked: 0,
            housekeeping_from: 0,
            housekeeping_second: 0,
            whole_in_turn: None,
            whole_unread: None,
            housekeeping: [round::SILENT; 2],
            supply: None,
            lowest: PART_OF_A_ROUND,
            rounds: 0,
            tripped: None,
            has_torque: false,
            limits: ArmLimits::NONE,
        };
        new.start_over(list);
        new
    }

    /// Forgets all but the ids of this list. In place: the stack has no room for another one.
    #[inline(never)]
    pub fn start_over(&mut self, list: &ServoList) {
        let ids = list.ids();
        for (place, servo) in self.servos.iter_mut().enumerate() {
            *servo = Servo::unknown(ids.get(place).copied().unwrap_or(0));
        }
        (self.order.iter_mut().zip(0..)).for_each(|(slot, place)| *slot = place);
        self.count = ids.len() as u8;
        (0..SERVOS).for_each(|place| self.positions.set(place, Position::CENTRE.0));
        self.asked = 0;
        self.housekeeping_from = 0;
        self.housekeeping_second = u8::from(self.count > 1);
        self.whole_in_turn = None;
        self.whole_unread = None;
        self.housekeeping = [round::SILENT; 2];
        self.supply = None;
        self.lowest = Supply(u8::MAX);
        self.rounds = 0;
        self.tripped = None;
        self.has_torque = false;
        self.limits = ArmLimits::NONE;
    }

    /// Reads these two last, the second of them after the first; the others in the list's order.
    #[inline(never)]
    pub fn read_last(&mut self, ids: [u8; 2]) {
        let last = ids.map(|id| self.place_of(id));
        let others = (0..self.count).filter(|place| !last.contains(&Some(*place)));
        let all = others.chain(last.into_iter().flatten());
        (self.order.iter_mut().zip(all)).for_each(|(slot, place)| *slot = place);
    }

    fn place_of(&self, id: u8) -> Option<u8> {
        let mut places = (0..).zip(self.all());
        let own = places.find(|(_, servo)| servo.id == id);
        own.map(|(place, _)| place)
    }

    /// Place of the servo that is read at this turn; beyond the last one, a place that is none.
    fn nth(&self, turn: u8) -> u8 {
        if turn < self.count {
            self.order.get(usize::from(turn)).copied().unwrap_or(turn)
        } else {
            turn
        }
    }

    /// Those of the servo list.
    pub fn all(&self) -> &[Servo] {
        self.servos
            .get(..usize::from(self.count))
            .unwrap_or(&self.servos)
    }

    fn all_mut(&mut self) -> &mut [Servo] {
        let count = usize::from(self.count).min(SERVOS);
        self.servos.get_mut(..count).unwrap_or(&mut [])
    }

    /// The servo with this id.
    // A humanoid's list is 1 to 18: looked for there first, for the law asks a dozen times a tick.
    pub fn with_id(&self, id: u8) -> Option<&Servo> {
        let is_it = |servo: &&Servo| servo.id == id;
        let in_order = self.all().get(usize::from(id.wrapping_sub(1)));
        let found = in_order.filter(is_it);
        found.or_else(|| self.all().iter().find(is_it))
    }

    /// Why it must stop, if a servo that was commanded is no more.
    pub fn gave_up(&self) -> Option<Cause> {
        let error = self.tripped?.error;
        match error & GAVE_UP {
            0 => Some(Cause::TorqueLost),
            _ => Some(Cause::ServoError),
        }
    }

    /// Whether the servo with this id was found to turn without end.
    pub fn is_wheel(&self, id: u8) -> bool {
        self.with_id(id)
            .is_some_and(|servo| servo.mode == ServoMode::Wheel)
    }

    /// No supply is known before the end of a whole round of housekeeping: nothing was read in an
    /// adapter's time. What is armed after a whole round stands where it was read.
    pub fn forget_supply(&mut self) {
        self.supply = None;
        // What is left of this round tells of some servos only.
        self.lowest = PART_OF_A_ROUND;
    }

    /// Asks all for their return delay and mode once more, one per tick.
    pub fn ask_again(&mut self) {
        for servo in self.all_mut() {
            servo.mode = ServoMode::Unknown;
            servo.mode_misses = 0;
        }
    }

    /// Whether all that would be armed now have said their mode.
    pub fn modes_are_known(&self) -> bool {
        !self.all().iter().any(Servo::owes_mode)
    }

    /// Those that did not answer in this tick: a bit each, the lowest first.
    pub fn missing(&self) -> [u8; 3] {
        let mut missing = [0; 3];
        for (bits, eight) in missing.iter_mut().zip(self.all().chunks(8)) {
            // A bit that moves on: shifting by a variable costs the AVR a loop.
            let mut bit = 1u8;
            for servo in eight {
                *bits |= if servo.is_present() { 0 } else { bit };
                bit = bit.wrapping_shl(1);
            }
        }
        missing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn list(ids: &[u8]) -> ServoList {
        let mut all = [0; SERVOS];
        all[..ids.len()].copy_from_slice(ids);
        ServoList {
            count: ids.len() as u8,
            ids: all,
        }
    }

    /// Two of one id never say it: arming does not wait for them for ever.
    #[test]
    fn a_mode_that_is_not_said_eight_times_is_waited_for_no_longer() {
        let mut servo = Servo::unknown(1);
        servo.hear(true);
        for _ in 0..MOST_MODE_MISSES {
            assert!(servo.owes_mode());
            servo.miss_mode();
        }
        assert!(!servo.owes_mode());

        servo.mode = ServoMode::Wheel;
        let misses = servo.mode_misses;
        servo.miss_mode();
        assert_eq!(servo.mode_misses, misses, "its mode is known");
    }

    #[test]
    fn the_second_turn_is_another_servos_where_there_is_one() {
        for (ids, second) in [(&[7][..], 0), (&[7, 8], 1), (&[7, 8, 9], 1)] {
            assert_eq!(Servos::new(&list(ids)).housekeeping_second, second);
        }
    }
}
