//! Reading: every tick all positions, and the housekeeping of two servos in turn.

use super::Servos;
use crate::board::{Board, since_us};
use crate::bus::{self, Answer, ReadPacket, look};
use crate::design::LAST_RETRY_US;
use handstand_shared::control_table::{PRESENT_POSITION, RETURN_DELAY};
use handstand_shared::dynamixel::{ErrorBits, read_packet};
use handstand_shared::message::{Housekeeping, Statistics, TrippedServo};
use handstand_shared::packed::SERVOS;
use handstand_shared::raw::{Position, ReturnDelay, Supply};
use heapless::Vec;

/// Bytes from the position on that hold the housekeeping too.
const ALL_CHANNELS: u8 = bus::MOST_READ as u8;

/// Error bits of a servo that drops its torque, or is about to.
const GAVE_UP: u8 = ErrorBits::OVERLOAD.0 | ErrorBits::OVERHEAT.0;

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
        let first = self.request(0);
        bus::ask(board, &first);
        for place in 0..self.count {
            // Made while this answer is awaited, sent as soon as it is there: it is looked at while
            // that goes out.
            let next = self.request(place + 1);
            meanwhile();
            self.hear(board, place, &mut answer);
            if place + 1 < self.count {
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
        self.ask_delay(board, statistics);
    }

    fn is_present(&self, place: u8) -> bool {
        self.all()
            .get(usize::from(place))
            .is_some_and(|servo| servo.present)
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

    fn bytes_of(&self, place: u8) -> u8 {
        match self.turn_of(place) {
            Some(_) => ALL_CHANNELS,
            None => PRESENT_POSITION.size,
        }
    }

    /// What asks this servo; beyond the last one, nothing of use.
    fn request(&self, place: u8) -> ReadPacket {
        let servo = self.servos.get(usize::from(place));
        let id = servo.map_or(0, |servo| servo.id);
        read_packet(id, PRESENT_POSITION.address, self.bytes_of(place))
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
        let Some(servo) = self.servos.get_mut(usize::from(place)) else {
            return false;
        };
        let reading = match turn {
            None => look::<2>(answer, servo.id),
            Some(turn) => {
                let reading = look::<{ ALL_CHANNELS as usize }>(answer, servo.id);
                let housekeeping = reading.map_or(SILENT, housekeeping_of);
                if reading.is_ok() {
                    self.lowest = self.lowest.min(Supply(housekeeping.supply));
                }
                if let Some(slot) = self.housekeeping.get_mut(turn) {
                    *slot = housekeeping;
                }
                reading.map(|([low, high, ..], error)| ([low, high], error))
            }
        };
        bus::count(statistics, &reading);
        servo.present = reading.is_ok();
        if let Ok((position, error)) = reading {
            let code = u16::from_le_bytes(position) & Position::MAX.0;
            servo.position = Position(code);
            self.positions.set(usize::from(place), code);
            if servo.armed && error.0 & GAVE_UP != 0 {
                servo.armed = false;
                let (id, error) = (servo.id, error.0);
                self.tripped = self.tripped.or(Some(TrippedServo { id, error }));
            }
        }
        servo.present
    }

    /// Moves on to the next two servos; at the end of a round the lowest supply of it is known.
    fn begin_round(&mut self) {
        let next = self.after(self.housekeeping_second);
        if next <= self.housekeeping_from {
            self.supply = Some(self.lowest).filter(|lowest| *lowest != Supply(u8::MAX));
            self.lowest = Supply(u8::MAX);
            self.rounds = self.rounds.wrapping_add(1);
        }
        self.housekeeping_from = next;
        self.housekeeping_second = self.after(next);
    }

    fn after(&self, place: u8) -> u8 {
        if place + 1 < self.count { place + 1 } else { 0 }
    }

    /// Asks one servo per tick for its return delay, until all were asked.
    fn ask_delay<B: Board>(&mut self, board: &mut B, statistics: &mut Statistics) {
        let asked = usize::from(self.asked);
        let Some(servo) = self.all_mut().get_mut(asked) else {
            return;
        };
        let mut answer = Answer::default();
        let request = read_packet(servo.id, RETURN_DELAY.address, RETURN_DELAY.size);
        bus::ask(board, &request);
        bus::hear(board, RETURN_DELAY.size, servo.delay, &mut answer);
        let delay = look::<1>(&answer, servo.id);
        bus::count(statistics, &delay);
        if let Ok(([code], _)) = delay {
            servo.delay = ReturnDelay(code);
        }
        self.asked += 1;
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
