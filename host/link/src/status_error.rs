//! The error byte of a status packet, in either protocol.

use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::dynamixel2::{ErrorByte, ErrorCode};

/// What a servo complains of in an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StatusError {
    /// Protocol 1.0: a bit for each complaint, hardware and request alike.
    Flags(ErrorBits),
    /// Protocol 2.0: why the request was refused, and whether there is a hardware error.
    Byte(ErrorByte),
}

impl StatusError {
    /// The byte on the line.
    pub fn byte(self) -> u8 {
        match self {
            StatusError::Flags(bits) => bits.0,
            StatusError::Byte(byte) => byte.0,
        }
    }

    /// The complaints in words.
    pub fn names(self) -> Vec<&'static str> {
        match self {
            StatusError::Flags(bits) => bits.names().collect(),
            StatusError::Byte(byte) => {
                let alert = byte.has_alert().then_some("hardware error");
                let code = byte.code().map(ErrorCode::name);
                alert.into_iter().chain(code).collect()
            }
        }
    }

    /// Whether the servo has a hardware error, which its register 70 names (Protocol 2.0).
    pub fn has_alert(self) -> bool {
        matches!(self, StatusError::Byte(byte) if byte.has_alert())
    }

    /// Whether a write that is answered so was refused. In Protocol 1.0 any flag may say so.
    pub(super) fn may_refuse(self) -> bool {
        match self {
            StatusError::Flags(bits) => bits != ErrorBits(0),
            StatusError::Byte(byte) => byte.code().is_some(),
        }
    }

    /// Whether an answer without data is a refusal, and not one to another request.
    pub(super) fn refuses(self) -> bool {
        match self {
            StatusError::Flags(bits) => {
                let refusals =
                    ErrorBits::RANGE.0 | ErrorBits::CHECKSUM.0 | ErrorBits::INSTRUCTION.0;
                bits.0 & refusals != 0
            }
            StatusError::Byte(byte) => byte.code().is_some(),
        }
    }

    /// Whether the servo received the request damaged.
    pub(super) fn is_corrupted_request(self) -> bool {
        match self {
            StatusError::Flags(bits) => bits.has(ErrorBits::CHECKSUM),
            StatusError::Byte(byte) => byte.code() == Some(ErrorCode::Crc),
        }
    }

    /// Whether the servo refuses access to a register.
    pub(super) fn is_access(self) -> bool {
        matches!(self, StatusError::Byte(byte) if byte.code() == Some(ErrorCode::Access))
    }
}

impl PartialEq<ErrorBits> for StatusError {
    fn eq(&self, bits: &ErrorBits) -> bool {
        matches!(self, StatusError::Flags(own) if own == bits)
    }
}
