//! A packet as bytes: a checked view, and writing one.

use super::OVERHEAD;

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
        match sum(bytes.iter().skip(2)) {
            0xff => Ok(Packet(bytes)),
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

/// Writes a packet into `out`; its length, or nothing if `out` or the packet's length byte is too small.
pub(super) fn emit(out: &mut [u8], id: u8, code: u8, head: &[u8], data: &[u8]) -> Option<usize> {
    let count = head.len() + data.len();
    let length = u8::try_from(count + 2).ok()?;
    let out = out.get_mut(..OVERHEAD + count)?;
    let parameters = head.iter().chain(data).copied();
    let all = [0xff, 0xff, id, length, code].into_iter().chain(parameters);
    out.iter_mut()
        .zip(all)
        .for_each(|(slot, byte)| *slot = byte);
    let (check, summed) = out.split_last_mut()?;
    *check = !sum(summed.iter().skip(2));
    Some(OVERHEAD + count)
}

fn sum<'a>(bytes: impl Iterator<Item = &'a u8>) -> u8 {
    bytes.fold(0, |sum: u8, byte| sum.wrapping_add(*byte))
}
