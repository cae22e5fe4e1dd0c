//! A packet as bytes: a checked view, and writing one.

use super::{OVERHEAD, WHOLE_SUM};

/// Bytes known to be one whole packet with the right checksum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packet<'a>(&'a [u8]);

/// Why bytes are no packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PacketError {
    /// It does not begin with `FF FF` and an id.
    Header,
    /// The bytes are fewer or more than its length says.
    Length,
    /// The sum is wrong.
    Checksum,
}

impl<'a> Packet<'a> {
    /// Checks header, length and checksum.
    pub fn new(bytes: &'a [u8]) -> Result<Self, PacketError> {
        let [0xff, 0xff, id, length, rest @ ..] = bytes else {
            return Err(PacketError::Header);
        };
        if *id == 0xff {
            return Err(PacketError::Header);
        }
        if *length < 2 || rest.len() != usize::from(*length) {
            return Err(PacketError::Length);
        }
        match sum(bytes.iter()) {
            WHOLE_SUM => Ok(Packet(bytes)),
            _ => Err(PacketError::Checksum),
        }
    }

    /// Servo meant, or servo answering.
    pub fn id(&self) -> u8 {
        self.byte(2)
    }

    /// Instruction, or error bits of an answer.
    pub fn code(&self) -> u8 {
        self.byte(4)
    }

    /// What lies between code and checksum.
    pub fn parameters(&self) -> &'a [u8] {
        match self.0 {
            [_, _, _, _, _, parameters @ .., _] => parameters,
            _ => &[],
        }
    }

    /// All of it.
    pub fn bytes(&self) -> &'a [u8] {
        self.0
    }

    fn byte(&self, at: usize) -> u8 {
        // The view is at least six bytes long; `get` keeps panics out of the AVR's image.
        self.0.get(at).copied().unwrap_or(0)
    }
}

/// Writes a packet into `out`; its length, or nothing if `out` or the packet's length byte is too
/// small.
pub(super) fn emit(out: &mut [u8], id: u8, code: u8, head: &[u8], data: &[u8]) -> Option<usize> {
    let count = head.len() + data.len();
    let length = u8::try_from(count + 2).ok()?;
    let out = out.get_mut(..OVERHEAD + count)?;
    // One plain loop: chained iterators cost the AVR a hundred cycles a byte.
    let mut slots = out.iter_mut();
    let mut sum = 0u8;
    let mut put = |byte: u8| {
        sum = sum.wrapping_add(byte);
        if let Some(slot) = slots.next() {
            *slot = byte;
        }
    };
    put(0xff);
    put(0xff);
    put(id);
    put(length);
    put(code);
    head.iter().for_each(|byte| put(*byte));
    data.iter().for_each(|byte| put(*byte));
    // The header is in the sum, and is no part of the checksum: 2 x FF = -2.
    let check = !sum.wrapping_add(2);
    if let Some(slot) = slots.next() {
        *slot = check;
    }
    Some(OVERHEAD + count)
}

fn sum<'a>(bytes: impl Iterator<Item = &'a u8>) -> u8 {
    bytes.fold(0, |sum: u8, byte| sum.wrapping_add(*byte))
}
