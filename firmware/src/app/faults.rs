//! What goes into the fault log, and who reads it.

use super::App;
use crate::board::Board;
use handstand_shared::message::{Cause, FaultEntry, Refusal, Report};

impl App {
    /// Keeps a fault in EEPROM, with the state it came in.
    #[inline(never)]
    pub(super) fn log_fault(&mut self, cause: Cause) {
        // What the host asked for is no fault.
        if cause != Cause::LetDown {
            self.faults.keep(&FaultEntry {
                start: self.tokens.start(),
                tick: self.ticks,
                cause,
                condition: self.condition(),
            });
        }
    }

    /// Sends an entry of the fault log. Reading EEPROM may wait for a byte that is being written,
    /// which no tick of an armed robot has the time for.
    #[inline(never)]
    pub(super) fn read_fault<B: Board>(&mut self, board: &mut B, back: u8) -> Result<(), Refusal> {
        if self.is_armed() {
            return Err(Refusal::Armed);
        }
        let entry = self.faults.read(board, back);
        self.link.send(board, &Report::Fault { back, entry });
        Ok(())
    }
}
