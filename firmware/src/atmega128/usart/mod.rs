//! Both USARTs: 0 is the servo bus, 1 the PC line.

pub mod bus;
mod link;

pub use link::Link;

/// Bits of the status register A.
const DOUBLE_SPEED: u8 = 1 << 1;
const EMPTY: u8 = 1 << 5;
const SENT: u8 = 1 << 6;
const RECEIVED: u8 = 1 << 7;

/// Bits of the control register B.
const TRANSMITTER: u8 = 1 << 3;
const RECEIVER_ON: u8 = 1 << 4;
const EMPTY_INTERRUPT: u8 = 1 << 5;
const SENT_INTERRUPT: u8 = 1 << 6;
const RECEIVER: u8 = RECEIVER_ON | 1 << 7; // with its interrupt

/// Of the control register C: 8N1.
const EIGHT_BITS: u8 = 0b110;
