//! What the firmware does: its states, one tick, and the commands.

use crate::age::Age;
use crate::balance::Balance;
use crate::board::Board;
use crate::design::{INSIST_US, START_TICKS};
use crate::fault_log::FaultLog;
use crate::filter::{Filter, Way};
use crate::link::Link;
use crate::panel::Buttons;
use crate::plan_store::{Stored, Writer};
use crate::servos::Servos;
use crate::{boot_counter, bus};
use handstand_shared::message::{Attitude, Cause, Condition, ServoList, Statistics};

mod arming;
mod buttons;
mod command;
mod faults;
mod modes;
mod soft_stop;
mod state;
mod tick_times;
mod tokens;

use arming::Arming;
use state::{Armed, Fading, Goal, Onset};
pub use state::{State, Torque};
use tick_times::TickTimes;
use tokens::{Token, Tokens};

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
    faults: FaultLog,
    balance: Balance,
    attitude: Attitude,
    /// Since it arrived.
    attitude_age: Age,
    tokens: Tokens,
    ticks: u32,
    times: TickTimes,
    /// Since the host's last goals, attitude or keep-alive: nothing else is a sign of life.
    life: Age,
    /// The longest of it since arming, us.
    longest_silence_us: u32,
    /// Since nothing from the PC was left to be taken: what is taken now arrived later.
    emptied: Age,
    /// Since a frame's last byte was taken, or longer, as `emptied`; the zero that ends it may be
    /// lost, and come with the next one.
    heard: Age,
    /// Whether nothing was left to be taken since the last tick.
    is_emptied: bool,
    /// Since torque was switched off; old where somebody else may have switched it on.
    off: Age,
    /// Arming that has begun: the limits are written and read back before torque comes on.
    arming: Option<Arming>,
    /// The gyro's code as it is reported: when the tick began, or what the law took.
    gyro: u16,
    /// Whether it has looked for a plan.
    has_looked: bool,
    /// Whether the plan it has is the one in EEPROM, and not the one compiled in.
    is_stored: bool,
}

impl App {
    /// Torque off first of all, then everything else. A watchdog's reset is a fault.
    // Apart from `main`, whose frame is there for ever: what is needed to start is not.
    #[inline(never)]
    pub fn boot<B: Board>(board: &mut B) -> Self {
        bus::torque_off_at_start(board);
        let state = if board.reset_cause().is_watchdog() {
            State::Fault(Cause::Watchdog)
        } else {
            State::Bridge
        };
        App {
            state,
            link: Link::default(),
            filter: Filter::default(),
            servos: Servos::new(&ServoList::default()),
            statistics: Statistics::default(),
            buttons: Buttons::default(),
            writer: Writer::new(board),
            // Before the boot counter: reading waits for what is being written.
            faults: FaultLog::new(board),
            balance: Balance::NONE,
            attitude: Attitude::default(),
            attitude_age: Age::NEVER,
            tokens: Tokens::of_start(boot_counter::count(board) as u8),
            ticks: 0,
            times: TickTimes::default(),
            life: Age::NEVER,
            longest_silence_us: 0,
            emptied: Age::from(board.clock()),
            heard: Age::NEVER,
            is_emptied: false,
            off: Age::from(board.clock()),
            arming: None,
            gyro: 0,
            has_looked: false,
            is_stored: false,
        }
    }

    /// What it is doing.
    pub fn state(&self) -> State {
        self.state
    }

    /// As the host is told.
    pub fn condition(&self) -> Condition {
        self.state.condition()
    }

    /// CRC-32 of the plan it balances with; none if it has none.
    pub fn plan_fingerprint(&self) -> Option<u32> {
        self.balance.fingerprint()
    }

    /// Whether a plan is being written to EEPROM.
    pub fn is_writing(&self) -> bool {
        self.writer.is_busy()
    }

    /// One turn of the main loop: passes bytes on, and runs a tick when it is due.
    pub fn run<B: Board>(&mut self, board: &mut B) {
        if !self.has_looked {
            // Not while booting: what boots is moved, and RAM has no room for two plans.
            self.has_looked = true;
            if let State::Fault(cause) = self.state {
                self.log_fault(cause);
            }
            self.load_plan(board);
        }
        self.pump(board);
        self.pass(board.clock());
        if board.tick_due() {
            // Here and nowhere else: only ticks that come and end prove that the firmware is alive.
            // Fed at their ends alone, a long one after a short one would come too late.
            board.feed_watchdog();
            self.tick(board);
            board.feed_watchdog();
        }
    }

    /// Handles what has come from the PC and, as an adapter, from the servos.
    fn pump<B: Board>(&mut self, board: &mut B) {
        // Bounded, so that a babbling line cannot starve the tick.
        for _ in 0..64 {
            // While torque is on a command does not begin just before a tick: it would be late.
            // Behind a tick as long as its period it does, or no word of the host's would count.
            if self.is_emptied && self.is_armed() && self.times.is_near(board.clock()) {
                break;
            }
            let Some(byte) = board.link_receive() else {
                self.emptied = Age::from(board.clock());
                self.is_emptied = true;
                break;
            };
            // What reads EEPROM takes long: one of them, then the tick.
            if self.take(board, byte) {
                break;
            }
        }
        if matches!(self.state, State::Bridge) {
            for _ in 0..64 {
                match board.bus_receive(0) {
                    Some(_) if board.link_room() == 0 => {
                        self.statistics.cut = self.statistics.cut.saturating_add(1);
                    }
                    Some(byte) => board.link_send(&[byte]),
                    None => break,
                }
            }
        }
    }

    /// Takes a byte from the PC; whether it completed a command that takes long.
    #[inline(never)]
    fn take<B: Board>(&mut self, board: &mut B, byte: u8) -> bool {
        if matches!(self.state, State::Bridge) && self.filter.push(byte) == Way::Bus {
            // What was being said when the controller restarted switches no torque on.
            if self.ticks >= START_TICKS {
                self.off = Age::NEVER;
                board.bus_send(&[byte]);
            }
            return false;
        }
        if byte != 0 {
            self.heard = self.emptied;
        } else if !self.link.is_idle() {
            self.filter.end_frame();
        }
        let Some(command) = self.link.push(byte, &mut self.statistics) else {
            return false;
        };
        let is_long = !command.message.is_life();
        self.obey(board, command);
        // Ages wrap if nothing brings them up to date for long.
        self.pass(board.clock());
        is_long
    }

    /// Everything that happens once per period, all ages being up to date.
    // One function of everything would be too long for the AVR's relative jumps: its parts stay
    // apart.
    #[inline(never)]
    fn tick<B: Board>(&mut self, board: &mut B) {
        let started = board.clock();
        let due = self.times.begin(started);
        self.ticks = self.ticks.wrapping_add(1);
        self.panel(board);
        if self.off.us() < INSIST_US && !self.is_armed() {
            bus::torque_off(board);
        }
        if self.filter.tick() {
            self.link.reset();
        }
        if let Some((sequence, is_new)) = self.writer.tick(board) {
            if is_new {
                self.load_plan(board);
            }
            self.answer(board, sequence, Ok(()));
        }
        self.faults.tick(board);
        self.write_limits(board);
        match self.state {
            State::Bridge => {}
            State::Stream(Torque::Off) => self.watch(board, started),
            State::Balance(Torque::Off) => {
                let gyro = board.gyro();
                self.balance.rest(gyro);
                self.watch(board, started);
            }
            State::Fault(_) => self.insist(board, started),
            State::Stream(Torque::On(_)) => self.stream(board, started),
            State::Balance(Torque::On(_)) => self.balance(board, started),
            // Readings first: a new torque limit would clear what a servo that gave up says.
            State::Stream(Torque::Fading(_)) | State::Balance(Torque::Fading(_)) => {
                self.watch(board, started);
                self.fade(board);
            }
        }
        self.account(board, due);
        self.is_emptied = false;
        // Between ticks, as commands: what it takes shows where it makes the next tick late.
        self.finish_arming(board);
    }

    /// Time passes.
    fn pass(&mut self, clock: u16) {
        for age in [
            &mut self.life,
            &mut self.attitude_age,
            &mut self.off,
            &mut self.emptied,
            &mut self.heard,
        ] {
            age.pass(clock);
        }
        self.state.pass(clock);
        if self.is_armed() {
            self.longest_silence_us = self.longest_silence_us.max(self.life.us());
        }
    }

    /// The plan in EEPROM, if it can be used, else the one compiled in, if there is one.
    #[inline(never)]
    fn load_plan<B: Board>(&mut self, board: &mut B) {
        let stored = self.writer.newest();
        self.is_stored = stored.is_some() && self.take_plan(board, stored);
        if !self.is_stored {
            self.take_plan(board, None);
        }
        self.order_servos();
    }

    /// The stored plan, or the one compiled in; whether it can be used.
    // One function for both, for taking a plan from its bytes is 12 KiB of code.
    #[inline(never)]
    fn take_plan<B: Board>(&mut self, board: &mut B, stored: Option<Stored>) -> bool {
        let mut places = 0..;
        self.balance.load(core::iter::from_fn(|| {
            let at = places.next()?;
            match &stored {
                Some(stored) => stored.byte(board, at),
                None => board.compiled_plan(at),
            }
        }))
    }

    /// Those that balance are read last: what is read then is the newest.
    fn order_servos(&mut self) {
        if let Some(ids) = self.balance.measuring() {
            self.servos.read_last(ids);
        }
    }
}
