//! The servos as a group: who they are, where they are, and what they last said.

use crate::board::{Board, since_us};
use crate::bus::{self, Answer, ReadPacket, look};
use crate::design::{GOAL_SLEW, LAST_RETRY_US};
use handstand_shared::control_table::{
    GOAL_POSITION, MOVING_SPEED, PRESENT_POSITION, RETURN_DELAY, Register, TORQUE_ENABLE,
    TORQUE_LIMIT,
};
use handstand_shared::dynamixel::{ErrorBits, read_packet};
use handstand_shared::message::{Roster, Slow, Statistics};
use handstand_shared::packed::{Positions, SERVOS};
use handstand_shared::raw::{Position, ReturnDelay, Signed, Supply, TorqueLimit};
use heapless::Vec;

/// Bytes from the position on that hold the slow channels too.
const ALL_CHANNELS: u8 = bus::MOST_READ as u8;

/// One servo.
#[derive(Debug, Clone, Copy)]
pub struct Servo {
    /// Its id on the bus.
    pub id: u8,
    /// Its return delay; the factory's until it was asked.
    delay: ReturnDelay,
    /// Where it was when it last answered.
    pub position: Position,
    /// Whether it answered in this tick.
    pub present: bool,
    /// Whether it is commanded.
    pub armed: bool,
    /// The goal it was last sent.
    pub goal: Position,
}

/// All of them, in the roster's order.
#[derive(Debug, Clone)]
pub struct Servos {
    servos: [Servo; SERVOS],
    count: u8,
    /// Their positions, as they are reported.
    pub positions: Positions,
    /// How many have been asked for their return delay.
    asked: u8,
    /// Place of the first servo whose slow channels are read in this tick.
    pub slow_from: u8,
    slow_second: u8,
    /// The slow channels read in this tick.
    pub slow: [Slow; 2],
    /// The lowest supply in the round of slow channels before this one.
    pub supply: Option<Supply>,
    lowest: Supply,
    /// Rounds of slow channels so far, modulo 256.
    pub rounds: u8,
    /// Error bits any commanded servo reported in this tick.
    pub errors: ErrorBits,
}

const SILENT: Slow = Slow {
    error: 0xff,
    speed: [0; 2],
    load: [0; 2],
    supply: 0,
    temperature: 0,
};

impl Servos {
    /// Nothing is known of them but their ids.
    pub fn new(roster: &Roster) -> Self {
        let unknown = Servo {
            id: 0,
            delay: ReturnDelay::FACTORY,
            position: Position::CENTRE,
            present: false,
            armed: false,
            goal: Position::CENTRE,
        };
        let mut servos = [unknown; SERVOS];
        (servos.iter_mut().zip(roster.ids())).for_each(|(servo, id)| servo.id = *id);
        Servos {
            servos,
            count: roster.ids().len() as u8,
            positions: Positions::pack([Position::CENTRE.0; SERVOS]),
            asked: 0,
            slow_from: 0,
            slow_second: if roster.ids().len() > 1 { 1 } else { 0 },
            slow: [SILENT; 2],
            supply: None,
            lowest: Supply(u8::MAX),
            rounds: 0,
            errors: ErrorBits(0),
        }
    }

    /// Those of the roster.
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

    /// Reads all positions, and the slow channels of two servos in turn; whoever answered in the last tick and does not
    /// now is asked once more at the end, if there is time. A silent servo costs its own time only.
    #[inline(never)]
    pub fn read<B: Board>(&mut self, board: &mut B, statistics: &mut Statistics, started: u16) {
        self.begin_round();
        self.errors = ErrorBits(0);
        let mut again: Vec<u8, SERVOS, u8> = Vec::new();
        let mut answer = Answer::default();
        let first = self.request(0);
        bus::ask(board, &first);
        for place in 0..self.count {
            // Made while this answer is awaited, sent as soon as it is there: it is looked at while that goes out.
            let next = self.request(place + 1);
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

    /// Whether its slow channels are read in this tick, and as which of the two.
    fn turn_of(&self, place: u8) -> Option<usize> {
        if place == self.slow_from {
            Some(0)
        } else if place == self.slow_second {
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
                let slow = reading.map_or(SILENT, slow_of);
                if reading.is_ok() {
                    self.lowest = self.lowest.min(Supply(slow.supply));
                }
                if let Some(slot) = self.slow.get_mut(turn) {
                    *slot = slow;
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
            if servo.armed {
                self.errors = self.errors.with(error);
            }
        }
        servo.present
    }

    /// Those that did not answer in this tick: a bit each.
    pub fn missing(&self) -> u32 {
        // A bit that moves on: shifting by a variable costs the AVR a loop.
        let (mut missing, mut bit) = (0u32, 1u32);
        for servo in self.all() {
            missing |= if servo.present { 0 } else { bit };
            bit <<= 1;
        }
        missing
    }

    /// Moves on to the next two servos; at the end of a round the lowest supply of it is known.
    fn begin_round(&mut self) {
        let next = self.after(self.slow_second);
        if next <= self.slow_from {
            self.supply = Some(self.lowest).filter(|lowest| *lowest != Supply(u8::MAX));
            self.lowest = Supply(u8::MAX);
            self.rounds = self.rounds.wrapping_add(1);
        }
        self.slow_from = next;
        self.slow_second = self.after(next);
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

    /// Torque on where a servo answered: full limit, and the goal where it stands.
    pub fn arm<B: Board>(&mut self, board: &mut B) {
        for servo in self.all_mut() {
            servo.armed = servo.present;
            servo.goal = servo.position;
        }
        bus::write_all(board, TORQUE_LIMIT, TorqueLimit::FULL.0);
        self.write_each(board, MOVING_SPEED, |_| 0);
        self.write_each(board, GOAL_POSITION, |servo| servo.goal.0);
        self.write_each(board, TORQUE_ENABLE, |_| 1);
    }

    /// Torque off everywhere.
    pub fn disarm<B: Board>(&mut self, board: &mut B) {
        bus::torque_off(board);
        for servo in self.all_mut() {
            servo.armed = false;
        }
    }

    /// Sends goals, each at most [`GOAL_SLEW`] from the last.
    pub fn go_to<B: Board>(&mut self, board: &mut B, goals: &Positions) {
        let armed = self.armed();
        let moved = self
            .all_mut()
            .iter_mut()
            .enumerate()
            .filter_map(|(place, servo)| {
                let from = servo.goal.0;
                let nearest = from.saturating_sub(GOAL_SLEW);
                let farthest = from.saturating_add(GOAL_SLEW).min(Position::MAX.0);
                let goal = goals.get(place).max(nearest).min(farthest);
                servo.goal = Position(goal);
                servo.armed.then_some((servo.id, goal))
            });
        bus::write_each(board, GOAL_POSITION, armed, moved);
    }

    /// Sends commands to servos in wheel mode, in the roster's order.
    pub fn spin<B: Board>(&self, board: &mut B, speeds: impl Iterator<Item = u16>) {
        let all = self.all().iter().zip(speeds);
        let commanded = all.filter(|(servo, _)| servo.armed);
        let commands = commanded.map(|(servo, code)| (servo.id, code));
        bus::write_each(board, MOVING_SPEED, self.armed(), commands);
    }

    /// Sends commands to servos in wheel mode, each given with its id.
    pub fn turn<B: Board>(&self, board: &mut B, commands: impl Iterator<Item = (u8, Signed)>) {
        let armed = |id: u8| self.with_id(id).is_some_and(|servo| servo.armed);
        let mut known: Vec<(u8, u16), SERVOS, u8> = Vec::new();
        for (id, code) in commands.filter(|(id, _)| armed(*id)).take(SERVOS) {
            // There is room for as many as are taken.
            let _ = known.push((id, code.0));
        }
        bus::write_each(
            board,
            MOVING_SPEED,
            known.len() as u8,
            known.iter().copied(),
        );
    }

    /// Goals where the servos stand now.
    pub fn hold<B: Board>(&mut self, board: &mut B) {
        for servo in self.all_mut() {
            servo.goal = servo.position;
        }
        self.write_each(board, GOAL_POSITION, |servo| servo.goal.0);
    }

    /// How many are commanded.
    fn armed(&self) -> u8 {
        self.all().iter().map(|servo| u8::from(servo.armed)).sum()
    }

    fn write_each<B: Board>(
        &self,
        board: &mut B,
        register: Register,
        value: impl Fn(&Servo) -> u16,
    ) {
        let armed = self.all().iter().filter(|servo| servo.armed);
        let values = armed.map(|servo| (servo.id, value(servo)));
        bus::write_each(board, register, self.armed(), values);
    }
}

fn slow_of(([_, _, s0, s1, l0, l1, supply, temperature], error): ([u8; 8], ErrorBits)) -> Slow {
    Slow {
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
