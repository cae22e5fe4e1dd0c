//! The gain table in EEPROM: two slots, of which the newer sound one counts.
//!
//! A new table goes into the other slot, byte by byte, and its header last; the header's CRC-32
//! covers everything, so that a power cut at any byte leaves the old table. One byte per tick is
//! written (a byte takes 8.5 ms). The boot loader's bytes, 0xFF6 to 0xFFF, are far away.

use crate::board::Board;
use handstand_shared::crc::extend32;
use handstand_shared::message::PLAN_CHUNK;
use handstand_shared::plan::Plan;

const _: () =
    assert!(Plan::MOST <= MAX_TABLE as usize && END_OF_FIRST <= STARTS[1] && END <= 0xff6);

/// Longest gain table, bytes.
pub const MAX_TABLE: u16 = 1200;
/// Not from 0 on: a supply that breaks down while a byte is written may spoil the one at address 0.
/// Between the slots lie the boot counter's cells.
const STARTS: [u16; 2] = [0x010, 0x840];
const HEADER: u16 = 8;
/// Behind the last byte of the first slot.
pub const END_OF_FIRST: u16 = STARTS[0] + HEADER + MAX_TABLE;
/// Behind the last byte of the last slot.
const END: u16 = STARTS[1] + HEADER + MAX_TABLE;
/// First byte of the last slot.
pub const LAST: u16 = STARTS[1];

/// A sound table in EEPROM.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stored {
    slot: u8,
    sequence: u16,
    /// Bytes of the table.
    pub length: u16,
}

impl Stored {
    /// The newer of the sound slots.
    pub fn newest(board: &mut impl Board) -> Option<Stored> {
        let [first, second] = [sound(board, 0), sound(board, 1)];
        match (first, second) {
            // Sequence numbers wrap: the newer one is less than half the circle ahead.
            (Some(a), Some(b)) if b.sequence.wrapping_sub(a.sequence) < 0x8000 => Some(b),
            (Some(a), _) => Some(a),
            (None, b) => b,
        }
    }

    /// The table's byte at this place; none behind its end. Torque must be off: reading all of them
    /// feeds the watchdog.
    pub fn byte<B: Board>(&self, board: &mut B, at: u16) -> Option<u8> {
        let address = start(self.slot) + HEADER + at;
        (at < self.length).then(|| read_fed(board, address))
    }

    /// The table's bytes from `offset` on, as many as `out` holds; beyond its end zeros.
    pub fn read(&self, board: &mut impl Board, offset: u16, out: &mut [u8]) {
        let body = start(self.slot) + HEADER;
        for (at, byte) in out.iter_mut().enumerate() {
            let at = offset.saturating_add(at as u16);
            *byte = if at < self.length {
                board.eeprom_read(body + at)
            } else {
                0
            };
        }
    }
}

fn start(slot: u8) -> u16 {
    if slot == 0 { STARTS[0] } else { STARTS[1] }
}

fn sound(board: &mut impl Board, slot: u8) -> Option<Stored> {
    let mut header = [0; HEADER as usize];
    for (at, byte) in (start(slot)..).zip(header.iter_mut()) {
        *byte = board.eeprom_read(at);
    }
    let [s0, s1, l0, l1, check @ ..] = header;
    let sequence = u16::from_le_bytes([s0, s1]);
    let length = u16::from_le_bytes([l0, l1]);
    let is_sound = (1..=MAX_TABLE).contains(&length)
        && slot_check(sequence, length, body_check(board, slot, length))
            == u32::from_le_bytes(check);
    is_sound.then_some(Stored {
        slot,
        sequence,
        length,
    })
}

/// The header's check: CRC-32 of table, length and sequence, from that of the table.
fn slot_check(sequence: u16, length: u16, body: u32) -> u32 {
    let crc = extend32(!body, &length.to_le_bytes());
    !extend32(crc, &sequence.to_le_bytes())
}

/// CRC-32 of the table.
fn body_check(board: &mut impl Board, slot: u8, length: u16) -> u32 {
    let body = start(slot) + HEADER;
    let bytes = body..body + length.min(MAX_TABLE);
    !bytes.fold(u32::MAX, |crc, at| extend32(crc, &[read_fed(board, at)]))
}

/// Bytes read between two feedings of the watchdog.
const PIECE: u16 = 64;

/// A byte of a whole table, which takes as long to read as the watchdog waits. There are at most
/// [`MAX_TABLE`], so whoever reads them comes to an end.
fn read_fed(board: &mut impl Board, at: u16) -> u8 {
    if at.is_multiple_of(PIECE) {
        board.feed_watchdog();
    }
    board.eeprom_read(at)
}

/// Bytes on their way into the slot that does not count.
#[derive(Debug, Clone)]
pub struct Writer {
    /// The table that counts. Known, for to look for it takes as long as a tick.
    newest: Option<Stored>,
    /// What counts once the header is written.
    next: Option<Stored>,
    bytes: [u8; PLAN_CHUNK],
    used: u8,
    done: u8,
    address: u16,
    /// Sequence number of the command to answer when all is written.
    answer: u8,
    busy: bool,
}

impl Writer {
    /// Looks for the table that counts.
    pub fn new(board: &mut impl Board) -> Self {
        Writer {
            newest: Stored::newest(board),
            next: None,
            bytes: [0; PLAN_CHUNK],
            used: 0,
            done: 0,
            address: 0,
            answer: 0,
            busy: false,
        }
    }

    /// The table that counts.
    pub fn newest(&self) -> Option<Stored> {
        self.newest
    }

    /// Whether bytes are still to be written.
    pub fn is_busy(&self) -> bool {
        self.busy
    }

    /// Begins to write a piece of a table; false if it lies outside, or another is being written.
    pub fn chunk(&mut self, offset: u16, bytes: &[u8; PLAN_CHUNK], answer: u8) -> bool {
        if self.busy || offset >= MAX_TABLE {
            return false;
        }
        let room = usize::from(MAX_TABLE - offset).min(PLAN_CHUNK);
        let address = start(self.other_slot()) + HEADER + offset;
        self.begin(address, bytes.get(..room).unwrap_or(bytes), answer);
        true
    }

    /// Begins to make the table count; false if it is not what its sender says, or nothing was
    /// written.
    pub fn store(&mut self, board: &mut impl Board, length: u16, check: u32, answer: u8) -> bool {
        if self.busy || !(1..=MAX_TABLE).contains(&length) {
            return false;
        }
        let slot = self.other_slot();
        if body_check(board, slot, length) != check {
            return false;
        }
        let sequence = self.newest.map_or(1, |old| old.sequence.wrapping_add(1));
        let sum = slot_check(sequence, length, check);
        self.next = Some(Stored {
            slot,
            sequence,
            length,
        });
        let mut header = [0; HEADER as usize];
        let bytes = (sequence.to_le_bytes().into_iter())
            .chain(length.to_le_bytes())
            .chain(sum.to_le_bytes());
        header
            .iter_mut()
            .zip(bytes)
            .for_each(|(slot, byte)| *slot = byte);
        self.begin(start(slot), &header, answer);
        true
    }

    fn begin(&mut self, address: u16, bytes: &[u8], answer: u8) {
        self.bytes
            .iter_mut()
            .zip(bytes)
            .for_each(|(slot, byte)| *slot = *byte);
        self.used = bytes.len() as u8;
        self.done = 0;
        self.address = address;
        self.answer = answer;
        self.busy = true;
    }

    /// Once per tick: writes a byte. When the last one is written, the command to answer, and
    /// whether another table counts from now on.
    pub fn tick(&mut self, board: &mut impl Board) -> Option<(u8, bool)> {
        if !self.busy || !board.eeprom_ready() {
            return None;
        }
        while self.done < self.used {
            let byte = self.bytes.get(usize::from(self.done)).copied().unwrap_or(0);
            let address = self.address + u16::from(self.done);
            self.done += 1;
            // A byte that is already right costs neither time nor wear.
            if board.eeprom_read(address) != byte {
                board.eeprom_write(address, byte);
                return None;
            }
        }
        self.busy = false;
        let next = self.next.take();
        self.newest = next.or(self.newest);
        Some((self.answer, next.is_some()))
    }

    fn other_slot(&self) -> u8 {
        match self.newest {
            Some(Stored { slot: 0, .. }) => 1,
            _ => 0,
        }
    }
}
