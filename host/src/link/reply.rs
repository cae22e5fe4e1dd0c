//! Finding a servo's answer among the bytes that came.

use handstand_shared::dynamixel::{ErrorBits, MAX_PACKET, Packet, Parser, Status};

/// A good answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reading {
    /// What the servo complains of.
    pub error: ErrorBits,
    /// The bytes asked for.
    pub data: Vec<u8>,
}

impl Reading {
    /// The bytes as one code, the lower byte first.
    pub fn code(&self) -> u16 {
        self.data
            .iter()
            .take(2)
            .rev()
            .fold(0, |code, byte| code << 8 | u16::from(*byte))
    }
}

/// Whether this can be the answer: the bytes asked for, or a refusal of the request.
pub(super) fn is_answer(reading: &Reading, count: u8) -> bool {
    let refusals = ErrorBits::RANGE.0 | ErrorBits::CHECKSUM.0 | ErrorBits::INSTRUCTION.0;
    reading.data.len() == usize::from(count)
        || (reading.data.is_empty() && reading.error.0 & refusals != 0)
}

/// The status packet of servo `id` in these bytes, or else of another.
pub(super) fn status(bytes: &[u8], id: u8) -> Option<(u8, Reading)> {
    let mut parser = Parser::<MAX_PACKET>::default();
    let mut found: Option<(u8, Reading)> = None;
    for byte in bytes {
        let Some(status) = parser.push(*byte).map(|packet: Packet| Status::of(packet)) else {
            continue;
        };
        if found.as_ref().is_none_or(|(from, _)| *from != id) {
            found = Some((
                status.id,
                Reading {
                    error: status.error,
                    data: status.data.to_vec(),
                },
            ));
        }
    }
    found
}
