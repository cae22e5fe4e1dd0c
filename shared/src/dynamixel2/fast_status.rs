//! The joint status packet of a fast sync or bulk read: servo after servo appends error byte, id,
//! data and a CRC. It is not stuffed.
//!
//! Each CRC goes on from the packet's first byte over all before it, earlier CRCs included; the
//! last one is the packet's. So the parts in front of a servo that is missing are known to be
//! sound.

use super::{BROADCAST, ErrorByte, HEADER, STATUS, crc16};

/// Where the first part begins: header, id, length, instruction.
const PARTS: usize = 8;

/// What one servo says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FastPart<'a> {
    /// The servo.
    pub id: u8,
    /// Its error byte.
    pub error: ErrorByte,
    /// Its bytes.
    pub data: &'a [u8],
}

/// The sound parts in front of a joint status, of which `lengths` are the bytes asked of each servo
/// in turn; the packet may be cut short anywhere. Nothing if the bytes begin otherwise.
pub fn fast_parts<'a>(
    bytes: &'a [u8],
    lengths: impl Iterator<Item = usize>,
) -> impl Iterator<Item = FastPart<'a>> {
    let begins = bytes.starts_with(&HEADER)
        && bytes.get(4) == Some(&BROADCAST)
        && bytes.get(7) == Some(&STATUS);
    let mut at = PARTS;
    lengths
        .take_while(move |_| begins)
        .map_while(move |length| {
            let end = at + 2 + length;
            let ([error, id, data @ ..], crc) = (bytes.get(at..end)?, bytes.get(end..end + 2)?)
            else {
                return None;
            };
            at = end + 2;
            let is_sound = crc16(0, &bytes[..end]).to_le_bytes() == crc;
            is_sound.then_some(FastPart {
                id: *id,
                error: ErrorByte(*error),
                data,
            })
        })
}

/// Writes the joint status of these servos into `out`; its length, or nothing if it does not fit.
/// `announced` are the bytes that all servos asked would return: more than those of `parts` where
/// one is missing, behind which the packet breaks off.
pub fn emit_fast_status(out: &mut [u8], announced: usize, parts: &[FastPart]) -> Option<usize> {
    let body: usize = parts.iter().map(|part| part.data.len() + 4).sum();
    let [low, high] = u16::try_from(announced + 1).ok()?.to_le_bytes();
    let out = out.get_mut(..PARTS + body)?;
    out[..4].copy_from_slice(&HEADER);
    out[4..PARTS].copy_from_slice(&[BROADCAST, low, high, STATUS]);
    let mut at = PARTS;
    for part in parts {
        let end = at + 2 + part.data.len();
        out[at..at + 2].copy_from_slice(&[part.error.0, part.id]);
        out[at + 2..end].copy_from_slice(part.data);
        let crc = crc16(0, &out[..end]);
        out[end..end + 2].copy_from_slice(&crc.to_le_bytes());
        at = end + 2;
    }
    Some(at)
}
