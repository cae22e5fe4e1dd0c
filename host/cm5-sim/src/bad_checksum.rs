//! Detect requests that arrive with a wrong checksum.

use handstand_shared::dynamixel::WHOLE_SUM;

/// Follows the packets on the line as a servo does, whatever their checksum.
#[derive(Debug, Default)]
pub(super) struct BadChecksum {
    bytes: Vec<u8>,
}

impl BadChecksum {
    /// Take the next byte; returns the addressed id when it ends a packet with a wrong checksum.
    pub fn push(&mut self, byte: u8) -> Option<u8> {
        self.bytes.push(byte);
        let whole = match self.bytes[..] {
            [0xff] | [0xff, 0xff] => return None,
            // More than two are a longer pause, not an id.
            [0xff, 0xff, 0xff] => {
                self.bytes.pop();
                return None;
            }
            [0xff, 0xff, _] => return None,
            [0xff, 0xff, _, length, ..] if length >= 2 => usize::from(length) + 4,
            _ => {
                self.bytes.clear();
                return None;
            }
        };
        if self.bytes.len() < whole {
            return None;
        }
        let bytes = std::mem::take(&mut self.bytes);
        let sum = bytes.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
        (sum != WHOLE_SUM).then_some(bytes[2])
    }
}
