//! The servos as a group: who they are, where they are, and what they last said.

use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::message::{ArmLimits, Cause, Housekeeping, ServoList, TrippedServo};
use handstand_shared::packed::{Positions, SERVOS};
use handstand_shared::raw::{Position, ReturnDelay, Supply};

mod commands;
mod mode;
mod registers;
mod round;

use mode::ServoMode;
use registers::Registers;

/// Error bits of a servo that drops its torque, or is about to.
const GAVE_UP: u8 = ErrorBits::OVERLOAD.0 | ErrorBits::OVERHEAT.0;

/// Requests in a row that a servo may leave unanswered and is commanded all the same. Three ticks.
const MOST_UNANSWERED: u8 = 4;

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
    /// Where it was when it last answered.
    pub position: Position,
    /// Requests in a row that it did not answer: two in the first tick in which it is silent, then
    /// one a tick.
    unanswered: u8,
    /// Whether it is commanded.
    pub armed: bool,
    /// Whether its registers were read, and are as they were written.
    registers: Registers,
    /// Whether they are read in this tick.
    is_read_whole: bool,
    /// The goal it was last sent.
    pub goal: Position,
}

impl Servo {
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
        }
    }

    /// Whether it answered in one of the last three ticks: an answer that is lost as torque comes
    /// on would leave a joint to one of its two servos.
    fn was_heard_lately(&self) -> bool {
        self.unanswered <= MOST_UNANSWERED
    }

    /// Whether it gets goals: one that was silent for longer has its torque off, or another goal,
    /// until it was read.
    fn takes_goals(&self) -> bool {
        self.armed && self.registers != Registers::Withheld
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
        let unknown = Servo {
            id: 0,
            delay: ReturnDelay::FACTORY,
            mode: ServoMode::Unknown,
            position: Position::CENTRE,
            unanswered: u8::MAX,
            armed: false,
            registers: Registers::Unread,
            is_read_whole: false,
            goal: Position::CENTRE,
        };
        let mut servos = [unknown; SERVOS];
        (servos.iter_mut().zip(list.ids())).for_each(|(servo, id)| servo.id = *id);
        let mut order = [0; SERVOS];
        (order.iter_mut().zip(0..)).for_each(|(slot, place)| *slot = place);
        Servos {
            servos,
            order,
            count: list.ids().len() as u8,
            positions: Positions::pack([Position::CENTRE.0; SERVOS]),
            asked: 0,
            housekeeping_from: 0,
            housekeeping_second: if list.ids().len() > 1 { 1 } else { 0 },
            housekeeping: [round::SILENT; 2],
            supply: None,
            lowest: Supply(u8::MAX),
            rounds: 0,
            tripped: None,
            has_torque: false,
            limits: ArmLimits::NONE,
        }
    }

    /// Forgets all but the ids of this list. Apart, so that what calls it does not hold a second
    /// one on the stack.
    #[inline(never)]
    pub fn start_over(&mut self, list: &ServoList) {
        *self = Servos::new(list);
    }

    /// Reads these two last, the second of them after the first; the others in the list's order.
    #[inline(never)]
    pub fn read_last(&mut self, ids: [u8; 2]) {
        let count = self.count;
        let mut order = [0; SERVOS];
        let mut slots = order.iter_mut();
        let [first, second] = ids;
        for turn in 0..3 {
            for (place, servo) in (0..count).zip(&self.servos) {
                let own = if servo.id == first {
                    1
                } else if servo.id == second {
                    2
                } else {
                    0
                };
                if own == turn
                    && let Some(slot) = slots.next()
                {
                    *slot = place;
                }
            }
        }
        self.order = order;
    }

    /// Place of the servo that is read at this turn; beyond the last one, a place that is none.
    fn nth(&self, turn: u8) -> u8 {
        match turn < self.count {
            true => self.order.get(usize::from(turn)).copied().unwrap_or(turn),
            false => turn,
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
    pub fn with_id(&self, id: u8) -> Option<&Servo> {
        self.all().iter().find(|servo| servo.id == id)
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
        }
    }

    /// Whether all that would be armed now have said their mode.
    pub fn modes_are_known(&self) -> bool {
        let unknown = |servo: &Servo| servo.mode == ServoMode::Unknown;
        !self
            .all()
            .iter()
            .any(|servo| servo.was_heard_lately() && unknown(servo))
    }

    /// Those that did not answer in this tick: a bit each.
    pub fn missing(&self) -> u32 {
        // A bit that moves on: shifting by a variable costs the AVR a loop.
        let (mut missing, mut bit) = (0u32, 1u32);
        for servo in self.all() {
            missing |= if servo.is_present() { 0 } else { bit };
            bit <<= 1;
        }
        missing
    }
}
