//! The firmware's logic in process, on a board without hardware.

use super::Bench;
use handstand::bus_sim::Bus;
use handstand_firmware::app::App;
use handstand_firmware::desk::Desk;
use handstand_shared::frame::{Decoder, MAX_FRAME};
use handstand_shared::message::{Command, Report, ResetCause, decode, encode};

/// Logic, board and PC.
pub struct PcRig {
    /// The board.
    pub board: Desk<Bus>,
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
    /// Power comes on, with an erased EEPROM and 18 servos.
    pub fn new() -> Self {
        Self::start(Desk::new(Bus::new(1..=18)))
    }

    /// Starts with this EEPROM, for this reason.
    pub fn boot(eeprom: Vec<u8>, cause: ResetCause) -> Self {
        Self::with_plan(Vec::new(), eeprom, cause)
    }

    /// The same with a plan compiled in.
    pub fn with_plan(compiled: Vec<u8>, eeprom: Vec<u8>, cause: ResetCause) -> Self {
        let mut board = Desk::new(Bus::new(1..=18));
        board.compiled = compiled;
        board.eeprom = eeprom;
        board.reset_cause = cause;
        Self::start(board)
    }

    fn start(mut board: Desk<Bus>) -> Self {
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
        while let Some((end_ns, byte)) = self.board.arrived() {
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
        let until_ns = self.board.now_ns() + (ms * 1e6) as u64;
        self.board.run(&mut self.app, until_ns, false);
        self.hear();
    }

    fn now_ms(&self) -> f64 {
        self.board.now_ns() as f64 * 1e-6
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
        self.board.type_bytes(bytes);
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
