//! Dynamixel Protocol 2.0, as X series and MX(2.0) servos speak it, from both ends. Source: ROBOTIS
//! e-manual, "DYNAMIXEL Protocol 2.0".
//!
//! `FF FF FD 00 ID LENGTH(2) INSTRUCTION PARAMETERS.. CRC(2)`, integers little-endian. LENGTH
//! counts what follows it. From the instruction to the last parameter an `FD` is inserted behind
//! every `FF FF FD`, so that no header occurs inside; LENGTH and CRC are of the stuffed packet.
//! Instruction `55` is a status: its first parameter is the error byte. Ids are those of
//! Protocol 1.0.

mod crc;
mod error_byte;
mod fast_status;
#[cfg(test)]
mod noise_tests;
mod packet;
mod receiver;
#[cfg(test)]
mod refusal_tests;
mod request;
mod stuffing;
#[cfg(test)]
mod tests;

pub use crate::dynamixel::BROADCAST;
pub use crc::crc16;
pub use error_byte::{ErrorByte, ErrorCode};
pub use fast_status::{FastPart, emit_fast_status, fast_parts};
pub use packet::{Packet, PacketError, emit_status};
pub use receiver::Receiver;
pub use request::{Instruction, Request, RequestError};
pub use stuffing::Unstuffed;

/// What every packet begins with; the fourth byte is reserved.
pub const HEADER: [u8; 4] = [0xff, 0xff, 0xfd, 0x00];
/// Bytes of a packet that are not parameters.
pub const OVERHEAD: usize = 10;
/// The longest packet sent or received here. The length field allows 65,542 bytes; ROBOTIS's SDK
/// has buffers of 1024.
pub const MAX_PACKET: usize = 1024;
/// Instruction byte of a status packet.
pub const STATUS: u8 = 0x55;
/// The largest id a servo can have; 253 and 255 are never used, 254 is [`BROADCAST`].
pub const MAX_ID: u8 = 252;

/// Bytes of the status packet that returns `count` bytes, without stuffing.
pub const fn status_length(count: usize) -> usize {
    OVERHEAD + 1 + count
}
