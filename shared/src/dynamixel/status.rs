//! What a servo answers.

use super::packet::{Packet, emit};

/// What a servo complains of, a bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ErrorBits(pub u8);

impl ErrorBits {
    /// Supply out of its limits.
    pub const VOLTAGE: ErrorBits = ErrorBits(1);
    /// Goal outside the angle limits.
    pub const ANGLE: ErrorBits = ErrorBits(2);
    /// Too hot.
    pub const OVERHEAT: ErrorBits = ErrorBits(4);
    /// A value out of its register's range.
    pub const RANGE: ErrorBits = ErrorBits(8);
    /// It received a wrong checksum.
    pub const CHECKSUM: ErrorBits = ErrorBits(16);
    /// The load is more than the torque limit can hold.
    pub const OVERLOAD: ErrorBits = ErrorBits(32);
    /// Unknown instruction, or ACTION without REG_WRITE.
    pub const INSTRUCTION: ErrorBits = ErrorBits(64);

    const NAMES: [&'static str; 7] = [
        "voltage",
        "angle",
        "overheat",
        "range",
        "checksum",
        "overload",
        "instruction",
    ];

    /// Whether all of these are set.
    pub fn has(self, bits: ErrorBits) -> bool {
        self.0 & bits.0 == bits.0
    }

    /// These as well.
    pub fn with(self, bits: ErrorBits) -> Self {
        ErrorBits(self.0 | bits.0)
    }

    /// The names of those that are set.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        let bit = move |at: usize| self.0 >> at & 1 == 1;
        (Self::NAMES.into_iter().enumerate()).filter_map(move |(at, name)| bit(at).then_some(name))
    }
}

/// A status packet's content.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Status<'a> {
    /// Who answers.
    pub id: u8,
    /// What it complains of.
    pub error: ErrorBits,
    /// The bytes read, if any were asked for.
    pub data: &'a [u8],
}

impl<'a> Status<'a> {
    /// Reads a packet as an answer.
    pub fn of(packet: Packet<'a>) -> Self {
        Status {
            id: packet.id(),
            error: ErrorBits(packet.code()),
            data: packet.parameters(),
        }
    }

    /// Writes it into `out`; the packet's length, or nothing if it does not fit.
    pub fn emit(&self, out: &mut [u8]) -> Option<usize> {
        emit(out, self.id, self.error.0, &[], self.data)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{MAX_PACKET, status_length};
    use super::*;

    #[test]
    fn the_manuals_answers() {
        let ping = [0xff, 0xff, 0x01, 0x02, 0x00, 0xfc];
        let read = [0xff, 0xff, 0x01, 0x03, 0x00, 0x20, 0xdb];
        for (bytes, data) in [(&ping[..], &[][..]), (&read, &[0x20])] {
            let status = Status::of(Packet::new(bytes).unwrap());
            let error = ErrorBits(0);
            assert_eq!(status, Status { id: 1, error, data });
            let mut out = [0; 8];
            let length = status.emit(&mut out).unwrap();
            assert_eq!(&out[..length], bytes);
            assert_eq!(length, status_length(data.len() as u8));
        }
        // As long as one byte of length can say.
        let data = [0; 253];
        let longest = Status {
            id: 1,
            error: ErrorBits(0),
            data: &data,
        };
        assert_eq!(longest.emit(&mut [0; 300]), Some(MAX_PACKET));
    }

    #[test]
    fn error_bits_have_the_manuals_names() {
        let error = ErrorBits::OVERLOAD.with(ErrorBits::VOLTAGE);
        assert!(error.names().eq(["voltage", "overload"]));
        assert_eq!(error.with(ErrorBits::OVERLOAD), error);
        assert!(error.has(ErrorBits::OVERLOAD) && !error.has(ErrorBits::ANGLE));
    }
}
