//! The fault log in EEPROM: cause, tick and state of the last faults.
//!
//! 16 cells of 16 bytes in turn, so that the newest is followed by the oldest. A cell is sequence
//! number, entry and CRC-32 of both, written a byte per tick; one that a power cut tore has a wrong
//! check, is passed over and written again.

use crate::board::Board;
use crate::plan_store;
use handstand_shared::crc::crc32;
use handstand_shared::message::FaultEntry;

/// Entries that are kept.
pub const ENTRIES: u8 = 16;

const CELL: u16 = 16;
/// Below the boot counter's cells.
const START: u16 = 0x700;
const _: () = assert!(
    plan_store::END_OF_FIRST <= START && START + ENTRIES as u16 * CELL <= 0x800,
    "between the first slot of the plan and the boot counter"
);

const BODY: usize = FaultEntry::LENGTH;
/// Bytes of a cell that are written: sequence number, entry, check.
const USED: usize = 1 + BODY + 4;

/// The log, and what of its newest entry is not yet written.
#[derive(Debug)]
pub struct FaultLog {
    /// Cell of the newest sound entry, and its sequence number; none in an empty log.
    newest: Option<(u8, u8)>,
    cell: [u8; USED],
    /// Bytes of `cell` that are written.
    written: u8,
}

impl FaultLog {
    /// The log as EEPROM holds it.
    #[inline(never)]
    pub fn new<B: Board>(board: &mut B) -> Self {
        let mut newest: Option<(u8, u8)> = None;
        for place in 0..ENTRIES {
            let Some(cell) = sound(board, place) else {
                continue;
            };
            let [sequence, ..] = cell;
            // Sequence numbers wrap: the newer one is less than half the circle ahead.
            let is_newer = |known: u8| (1..0x80).contains(&sequence.wrapping_sub(known));
            if newest.is_none_or(|(_, known)| is_newer(known)) {
                newest = Some((place, sequence));
            }
        }
        FaultLog {
            newest,
            cell: [0; USED],
            written: USED as u8,
        }
    }

    /// Keeps an entry: it is written in the next 13 ticks, or more where a plan is written too. One
    /// that is not yet written then is lost.
    #[inline(never)]
    pub fn keep(&mut self, entry: &FaultEntry) {
        let (place, sequence) = self.next();
        let mut cell = [0; USED];
        let (content, check) = cell.split_at_mut(1 + BODY);
        let bytes = [sequence].into_iter().chain(entry.bytes());
        content
            .iter_mut()
            .zip(bytes)
            .for_each(|(slot, byte)| *slot = byte);
        let crc = crc32(content).to_le_bytes();
        check
            .iter_mut()
            .zip(crc)
            .for_each(|(slot, byte)| *slot = byte);
        self.cell = cell;
        self.written = 0;
        self.newest = Some((place, sequence));
    }

    /// Writes the next byte.
    #[inline(never)]
    pub fn tick<B: Board>(&mut self, board: &mut B) {
        let (Some((place, _)), Some(byte)) =
            (self.newest, self.cell.get(usize::from(self.written)))
        else {
            return;
        };
        if board.eeprom_write(address(place) + u16::from(self.written), *byte) {
            self.written += 1;
        }
    }

    /// The entry so many before the newest; none where there are not so many, or it is torn.
    #[inline(never)]
    pub fn read<B: Board>(&self, board: &mut B, back: u8) -> Option<FaultEntry> {
        let (place, sequence) = self.newest?;
        if back >= ENTRIES {
            return None;
        }
        let is_pending = usize::from(self.written) < USED;
        let cell = match back {
            0 if is_pending => self.cell,
            _ => sound(board, place.wrapping_sub(back) % ENTRIES)?,
        };
        // Older ones than those the circle holds have been written over.
        let (found, body) = cell.split_first()?;
        let entry = FaultEntry::from_bytes(body.first_chunk()?)?;
        (*found == sequence.wrapping_sub(back)).then_some(entry)
    }

    /// Cell and sequence number of the next entry.
    fn next(&self) -> (u8, u8) {
        match self.newest {
            None => (0, 0),
            Some((place, sequence)) => ((place + 1) % ENTRIES, sequence.wrapping_add(1)),
        }
    }
}

fn address(place: u8) -> u16 {
    START + u16::from(place) * CELL
}

/// What a cell holds, if its check is right.
fn sound<B: Board>(board: &mut B, place: u8) -> Option<[u8; USED]> {
    let mut cell = [0; USED];
    for (at, byte) in (address(place)..).zip(cell.iter_mut()) {
        *byte = board.eeprom_read(at);
    }
    let (content, check) = cell.split_at(1 + BODY);
    (crc32(content).to_le_bytes() == *check).then_some(cell)
}
