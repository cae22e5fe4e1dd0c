//! How often the controller has started, kept in EEPROM so that no start greets like one before it.
//!
//! 64 cells of a byte, of which each start writes one, in turn: the next cell takes the first one's
//! value, and when all are the same the first one goes on by one. So a cell is written every 64th
//! time, and 100,000 writes last for six million starts. A cell torn by a power cut is not the same
//! as the first and is written again.

use crate::board::Board;
use crate::plan_store;

/// Between the slots of the plan.
const CELLS: core::ops::Range<u16> = 0x800..0x840;
const _: () = assert!(plan_store::END_OF_FIRST <= CELLS.start && CELLS.end <= plan_store::LAST);

/// Counts this start; its number, modulo 16384.
pub fn count<B: Board>(board: &mut B) -> u16 {
    let mut first = board.eeprom_read(CELLS.start);
    let differs = |at: &u16| board.eeprom_read(*at) != first;
    let at = CELLS.skip(1).find(differs).unwrap_or(CELLS.start);
    if at == CELLS.start {
        first = first.wrapping_add(1);
    }
    // Reading has waited for whatever was being written.
    board.eeprom_write(at, first);
    u16::from(first) << 6 | (at - CELLS.start)
}
