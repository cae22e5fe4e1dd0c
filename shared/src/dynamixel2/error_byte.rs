//! The error byte of a status packet.

/// Why a servo did not do what it was asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorCode {
    /// 1: it could not process the instruction.
    Result,
    /// 2: undefined instruction, or ACTION without REG_WRITE.
    Instruction,
    /// 3: the request's CRC was wrong.
    Crc,
    /// 4: a value outside its range, or a goal after the bus watchdog tripped.
    DataRange,
    /// 5: fewer bytes than the register has.
    DataLength,
    /// 6: a value outside a limit that is set in the servo.
    DataLimit,
    /// 7: read-only or undefined address, or EEPROM while torque is on.
    Access,
    /// A code that the manual does not list.
    Other(u8),
}

impl ErrorCode {
    /// Its name in words.
    pub fn name(self) -> &'static str {
        match self {
            ErrorCode::Result => "result fail",
            ErrorCode::Instruction => "instruction",
            ErrorCode::Crc => "CRC",
            ErrorCode::DataRange => "data range",
            ErrorCode::DataLength => "data length",
            ErrorCode::DataLimit => "data limit",
            ErrorCode::Access => "access",
            ErrorCode::Other(_) => "unknown error",
        }
    }
}

/// Error byte: an alert, which comes with good data, and a code, which comes with none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ErrorByte(pub u8);

impl ErrorByte {
    /// The servo has a hardware error: its register 70 says which.
    pub const ALERT: u8 = 0x80;

    /// Whether the servo has a hardware error; the answer is good all the same.
    pub fn has_alert(self) -> bool {
        self.0 & Self::ALERT != 0
    }

    /// Why the request was refused; none if it was not.
    pub fn code(self) -> Option<ErrorCode> {
        Some(match self.0 & !Self::ALERT {
            0 => return None,
            1 => ErrorCode::Result,
            2 => ErrorCode::Instruction,
            3 => ErrorCode::Crc,
            4 => ErrorCode::DataRange,
            5 => ErrorCode::DataLength,
            6 => ErrorCode::DataLimit,
            7 => ErrorCode::Access,
            other => ErrorCode::Other(other),
        })
    }
}
