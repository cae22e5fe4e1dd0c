//! Dynamixel Protocol 1.0, as the AX-12 speaks it, from both ends. Source: ROBOTIS e-manual,
//! "DYNAMIXEL Protocol 1.0".
//!
//! `FF FF ID LENGTH CODE PARAMETERS.. CHECKSUM`; LENGTH counts what follows it, the checksum is the
//! inverted sum of all from ID on. CODE is an instruction on the way to a servo and its error bits
//! on the way back.

mod ids;
mod packet;
mod parser;
mod request;
mod status;
pub mod timing;

pub use ids::{ID_LIST_SYNTAX, ids};
pub use packet::{Packet, PacketError};
pub use parser::Parser;
pub use request::{Instruction, Request, RequestError, check_byte, read_packet, sync_write_head};
pub use status::{ErrorBits, Status};

/// Every servo listens to this id; none answers it.
pub const BROADCAST: u8 = 254;
/// Bytes of a packet that are not parameters.
pub const OVERHEAD: usize = 6;
/// All bytes of a sound packet, the header included, sum up to this.
pub const WHOLE_SUM: u8 = 0xfd;
/// The longest packet there can be.
pub const MAX_PACKET: usize = 4 + 255;

/// Bytes of the status packet that returns `count` bytes.
pub const fn status_length(count: u8) -> usize {
    OVERHEAD + count as usize
}
