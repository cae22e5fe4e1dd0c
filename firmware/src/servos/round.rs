//! Reading: every tick all positions, and the housekeeping of two servos in turn.

use super::mode::ServoMode;
use super::registers::{Reading, Registers, Written};
use super::{GAVE_UP, PART_OF_A_ROUND, Servo, Servos};
use crate::board::{Board, since_us};
use crate::bus::{self, Answer, ReadPacket, look};
use crate::design::{LAST_RETRY_US, ROUND_US};
use handstand_shared::control_table::{PRESENT_POSITION, RETURN_DELAY, TORQUE_ENABLE};
use handstand_shared::dynamixel::{ErrorBits, read_packet};
use handstand_shared::message::{ArmLimits, Housekeeping, Statistics, TrippedServo};
use handstand_shared::packed::SERVOS;
use handstand_shared::raw::{Position, ReturnDelay, Supply};
use heapless::Vec;

/// Bytes from the position on that hold the housekeeping too.
const ALL_CHANNELS: u8 = 8;

/// Bytes from torque enable on that hold all of these: one servo a tick is asked for them, and one
/// more while some must be read: 12 to 18 bytes more of each take up to a fiftieth of the period.
const WITH_TORQUE: u8 = bus::MOST_READ as u8;
const _: () =
    assert!(TORQUE_ENABLE.address + WITH_TORQUE == PRESENT_POSITION.address + ALL_CHANNELS);

/// Bytes from the return delay on that hold both angle limits too: 0 in a servo that turns without
/// end.
const MODE: u8 = 5;

/// Of a servo that did not answer.
pub(super) const SILENT: Housekeeping = Housekeeping {
    error: 0xff,
    speed: [0; 2],
    load: [0; 2],
    supply: 0,
    temperature: 0,
};

impl Servos {
    /// Reads all positions, and the housekeeping of two servos in turn; whoever answered in the
    /// last tick and does not now is asked once more at the end, if there is time. A silent servo
    /// costs its own time only.
    ///
    /// `meanwhile` is called once per servo, while its answer is awaited: bytes that come before it
    /// returns wait in the interrupt's queue, which holds a whole answer.
    #[inline(never)]
    pub fn read<B: Board>(
        &mut self,
        board: &mut B,
        statistics: &mut Statistics,
        started: u16,
        mut meanwhile: impl FnMut(),
    ) {
        self.begin_round();
        let mut again: Vec<u8, SERVOS, u8> = Vec::new();
        let mut answer = Answer::default();
        let first = self.request(self.nth(0));
        bus::ask(board, &first);
        let mut is_asked = true;
        for turn in 0..self.count {
            let place = self.nth(turn);
            if !is_asked {
                self.leave_out(place, statistics);
                continue;
            }
            // Made while this answer is awaited, sent as soon as it is there: it is looked at while
            // that goes out.
            let next = self.request(self.nth(turn + 1));
            meanwhile();
            self.hear(board, place, &mut answer);
            // Noise could hold each answer until its time-out: the round ends in time.
            is_asked = since_us(board, started) < ROUND_US;
            if is_asked && turn + 1 < self.count {
                bus::ask(board, &next);
            }
            let was_present = self.is_present(place);
            if !self.take(place, &answer, statistics) {
                if was_present {
                    // There is room for every servo.
                    let _ = again.push(place);
                } else {
                    miss(statistics, place);
                }
            }
        }
        for place in again.iter().copied() {
            let mut found = false;
            if since_us(board, started) < LAST_RETRY_US {
                statistics.retries = statistics.retries.saturating_add(1);
                let request = self.request(place);
                bus::ask(board, &request);
                self.hear(board, place, &mut answer);
                found = self.take(place, &answer, statistics);
            }
            if !found {
                miss(statistics, place);
            }
        }
        if since_us(board, started) < ROUND_US {
            self.ask_mode(board, statistics);
        }
    }

    /// There was no time to ask it.
    #[cold]
    fn leave_out(&mut self, place: u8, statistics: &mut Statistics) {
        if let Some(servo) = self.servos.get_mut(usize::from(place)) {
            servo.hear(false);
        }
        if let Some(slot) = self
            .turn_of(place)
            .and_then(|turn| self.housekeeping.get_mut(turn))
        {
            *slot = SILENT;
        }
        miss(statistics, place);
    }

    fn is_present(&self, place: u8) -> bool {
        self.all()
            .get(usize::from(place))
            .is_some_and(Servo::is_present)
    }

    /// Whether its housekeeping are read in this tick, and as which of the two.
    fn turn_of(&self, place: u8) -> Option<usize> {
        if place == self.housekeeping_from {
            Some(0)
        } else if place == self.housekeeping_second {
            Some(1)
        } else {
            None
        }
    }

    /// Whether its registers are read in this tick, torque and goal among them. Not if it was not
    /// heard in the last one: long answers of two servos of one id spoil their neighbour's.
    fn is_read_whole(&self, place: u8) -> bool {
        let is_chosen = [self.whole_in_turn, self.whole_unread].contains(&Some(place));
        is_chosen && self.is_present(place)
    }

    /// Chooses whose registers are read in this tick: one of those that must be read, the first from
    /// the housekeeping's on; and each in turn, over two rounds, while there are such, or torque is
    /// on.
    #[inline(never)]
    fn choose_whole(&mut self) {
        let from = self.housekeeping_from;
        let is_second = self.rounds & 1 != 0 && self.count > 1;
        let in_turn = if is_second {
            self.housekeeping_second
        } else {
            from
        };
        let is_unread = |servo: &Servo| {
            servo.registers != Registers::AsWritten && servo.armed && servo.is_present()
        };
        let places = (0..).zip(self.all());
        let unread = places.filter(|(_, servo)| is_unread(servo));
        let mut is_due = self.has_torque;
        let (mut first, mut next) = (None, None);
        for (place, _) in unread {
            is_due = true;
            let slot = if place < from { &mut first } else { &mut next };
            if place != in_turn && slot.is_none() {
                *slot = Some(place);
            }
        }
        self.whole_unread = next.or(first);
        self.whole_in_turn = is_due.then_some(in_turn);
    }

    fn bytes_of(&self, place: u8) -> u8 {
        if self.is_read_whole(place) {
            WITH_TORQUE
        } else if self.turn_of(place).is_some() {
            ALL_CHANNELS
        } else {
            PRESENT_POSITION.size
        }
    }

    /// What asks this servo; beyond the last one, nothing of use.
    fn request(&self, place: u8) -> ReadPacket {
        let servo = self.servos.get(usize::from(place));
        let id = servo.map_or(0, |servo| servo.id);
        let address = if self.is_read_whole(place) {
            TORQUE_ENABLE.address
        } else {
            PRESENT_POSITION.address
        };
        read_packet(id, address, self.bytes_of(place))
    }

    #[inline(always)]
    fn hear<B: Board>(&self, board: &mut B, place: u8, answer: &mut Answer) {
        let servo = self.servos.get(usize::from(place));
        let delay = servo.map_or(ReturnDelay::FACTORY, |servo| servo.delay);
        bus::hear(board, self.bytes_of(place), delay, answer);
    }

    /// Takes what a servo answered; whether it did.
    #[inline(never)]
    fn take(&mut self, place: u8, answer: &Answer, statistics: &mut Statistics) -> bool {
        let turn = self.turn_of(place);
        let is_read_whole = self.is_read_whole(place);
        let Some(servo) = self.servos.get_mut(usize::from(place)) else {
            return false;
        };
        let mut whole = None;
        let reading = if is_read_whole {
            look::<{ WITH_TORQUE as usize }>(answer, servo.id).map(|(all, error)| {
                whole = Some(all);
                let [.., p0, p1, s0, s1, l0, l1, supply, temperature] = all;
                ([p0, p1, s0, s1, l0, l1, supply, temperature], error)
            })
        } else if turn.is_some() {
            look::<{ ALL_CHANNELS as usize }>(answer, servo.id)
        } else {
            look::<2>(answer, servo.id)
                .map(|([low, high], error)| ([low, high, 0, 0, 0, 0, 0, 0], error))
        };
        if let Some(turn) = turn {
            let housekeeping = reading.map_or(SILENT, housekeeping_of);
            if reading.is_ok() {
                self.lowest = self.lowest.min(Supply(housekeeping.supply));
            }
            if let Some(slot) = self.housekeeping.get_mut(turn) {
                *slot = housekeeping;
            }
        }
        bus::count(statistics, &reading);
        servo.hear(reading.is_ok());
        if let Ok(([low, high, ..], error)) = reading {
            let code = u16::from_le_bytes([low, high]) & Position::MAX.0;
            servo.position = Position(code);
            self.positions.set(usize::from(place), code);
            let is_as_written =
                whole.is_none_or(|whole| servo.compare(&whole, self.limits, self.has_torque));
            if servo.armed && (error.0 & GAVE_UP != 0 || (self.has_torque && !is_as_written)) {
                servo.armed = false;
                let (id, error) = (servo.id, error.0);
                self.tripped = self.tripped.or(Some(TrippedServo { id, error }));
            }
        }
        servo.is_present()
    }

    /// Moves on to the next two servos; at the end of a round the lowest supply of it is known.
    fn begin_round(&mut self) {
        let next = self.after(self.housekeeping_second);
        if next <= self.housekeeping_from {
            let is_none = [Supply(u8::MAX), PART_OF_A_ROUND].contains(&self.lowest);
            self.supply = (!is_none).then_some(self.lowest);
            self.lowest = Supply(u8::MAX);
            self.rounds = self.rounds.wrapping_add(1);
        }
        self.housekeeping_from = next;
        self.housekeeping_second = self.after(next);
        self.choose_whole();
    }

    fn after(&self, place: u8) -> u8 {
        if place + 1 < self.count { place + 1 } else { 0 }
    }

    /// Asks one servo per tick for its return delay and mode, until each that is there has said
    /// them.
    fn ask_mode<B: Board>(&mut self, board: &mut B, statistics: &mut Statistics) {
        let asked = self.asked;
        let places = (0..).zip(self.all());
        let mut unknown = places
            .filter(|(_, servo)| servo.mode == ServoMode::Unknown && servo.is_present())
            .map(|(place, _)| place);
        let Some(first) = unknown.next() else { return };
        let is_behind = first <= asked;
        let next = unknown.find(|place| is_behind && *place > asked);
        let place = next.unwrap_or(first);
        self.asked = place;
        let Some(servo) = self.all_mut().get_mut(usize::from(place)) else {
            return;
        };
        let mut answer = Answer::default();
        let request = read_packet(servo.id, RETURN_DELAY.address, MODE);
        bus::ask(board, &request);
        bus::hear(board, MODE, servo.delay, &mut answer);
        let mode = look::<{ MODE as usize }>(&answer, servo.id);
        bus::count(statistics, &mode);
        if let Ok(([code, limits @ ..], _)) = mode {
            servo.delay = ReturnDelay(code);
            servo.mode = match limits {
                [0, 0, 0, 0] => ServoMode::Wheel,
                _ => ServoMode::Joint,
            };
        } else {
            servo.miss_mode();
        }
    }
}

impl Servo {
    /// Whether its registers hold what it was written; if so it is commanded, from where it stands
    /// if it was silent for long.
    fn compare(&mut self, reading: &Reading, limits: ArmLimits, has_torque: bool) -> bool {
        let written = Written {
            mode: self.mode,
            goal: self.goal,
            limits,
            has_torque,
        };
        let is_as_written = written.is_in(reading);
        if is_as_written {
            if self.registers == Registers::Withheld {
                self.goal = self.position;
            }
            self.registers = Registers::AsWritten;
        } else if self.armed && !has_torque {
            self.registers = Registers::Differ;
        }
        is_as_written
    }
}

fn housekeeping_of(
    ([_, _, s0, s1, l0, l1, supply, temperature], error): ([u8; 8], ErrorBits),
) -> Housekeeping {
    Housekeeping {
        error: error.0,
        speed: [s0, s1],
        load: [l0, l1],
        supply,
        temperature,
    }
}

fn miss(statistics: &mut Statistics, place: u8) {
    if let Some(missed) = statistics.missed.get_mut(usize::from(place)) {
        *missed = missed.saturating_add(1);
    }
}

#[cfg(test)]
mod tests;
