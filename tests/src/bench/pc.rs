//! The firmware's logic in process, on a board made of queues and a simulated clock.

use super::Bench;
use handstand::bus_sim::{BYTE_NS, Bus};
use handstand_firmware::app::App;
use handstand_firmware::board::Board;
use handstand_firmware::panel::button;
use handstand_shared::frame::{Decoder, MAX_FRAME};
use handstand_shared::message::{Command, Report, ResetCause, decode, encode};
use std::collections::VecDeque;

/// A byte of 8N1 at 57600 baud, ns.
const LINK_NS: u64 = 10_000_000_000 / 57_600;
const TICK_NS: u64 = 10_000_000;
/// What a turn of the main loop costs the AVR, about, ns.
const TURN_NS: u64 = 10_000;

/// A board without hardware. Time passes when the firmware waits.
pub struct PcBoard {
    now_ns: u64,
    next_tick_ns: u64,
    /// The servos.
    pub bus: Bus,
    to_link: VecDeque<(u64, u8)>,
    from_link: VecDeque<(u64, u8)>,
    link_free_ns: u64,
    /// Buttons held down.
    pub buttons: u8,
    /// LEDs lit.
    pub leds: u8,
    /// The gyro's code.
    pub gyro: u16,
    /// The plan that was compiled in.
    pub compiled: Vec<u8>,
    /// Contents of the EEPROM.
    pub eeprom: Vec<u8>,
    eeprom_busy_ns: u64,
    /// How many more bytes of EEPROM are written before the power fails, and what the torn byte becomes.
    pub cut: Option<(u32, u8)>,
    /// The power has failed.
    pub dead: bool,
    reset_cause: ResetCause,
}

impl PcBoard {
    fn new(eeprom: Vec<u8>, compiled: Vec<u8>, reset_cause: ResetCause) -> Self {
        PcBoard {
            now_ns: 0,
            next_tick_ns: TICK_NS,
            bus: Bus::new(1..=18),
            to_link: VecDeque::new(),
            from_link: VecDeque::new(),
            link_free_ns: 0,
            buttons: 0,
            leds: 0,
            gyro: 512,
            compiled,
            eeprom,
            eeprom_busy_ns: 0,
            cut: None,
            dead: false,
            reset_cause,
        }
    }
}

impl Board for PcBoard {
    fn clock(&self) -> u16 {
        (self.now_ns / 500) as u16
    }

    fn tick_due(&mut self) -> bool {
        let due = self.now_ns >= self.next_tick_ns;
        while self.now_ns >= self.next_tick_ns {
            self.next_tick_ns += TICK_NS;
        }
        due
    }

    fn feed_watchdog(&mut self) {}

    fn bus_send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.now_ns += BYTE_NS;
            self.bus.hear(self.now_ns, *byte);
        }
    }

    fn bus_receive(&mut self, within_us: u16) -> Option<u8> {
        let until_ns = self.now_ns + u64::from(within_us) * 1000;
        match self.bus.take(until_ns) {
            Some((end_ns, byte)) => {
                self.now_ns = self.now_ns.max(end_ns);
                Some(byte)
            }
            None => {
                self.now_ns = until_ns;
                None
            }
        }
    }

    fn bus_flush(&mut self) {
        while self.bus.take(self.now_ns).is_some() {}
    }

    fn link_receive(&mut self) -> Option<u8> {
        let (end_ns, byte) = self.to_link.front().copied()?;
        (end_ns <= self.now_ns).then(|| self.to_link.pop_front())?;
        Some(byte)
    }

    fn link_overruns(&mut self) -> u8 {
        0
    }

    fn link_room(&self) -> usize {
        let queued = self.link_free_ns.saturating_sub(self.now_ns) / LINK_NS;
        255usize.saturating_sub(queued as usize)
    }

    fn link_send(&mut self, byte: u8) {
        self.link_free_ns = self.link_free_ns.max(self.now_ns) + LINK_NS;
        self.from_link.push_back((self.link_free_ns, byte));
    }

    fn buttons(&self) -> u8 {
        self.buttons & (button::START | 0xf)
    }

    fn set_leds(&mut self, leds: u8) {
        self.leds = leds;
    }

    fn gyro(&mut self) -> u16 {
        self.gyro
    }

    fn compiled_plan(&self, at: u16) -> Option<u8> {
        self.compiled.get(usize::from(at)).copied()
    }

    fn eeprom_read(&mut self, address: u16) -> u8 {
        self.now_ns = self.now_ns.max(self.eeprom_busy_ns);
        self.eeprom[usize::from(address)]
    }

    fn eeprom_write(&mut self, address: u16, byte: u8) -> bool {
        if !self.eeprom_ready() {
            return false;
        }
        self.eeprom_busy_ns = self.now_ns + 8_500_000;
        let mut written = byte;
        if let Some((left, torn)) = &mut self.cut {
            if *left == 0 {
                written = *torn;
                self.dead = true;
            } else {
                *left -= 1;
            }
        }
        self.eeprom[usize::from(address)] = written;
        true
    }

    fn eeprom_ready(&self) -> bool {
        self.now_ns >= self.eeprom_busy_ns
    }

    fn reset_cause(&self) -> ResetCause {
        self.reset_cause
    }

    fn stack(&self) -> (u16, u16) {
        (0, 0)
    }
}

/// Logic, board and PC.
pub struct PcRig {
    /// The board.
    pub board: PcBoard,
    /// The logic.
    pub app: App,
    decoder: Decoder,
    sequence: u8,
    reports: Vec<(f64, Report)>,
    raw: Vec<u8>,
    bad_frames: usize,
    link_bytes: u64,
}

impl PcRig {
    /// Power comes on, with an erased EEPROM.
    pub fn new() -> Self {
        Self::boot(vec![0xff; 4096], ResetCause(ResetCause::POWER))
    }

    /// Starts with this EEPROM, for this reason.
    pub fn boot(eeprom: Vec<u8>, cause: ResetCause) -> Self {
        Self::with_plan(Vec::new(), eeprom, cause)
    }

    /// The same with a plan compiled in.
    pub fn with_plan(compiled: Vec<u8>, eeprom: Vec<u8>, cause: ResetCause) -> Self {
        let mut board = PcBoard::new(eeprom, compiled, cause);
        let app = App::boot(&mut board);
        PcRig {
            board,
            app,
            decoder: Decoder::default(),
            sequence: 0,
            reports: Vec::new(),
            raw: Vec::new(),
            bad_frames: 0,
            link_bytes: 0,
        }
    }

    fn hear(&mut self) {
        while let Some((end_ns, byte)) = self.board.from_link.front().copied()
            && end_ns <= self.board.now_ns
        {
            self.board.from_link.pop_front();
            self.link_bytes += 1;
            self.raw.push(byte);
            match self
                .decoder
                .push(byte)
                .map(|body| body.map(decode::<Report>))
            {
                Some(Ok(Ok(report))) => self.reports.push((end_ns as f64 * 1e-6, report.message)),
                Some(_) => self.bad_frames += 1,
                None => {}
            }
        }
    }
}

impl Default for PcRig {
    fn default() -> Self {
        Self::new()
    }
}

impl Bench for PcRig {
    fn run_ms(&mut self, ms: f64) {
        let until_ns = self.board.now_ns + (ms * 1e6) as u64;
        while self.board.now_ns < until_ns && !self.board.dead {
            self.app.run(&mut self.board);
            self.board.now_ns += TURN_NS;
            self.board.bus.advance(self.board.now_ns);
            self.hear();
        }
    }

    fn now_ms(&self) -> f64 {
        self.board.now_ns as f64 * 1e-6
    }

    fn say(&mut self, command: &Command) -> u8 {
        let mut frame = [0; MAX_FRAME];
        let length = encode(self.sequence, command, &mut frame).expect("every command fits");
        self.sequence = self.sequence.wrapping_add(1);
        if matches!(command, Command::Hello { .. } | Command::Mode(_)) {
            self.type_bytes(&[0]);
        }
        self.type_bytes(&frame[..length]);
        self.sequence.wrapping_sub(1)
    }

    fn type_bytes(&mut self, bytes: &[u8]) {
        let last_ns = self.to_link_end();
        let ends = (1..).map(|count| last_ns + count * LINK_NS);
        self.board.to_link.extend(ends.zip(bytes.iter().copied()));
    }

    fn reports(&self) -> Vec<(f64, Report)> {
        self.reports.clone()
    }

    fn raw(&self) -> &[u8] {
        &self.raw
    }

    fn bad_frames(&self) -> usize {
        self.bad_frames
    }

    fn link_bytes(&self) -> u64 {
        self.link_bytes
    }

    fn forget(&mut self) {
        self.reports.clear();
        self.raw.clear();
    }

    fn bus(&mut self) -> &mut Bus {
        &mut self.board.bus
    }

    fn turn_gyro(&mut self, code: u16) {
        self.board.gyro = code;
    }
}

impl PcRig {
    fn to_link_end(&self) -> u64 {
        let last = self.board.to_link.back().map_or(0, |(end, _)| *end);
        last.max(self.board.now_ns)
    }
}
