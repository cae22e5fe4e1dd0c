//! The servos as a group: who they are, where they are, and what they last said.

use crate::board::{Board, since_us};
use crate::bus::{self, Failure};
use crate::design::{GOAL_SLEW, LAST_RETRY_US};
use handstand_shared::control_table::{
    GOAL_POSITION, MOVING_SPEED, PRESENT_POSITION, RETURN_DELAY, TORQUE_ENABLE, TORQUE_LIMIT,
};
use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::message::{Roster, Slow, Statistics};
use handstand_shared::packed::SERVOS;
use handstand_shared::raw::{Position, ReturnDelay, Signed, Supply, TorqueLimit};

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
    /// How many have been asked for their return delay.
    asked: u8,
    /// Place of the first servo whose slow channels are read in this tick.
    pub slow_from: u8,
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
            asked: 0,
            slow_from: 0,
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

    /// Reads all positions, and the slow channels of two servos in turn. A silent servo costs its own time only.
    #[inline(never)]
    pub fn read<B: Board>(&mut self, board: &mut B, statistics: &mut Statistics, started: u16) {
        self.begin_round();
        let slow_next = self.after(self.slow_from);
        let mut errors = 0;
        let all = self.servos.iter_mut().zip(&mut statistics.missed);
        // The counters and the rest of the statistics are changed in turn.
        let mut counted = Statistics::default();
        for (place, (servo, missed)) in (0..self.count).zip(all) {
            let reading = if place == self.slow_from || place == slow_next {
                let turn = usize::from(place != self.slow_from);
                let reading = read::<B, 8>(board, servo, &mut counted, started);
                let slow = reading.map_or(SILENT, slow_of);
                if reading.is_ok() {
                    self.lowest = self.lowest.min(Supply(slow.supply));
                }
                if let Some(slot) = self.slow.get_mut(turn) {
                    *slot = slow;
                }
                reading.map(|([low, high, ..], error)| ([low, high], error))
            } else {
                read::<B, 2>(board, servo, &mut counted, started)
            };
            servo.present = reading.is_ok();
            match reading {
                Ok((position, error)) => {
                    servo.position = Position(u16::from_le_bytes(position) & Position::MAX.0);
                    errors |= if servo.armed { error.0 } else { 0 };
                }
                Err(_) => *missed = missed.saturating_add(1),
            }
        }
        self.errors = ErrorBits(errors);
        add(statistics, &counted);
        self.ask_delay(board, statistics);
    }

    /// Moves on to the next two servos; at the end of a round the lowest supply of it is known.
    fn begin_round(&mut self) {
        let second = self.after(self.slow_from);
        let next = self.after(second);
        if next <= self.slow_from {
            self.supply = Some(self.lowest).filter(|lowest| *lowest != Supply(u8::MAX));
            self.lowest = Supply(u8::MAX);
            self.rounds = self.rounds.wrapping_add(1);
        }
        self.slow_from = next;
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
        let delay = bus::read::<B, 1>(board, servo.id, RETURN_DELAY.address, servo.delay);
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
        bus::write_each(board, MOVING_SPEED, self.commanded(|_| 0));
        bus::write_each(board, GOAL_POSITION, self.commanded(|servo| servo.goal.0));
        bus::write_each(board, TORQUE_ENABLE, self.commanded(|_| 1));
    }

    /// Torque off everywhere.
    pub fn disarm<B: Board>(&mut self, board: &mut B) {
        bus::torque_off(board);
        for servo in self.all_mut() {
            servo.armed = false;
        }
    }

    /// Sends goals, each at most [`GOAL_SLEW`] from the last.
    pub fn go_to<B: Board>(&mut self, board: &mut B, goals: impl Iterator<Item = u16>) {
        for (servo, goal) in self.all_mut().iter_mut().zip(goals) {
            let from = servo.goal.0;
            let nearest = from.saturating_sub(GOAL_SLEW);
            let farthest = from.saturating_add(GOAL_SLEW).min(Position::MAX.0);
            servo.goal = Position(goal.max(nearest).min(farthest));
        }
        bus::write_each(board, GOAL_POSITION, self.commanded(|servo| servo.goal.0));
    }

    /// Sends commands to servos in wheel mode, each given with its id.
    pub fn turn<B: Board>(&self, board: &mut B, commands: impl Iterator<Item = (u8, Signed)>) {
        let armed = |id: u8| self.with_id(id).is_some_and(|servo| servo.armed);
        let commands = commands.filter(|(id, _)| armed(*id));
        bus::write_each(board, MOVING_SPEED, commands.map(|(id, code)| (id, code.0)));
    }

    /// Goals where the servos stand now.
    pub fn hold<B: Board>(&mut self, board: &mut B) {
        for servo in self.all_mut() {
            servo.goal = servo.position;
        }
        bus::write_each(board, GOAL_POSITION, self.commanded(|servo| servo.goal.0));
    }

    fn commanded(&self, value: impl Fn(&Servo) -> u16) -> impl Iterator<Item = (u8, u16)> {
        let armed = self.all().iter().filter(|servo| servo.armed);
        armed.map(move |servo| (servo.id, value(servo)))
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

/// Adds one tick's counts.
fn add(to: &mut Statistics, tick: &Statistics) {
    to.answers = to.answers.saturating_add(tick.answers);
    to.timeouts = to.timeouts.saturating_add(tick.timeouts);
    to.garbled = to.garbled.saturating_add(tick.garbled);
    to.strangers = to.strangers.saturating_add(tick.strangers);
    to.retries = to.retries.saturating_add(tick.retries);
}

/// Reads from the position on; once more if the servo answered in the last tick and there is time.
fn read<B: Board, const N: usize>(
    board: &mut B,
    servo: &Servo,
    statistics: &mut Statistics,
    started: u16,
) -> Result<([u8; N], ErrorBits), Failure> {
    let mut reading = bus::read(board, servo.id, PRESENT_POSITION.address, servo.delay);
    bus::count(statistics, &reading);
    if reading.is_err() && servo.present && since_us(board, started) < LAST_RETRY_US {
        statistics.retries = statistics.retries.saturating_add(1);
        reading = bus::read(board, servo.id, PRESENT_POSITION.address, servo.delay);
        bus::count(statistics, &reading);
    }
    reading
}
