//! What the firmware does: its states, one tick, and the commands.

use crate::age::Age;
use crate::balance::Balance;
use crate::board::Board;
use crate::design::{CLOCK_PER_US, INSIST_US, START_TICKS, TICK_US};
use crate::fault_log::FaultLog;
use crate::filter::{Filter, Way};
use crate::link::Link;
use crate::panel::Buttons;
use crate::plan_store::Writer;
use crate::servos::Servos;
use crate::{boot_counter, bus};
use handstand_shared::message::{ArmLimits, Attitude, Cause, Condition, ServoList, Statistics};
use handstand_shared::packed::{Positions, Speeds};

mod arming;
mod buttons;
mod command;
mod faults;
mod modes;
mod soft_stop;
mod state;

use arming::Arming;
pub use state::{State, Torque};

/// What the host wants of the servos.
#[derive(Debug, Clone, Copy)]
enum Goal {
    /// Nothing since arming: stay.
    Hold,
    Positions(Positions),
    Speeds(Speeds),
}

/// Torque comes on in steps, a tick each: in one tick all of it would make its report late, and
/// with it the host's attitude for the next one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Onset {
    /// It comes on in those that balance, with the law's first command.
    Balance,
    /// The others get goals where they stand, half of the servo list from this place on.
    Goals(u8),
    /// The others have torque, too, half of the list from this place on.
    Others(u8),
    /// While streaming all have their goals, and get torque in the next tick.
    Torque,
    /// All have it.
    Done,
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
    faults: FaultLog,
    goal: Goal,
    balance: Balance,
    attitude: Attitude,
    /// Since it arrived.
    attitude_age: Age,
    /// Sequence number of the frame `goal` came in.
    obeyed: u8,
    /// What arming must bring; none before a greeting and after every fault.
    token: Option<u16>,
    /// Whether it has armed: it does so once.
    is_used: bool,
    /// Number of this start, and of the greetings in it from a number of chance on: what tokens are
    /// made of.
    boot_count: u8,
    greetings: Option<u8>,
    ticks: u32,
    /// Since the host's last goals, attitude or keep-alive: nothing else is a sign of life.
    life: Age,
    /// The longest of it since arming, ms.
    longest_silence_ms: u16,
    /// Since nothing from the PC was left to be taken: what is taken now arrived later.
    emptied: Age,
    /// Since torque was switched off; old where somebody else may have switched it on.
    off: Age,
    /// Since the torque limit began to fall.
    fading: Age,
    /// Arming that has begun: the limits are written and read back before torque comes on.
    arming: Option<Arming>,
    /// What arming brought.
    limits: ArmLimits,
    /// How far torque has come on while balancing.
    onset: Onset,
    /// Ticks since one was too long.
    calm: u8,
    /// Since a round of the housekeeping told of a low supply, if every one has since then.
    low: Option<Age>,
    overruns: u16,
    tick_us: u16,
    longest_tick_us: u16,
    longest_law_us: u16,
    /// The gyro's code as it is reported: when the tick began, or what the law took.
    gyro: u16,
    /// When the next tick is due, in counts of the clock; none before the first.
    due: Option<u16>,
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
            goal: Goal::Hold,
            balance: Balance::NONE,
            attitude: Attitude::default(),
            attitude_age: Age::NEVER,
            obeyed: 0,
            token: None,
            is_used: false,
            boot_count: boot_counter::count(board) as u8,
            greetings: None,
            ticks: 0,
            life: Age::NEVER,
            longest_silence_ms: 0,
            emptied: Age::from(board.clock()),
            off: Age::from(board.clock()),
            fading: Age::NEVER,
            arming: None,
            limits: ArmLimits::NONE,
            onset: Onset::Done,
            calm: 0,
            low: None,
            overruns: 0,
            tick_us: 0,
            longest_tick_us: 0,
            longest_law_us: 0,
            gyro: 0,
            due: None,
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
        self.pass(board.clock());
        self.pump(board);
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
            let Some(byte) = board.link_receive() else {
                self.emptied = Age::from(board.clock());
                break;
            };
            // What reads EEPROM or looks at the stack takes long: one of them, then the tick.
            if self.take(board, byte) {
                break;
            }
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

    /// Takes a byte from the PC; whether it completed a command that takes long.
    #[inline(never)]
    fn take<B: Board>(&mut self, board: &mut B, byte: u8) -> bool {
        if self.state == State::Bridge && self.filter.push(byte) == Way::Bus {
            // What was being said when the controller restarted switches no torque on.
            if self.ticks >= START_TICKS {
                self.off = Age::NEVER;
                board.bus_send(&[byte]);
            }
            return false;
        }
        if byte == 0 && !self.link.is_idle() {
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

    /// Everything that happens once per period.
    // One function of everything would be too long for the AVR's relative jumps: its parts stay
    // apart.
    #[inline(never)]
    pub fn tick<B: Board>(&mut self, board: &mut B) {
        let started = board.clock();
        let due = self.due_before(started);
        self.ticks = self.ticks.wrapping_add(1);
        self.pass(started);
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
            State::Stream(Torque::On) => self.stream(board, started),
            State::Balance(Torque::On) => self.balance(board, started),
            // Readings first: a new torque limit would clear what a servo that gave up says.
            State::Stream(Torque::Fading { cause }) => {
                self.watch(board, started);
                self.fade(board, cause, State::Stream);
            }
            State::Balance(Torque::Fading { cause }) => {
                self.watch(board, started);
                self.fade(board, cause, State::Balance);
            }
        }
        self.account(board, due);
        // Between ticks, as commands: what it takes shows where it makes the next tick late.
        self.finish_arming(board);
    }

    /// When this tick was due: ticks that begin late are late for the servos, however short they
    /// are. The earliest phase counts; one that was skipped is an overrun.
    fn due_before(&mut self, started: u16) -> u16 {
        const PERIOD: u16 = TICK_US * CLOCK_PER_US;
        let mut due = self.due.unwrap_or(started);
        // More than half of the clock's range late is early.
        while started.wrapping_sub(due) < 0x8000 && started.wrapping_sub(due) >= PERIOD {
            due = due.wrapping_add(PERIOD);
            self.overruns = self.overruns.saturating_add(1);
            self.calm = 0;
        }
        if started.wrapping_sub(due) >= 0x8000 {
            due = started;
        }
        self.due = Some(due.wrapping_add(PERIOD));
        due
    }

    /// Time passes.
    fn pass(&mut self, clock: u16) {
        for age in [
            &mut self.life,
            &mut self.attitude_age,
            &mut self.off,
            &mut self.fading,
            &mut self.emptied,
        ] {
            age.pass(clock);
        }
        if let Some(low) = &mut self.low {
            low.pass(clock);
        }
        if self.is_armed() {
            let silence_ms = u16::try_from(self.life.us() / 1000).unwrap_or(u16::MAX);
            self.longest_silence_ms = self.longest_silence_ms.max(silence_ms);
        }
    }

    /// The plan in EEPROM, if it can be used, else the one compiled in, if there is one.
    #[inline(never)]
    fn load_plan<B: Board>(&mut self, board: &mut B) {
        let stored = self.writer.newest();
        let is_loaded = stored.is_some_and(|stored| self.balance.load(stored.bytes(board)));
        self.is_stored = is_loaded;
        if !is_loaded {
            self.balance
                .load((0..).map_while(|at| board.compiled_plan(at)));
        }
        self.order_servos();
    }

    /// Those that balance are read last: what is read then is the newest.
    fn order_servos(&mut self) {
        if let Some(ids) = self.balance.measuring() {
            self.servos.read_last(ids);
        }
    }
}
