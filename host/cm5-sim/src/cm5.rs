//! A simulated CM-5 with servos and a PC: one interface for the logic in process and for the ELF in
//! simavr.

use super::bus::Bus;
use super::host_board::HostBoard;
use super::pc::Pc;
use handstand_firmware::app::App;
use handstand_shared::message::{Command, Report, ResetCause};

/// A CM-5 between a PC and servos, however its program is executed.
pub trait SimulatedCm5 {
    /// Run for this long, ms.
    fn run_ms(&mut self, ms: f64);
    /// Time since power-on, ms.
    fn now_ms(&self) -> f64;
    /// Queue raw bytes from the PC, at the line's own pace.
    fn send_bytes(&mut self, bytes: &[u8]);
    /// The PC.
    fn pc(&self) -> &Pc;
    /// The PC, to clear what arrived.
    fn pc_mut(&mut self) -> &mut Pc;
    /// The servos.
    fn bus(&mut self) -> &mut Bus;
    /// Set the gyro's voltage so that the ADC reads this code.
    fn set_gyro(&mut self, code: u16);

    /// Queue a command from the PC; returns its sequence number.
    fn send(&mut self, command: &Command) -> u8 {
        let (frame, sequence) = self.pc_mut().frame(command);
        self.send_bytes(&frame);
        sequence
    }

    /// Reports that arrived at the PC, and when, ms.
    fn reports(&self) -> Vec<(f64, Report)> {
        self.pc().reports.clone()
    }

    /// Raw bytes that arrived at the PC.
    fn raw(&self) -> &[u8] {
        &self.pc().raw
    }

    /// Clear reports and raw bytes.
    fn clear(&mut self) {
        let pc = self.pc_mut();
        pc.reports.clear();
        pc.raw.clear();
    }
}

/// The firmware's logic in process, on a host board.
#[derive(Debug)]
pub struct VirtualCm5 {
    /// The board.
    pub board: HostBoard,
    /// The logic.
    pub app: App,
    pc: Pc,
}

impl VirtualCm5 {
    /// Power on with an erased EEPROM and servos 1 to 18.
    pub fn new() -> Self {
        Self::start(HostBoard::new(Bus::new(1..=18)))
    }

    /// Start with this EEPROM, for this reason.
    pub fn boot(eeprom: Vec<u8>, cause: ResetCause) -> Self {
        Self::with_plan(Vec::new(), eeprom, cause)
    }

    /// The same with a plan compiled in.
    pub fn with_plan(compiled: Vec<u8>, eeprom: Vec<u8>, cause: ResetCause) -> Self {
        let mut board = HostBoard::new(Bus::new(1..=18));
        board.compiled = compiled;
        board.eeprom = eeprom;
        board.reset_cause = cause;
        Self::start(board)
    }

    /// Start the firmware's logic on this board.
    pub fn start(mut board: HostBoard) -> Self {
        let app = App::boot(&mut board);
        VirtualCm5 {
            board,
            app,
            pc: Pc::default(),
        }
    }
}

impl Default for VirtualCm5 {
    fn default() -> Self {
        Self::new()
    }
}

impl SimulatedCm5 for VirtualCm5 {
    fn run_ms(&mut self, ms: f64) {
        let until_ns = self.board.now_ns() + (ms * 1e6) as u64;
        self.board.run(&mut self.app, until_ns, false);
        while let Some((end_ns, byte)) = self.board.take() {
            self.pc.receive(end_ns as f64 * 1e-6, byte);
        }
    }

    fn now_ms(&self) -> f64 {
        self.board.now_ns() as f64 * 1e-6
    }

    fn send_bytes(&mut self, bytes: &[u8]) {
        self.board.send_bytes(bytes);
    }

    fn pc(&self) -> &Pc {
        &self.pc
    }

    fn pc_mut(&mut self) -> &mut Pc {
        &mut self.pc
    }

    fn bus(&mut self) -> &mut Bus {
        &mut self.board.bus
    }

    fn set_gyro(&mut self, code: u16) {
        self.board.gyro = code;
    }
}
