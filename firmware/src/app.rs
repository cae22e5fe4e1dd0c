//! What the firmware does: its states, one tick, and the commands.

use crate::balance::{Balance, Stop};
use crate::board::{Board, since_us};
use crate::design::{FADE_TICKS, LOW_ROUNDS, LOW_SUPPLY, SILENT_TICKS, TICK_US};
use crate::filter::{Filter, Way};
use crate::link::Link;
use crate::panel::{Buttons, button, leds};
use crate::servos::Servos;
use crate::slots::Writer;
use crate::{boots, bus};
use handstand_shared::control_table::TORQUE_LIMIT;
use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::message::{
    Attitude, Cause, Condition, Mode, Report, Roster, Statistics, StreamReport,
};
use handstand_shared::packed::{Positions, SERVOS, Speeds};
use handstand_shared::raw::TorqueLimit;

mod command;

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

/// What the host wants of the servos.
#[derive(Debug, Clone, Copy)]
enum Wish {
    /// Nothing since arming: stay.
    Stay,
    Positions(Positions),
    Speeds(Speeds),
}

/// The firmware, apart from its hardware.
#[derive(Debug)]
pub struct App {
    state: State,
    link: Link,
    filter: Filter,
    servos: Servos,
    statistics: Statistics,
    buttons: Buttons,
    writer: Writer,
    wish: Wish,
    balance: Balance,
    attitude: Attitude,
    /// Sequence number of the frame `wish` came in.
    obeyed: u8,
    /// What arming must bring; none before a greeting and after every fault.
    token: Option<u16>,
    /// Number of this start, and of the greetings in it from a number of chance on: what tokens are made of.
    boots: u8,
    greetings: Option<u8>,
    ticks: u32,
    /// Ticks since the last sound frame.
    silent: u8,
    /// Rounds in a row with a low supply, and the round last looked at.
    low: (u8, u8),
    overruns: u16,
    tick_us: u16,
    longest_tick_us: u16,
    longest_law_us: u16,
    /// Whether it has looked for a plan.
    has_looked: bool,
}

impl App {
    /// Torque off first of all, then everything else. A watchdog's reset is a fault.
    pub fn boot<B: Board>(board: &mut B) -> Self {
        bus::torque_off(board);
        let state = if board.reset_cause().is_watchdog() {
            State::Fault(Cause::Watchdog)
        } else {
            State::Bridge
        };
        App {
            state,
            link: Link::default(),
            filter: Filter::default(),
            servos: Servos::new(&Roster::default()),
            statistics: Statistics::default(),
            buttons: Buttons::default(),
            writer: Writer::new(board),
            wish: Wish::Stay,
            balance: Balance::NONE,
            attitude: Attitude::default(),
            obeyed: 0,
            token: None,
            boots: boots::count(board) as u8,
            greetings: None,
            ticks: 0,
            silent: 0,
            low: (0, 0),
            overruns: 0,
            tick_us: 0,
            longest_tick_us: 0,
            longest_law_us: 0,
            has_looked: false,
        }
    }

    /// What it is doing.
    pub fn state(&self) -> State {
        self.state
    }

    /// As the host is told.
    pub fn condition(&self) -> Condition {
        match self.state {
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

    /// One turn of the main loop: passes bytes on, and runs a tick when it is due.
    pub fn run<B: Board>(&mut self, board: &mut B) {
        if !self.has_looked {
            // Not while booting: what boots is moved, and RAM has no room for two plans.
            self.has_looked = true;
            self.load_plan(board);
        }
        self.pump(board);
        if board.tick_due() {
            self.tick(board);
            // Here and nowhere else: only a completed tick proves that the firmware is alive.
            board.feed_watchdog();
        }
    }

    /// Handles what has come from the PC and, as an adapter, from the servos.
    fn pump<B: Board>(&mut self, board: &mut B) {
        // Bounded, so that a babbling line cannot starve the tick.
        for _ in 0..64 {
            let Some(byte) = board.link_receive() else {
                break;
            };
            self.take(board, byte);
        }
        if self.state == State::Bridge {
            for _ in 0..64 {
                match board.bus_receive(0) {
                    Some(byte) => board.link_send(&[byte]),
                    None => break,
                }
            }
        }
    }

    #[inline(never)]
    fn take<B: Board>(&mut self, board: &mut B, byte: u8) {
        if self.state == State::Bridge && self.filter.push(byte) == Way::Bus {
            board.bus_send(&[byte]);
            return;
        }
        if byte == 0 && !self.link.is_idle() {
            self.filter.end_frame();
        }
        if let Some(command) = self.link.push(byte, &mut self.statistics) {
            self.silent = 0;
            self.obey(board, command);
        }
    }

    /// Everything that happens once per period.
    // One function of everything would be too long for the AVR's relative jumps: its parts stay apart.
    #[inline(never)]
    pub fn tick<B: Board>(&mut self, board: &mut B) {
        let started = board.clock();
        self.ticks = self.ticks.wrapping_add(1);
        self.silent = self.silent.saturating_add(1);
        self.panel(board);
        if self.filter.tick() {
            self.link.reset();
        }
        if let Some((sequence, is_new)) = self.writer.tick(board) {
            if is_new {
                self.load_plan(board);
            }
            self.stored(board, sequence);
        }
        self.state = match self.state {
            State::Bridge => State::Bridge,
            State::Stream(Drive::Off) => self.watch(board, started),
            State::Balance(Drive::Off) => self.watch(board, started),
            State::Fault(_) => self.insist(board, started),
            State::Stream(Drive::On) => self.stream(board, started),
            State::Balance(Drive::On) => self.balance(board, started),
            State::Stream(Drive::Soft { left, cause }) => {
                self.fade(board, started, left, cause, State::Stream)
            }
            State::Balance(Drive::Soft { left, cause }) => {
                self.fade(board, started, left, cause, State::Balance)
            }
        };
        self.account(board, started);
    }

    /// Torque off: reads and reports.
    #[inline(never)]
    fn watch<B: Board>(&mut self, board: &mut B, started: u16) -> State {
        self.servos.read(board, &mut self.statistics, started);
        self.report(board);
        self.state
    }

    /// Torque must stay off: says so ten times a second, for a servo may have missed it.
    fn insist<B: Board>(&mut self, board: &mut B, started: u16) -> State {
        if self.ticks & 7 == 0 {
            bus::torque_off(board);
        }
        self.watch(board, started)
    }

    /// Goals first, for their delay counts most; then reads and reports.
    #[inline(never)]
    fn stream<B: Board>(&mut self, board: &mut B, started: u16) -> State {
        if let Some(cause) = self.must_stop() {
            return self.soften(board, started, cause, State::Stream);
        }
        match self.wish {
            Wish::Stay => {}
            Wish::Positions(goals) => self.servos.go_to(board, &goals),
            Wish::Speeds(speeds) => self.servos.spin(board, speeds.codes()),
        }
        self.watch(board, started)
    }

    /// Reads, then the law at once, then the report.
    #[inline(never)]
    fn balance<B: Board>(&mut self, board: &mut B, started: u16) -> State {
        if let Some(cause) = self.must_stop() {
            return self.soften(board, started, cause, State::Balance);
        }
        self.servos.read(board, &mut self.statistics, started);
        let law_started = board.clock();
        let gyro = board.gyro();
        self.balance.sense(self.attitude, gyro);
        let readings = match self.balance.readings(&self.servos) {
            Ok(readings) => readings,
            Err(Stop::Fallen) => return self.give_up(board, Cause::Fallen),
            Err(Stop::ServoLost) => return self.give_up(board, Cause::ServoLost),
        };
        // A servo that went limp leaves the other ones to throw the robot.
        let limp = ErrorBits::OVERLOAD.0 | ErrorBits::OVERHEAT.0;
        if self.servos.errors.0 & limp != 0 {
            return self.give_up(board, Cause::ServoError);
        }
        let commands = self.balance.commands(&readings);
        let law_us = since_us(board, law_started);
        self.servos.turn(board, commands);
        // What only the next tick needs delays no command.
        let learn_started = board.clock();
        self.balance.learn();
        let law_us = law_us.saturating_add(since_us(board, learn_started));
        self.longest_law_us = self.longest_law_us.max(law_us);
        self.report(board);
        self.state
    }

    /// Torque off at once: there is nothing left to hold.
    fn give_up<B: Board>(&mut self, board: &mut B, cause: Cause) -> State {
        self.disarm(board);
        State::Fault(cause)
    }

    /// Whether an armed robot must be let down.
    fn must_stop(&mut self) -> Option<Cause> {
        let (low, round) = self.low;
        if self.servos.rounds != round {
            let is_low = self.servos.supply.is_none_or(|supply| supply < LOW_SUPPLY);
            self.low = (
                if is_low { low.saturating_add(1) } else { 0 },
                self.servos.rounds,
            );
        }
        if self.silent > SILENT_TICKS {
            Some(Cause::LinkLost)
        } else if self.low.0 >= LOW_ROUNDS {
            Some(Cause::LowSupply)
        } else {
            None
        }
    }

    /// Holds the positions and begins to fade.
    #[inline(never)]
    fn soften<B: Board>(
        &mut self,
        board: &mut B,
        started: u16,
        cause: Cause,
        within: fn(Drive) -> State,
    ) -> State {
        // A servo in wheel mode has no position to hold: it stops.
        let balanced = matches!(self.state, State::Balance(_));
        if balanced || matches!(self.wish, Wish::Speeds(_)) {
            self.servos.spin(board, [0; SERVOS].into_iter());
        } else {
            self.servos.hold(board);
        }
        self.fade(board, started, FADE_TICKS, cause, within)
    }

    /// Lowers every servo's torque limit in equal steps; at none, torque goes off.
    #[inline(never)]
    fn fade<B: Board>(
        &mut self,
        board: &mut B,
        started: u16,
        left: u8,
        cause: Cause,
        within: fn(Drive) -> State,
    ) -> State {
        let Some(left) = left.checked_sub(1) else {
            self.disarm(board);
            self.watch(board, started);
            return State::Fault(cause);
        };
        const STEP: u16 = TorqueLimit::FULL.0 / FADE_TICKS as u16;
        bus::write_all(board, TORQUE_LIMIT, STEP * u16::from(left));
        self.state = within(Drive::Soft { left, cause });
        self.watch(board, started)
    }

    /// Torque off, and nothing that was said before arms again.
    fn disarm<B: Board>(&mut self, board: &mut B) {
        self.servos.disarm(board);
        self.token = None;
        self.wish = Wish::Stay;
    }

    #[inline(never)]
    fn report<B: Board>(&mut self, board: &mut B) {
        let [m0, m1, m2, _] = self.servos.missing().to_le_bytes();
        let report = StreamReport {
            tick: self.ticks as u16,
            condition: self.condition(),
            obeyed: self.obeyed,
            positions: self.servos.positions,
            missing: [m0, m1, m2],
            slow_from: self.servos.slow_from,
            slow: self.servos.slow,
        };
        self.link.send(board, &Report::Stream(report));
    }

    /// Buttons and LEDs.
    #[inline(never)]
    fn panel<B: Board>(&mut self, board: &mut B) {
        let pressed = self.buttons.pressed(board.buttons());
        if pressed != 0 {
            self.press(board, pressed);
        }
        let all_answer = self.servos.missing() == 0;
        let lit = leds(
            self.condition(),
            self.ticks,
            self.silent <= SILENT_TICKS,
            all_answer,
        );
        board.set_leds(lit);
    }

    /// Any button stops a robot that is armed. Start chooses balancing while torque is off; the host arms.
    fn press<B: Board>(&mut self, board: &mut B, pressed: u8) {
        match self.state {
            State::Stream(Drive::On | Drive::Soft { .. }) => {
                self.disarm(board);
                self.state = State::Stream(Drive::Off);
            }
            State::Balance(Drive::On | Drive::Soft { .. }) => {
                self.disarm(board);
                self.state = State::Balance(Drive::Off);
            }
            State::Bridge | State::Stream(Drive::Off) => {
                if pressed & button::START != 0 {
                    self.enter(board, Mode::Balance);
                }
            }
            State::Balance(Drive::Off) | State::Fault(_) => {}
        }
    }

    fn account<B: Board>(&mut self, board: &mut B, started: u16) {
        self.tick_us = since_us(board, started);
        self.longest_tick_us = self.longest_tick_us.max(self.tick_us);
        if self.tick_us > TICK_US {
            self.overruns = self.overruns.saturating_add(1);
        }
        let lost = u16::from(board.link_overruns());
        self.statistics.overruns = self.statistics.overruns.saturating_add(lost);
    }

    /// Changes the mode; torque is off on the way.
    #[inline(never)]
    fn enter<B: Board>(&mut self, board: &mut B, mode: Mode) {
        self.disarm(board);
        self.state = match mode {
            Mode::Bridge => State::Bridge,
            Mode::Stream => State::Stream(Drive::Off),
            Mode::Balance => State::Balance(Drive::Off),
        };
    }

    /// The plan in EEPROM, if it can be used, else the one compiled in, if there is one.
    #[inline(never)]
    fn load_plan<B: Board>(&mut self, board: &mut B) {
        let stored = self.writer.newest();
        let is_loaded = stored.is_some_and(|stored| self.balance.load(stored.bytes(board)));
        if !is_loaded {
            self.balance
                .load((0..).map_while(|at| board.compiled_plan(at)));
        }
    }
}
