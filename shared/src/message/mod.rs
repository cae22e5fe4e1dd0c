//! What host and firmware say to each other: postcard messages in [`crate::frame`]s.
//!
//! A body is `sequence, message` and, behind messages that move torque or gains, a CRC-32 of both:
//! noise that slips through the frame's CRC-16 must never arm a robot. Sequence numbers count
//! frames per direction, so that the other side can count what was lost. [`VERSION`] is compared in
//! `Hello` before anything else is accepted.

mod command;
mod fault;
mod report;
mod stream_report;

pub use command::{ArmLimits, Attitude, Command, Mode, PLAN_CHUNK, ServoList, Subject};
pub use fault::FaultEntry;
pub use report::{
    Answer, Cause, Condition, Hello, Refusal, Report, ResetCause, Statistics, Telemetry,
    TrippedServo,
};
pub use stream_report::{Housekeeping, StreamReport};

use crate::crc::crc32;
use crate::frame::{self, MAX_BODY, MAX_FRAME};
use serde::{Deserialize, Serialize};

/// Version of the messages; host and firmware must have the same.
pub const VERSION: u8 = 6;

/// Period of the ticks that the firmware reports, us: 100 Hz, as the paper samples.
pub const TICK_US: u16 = 10_000;

/// A message for one direction of the line.
pub trait Message: Serialize + for<'de> Deserialize<'de> {
    /// A byte that its frames do not hold.
    const WITHOUT: Option<u8>;

    /// Whether it carries a CRC-32 of its own.
    fn is_critical(&self) -> bool;
}

impl Message for Command {
    /// The CM-5's boot loader takes it, during a reset, for the wish to stay in it: a restart of
    /// the controller while the host speaks would leave the servos torqued.
    const WITHOUT: Option<u8> = Some(b'#');

    fn is_critical(&self) -> bool {
        match self {
            Command::Arm { .. } | Command::PlanChunk { .. } | Command::PlanStore { .. } => true,
            Command::Hello { .. }
            | Command::Mode(_)
            | Command::ServoList(_)
            | Command::Goals(_)
            | Command::Speeds(_)
            | Command::Attitude(_)
            | Command::KeepAlive
            | Command::Disarm
            | Command::LetDown
            | Command::Ask(_)
            | Command::PlanRead { .. }
            | Command::FaultRead { .. } => false,
        }
    }
}

impl Message for Report {
    const WITHOUT: Option<u8> = None;

    fn is_critical(&self) -> bool {
        matches!(self, Report::PlanChunk { .. })
    }
}

/// A message with its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Numbered<M> {
    /// Counts the frames of its direction, modulo 256.
    pub sequence: u8,
    /// The content.
    pub message: M,
}

/// Why a frame's body is no message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MessageError {
    /// No message of this version looks like this.
    Content,
    /// The CRC-32 of a critical message is missing or wrong.
    Check,
}

/// Writes the frame of a message into `out`; its length, or nothing if it does not fit.
pub fn encode<M: Message>(sequence: u8, message: &M, out: &mut [u8; MAX_FRAME]) -> Option<usize> {
    let Some(byte) = M::WITHOUT else {
        let (_, body) = out.split_first_mut()?;
        let length = write_body(sequence, message, body.get_mut(..MAX_BODY)?)?;
        return frame::encode_in_place(length, out);
    };
    let mut body = [0; MAX_BODY];
    let length = write_body(sequence, message, &mut body)?;
    frame::encode_without(byte, body.get(..length)?, out)
}

/// Sequence number, message and, if it is critical, check; their length.
fn write_body<M: Message>(sequence: u8, message: &M, body: &mut [u8]) -> Option<usize> {
    let (first, content) = body.split_first_mut()?;
    *first = sequence;
    let length = 1 + postcard::to_slice(message, content).ok()?.len();
    if !message.is_critical() {
        return Some(length);
    }
    let check = crc32(body.get(..length)?).to_le_bytes();
    let slots = body.get_mut(length..length + check.len())?;
    slots
        .iter_mut()
        .zip(check)
        .for_each(|(slot, byte)| *slot = byte);
    Some(length + check.len())
}

/// Reads the body of a frame.
pub fn decode<M: Message>(body: &[u8]) -> Result<Numbered<M>, MessageError> {
    let (&sequence, content) = body.split_first().ok_or(MessageError::Content)?;
    let (message, rest) =
        postcard::take_from_bytes::<M>(content).map_err(|_| MessageError::Content)?;
    match (message.is_critical(), rest) {
        (false, []) => {}
        (true, &[a, b, c, d]) => {
            let summed = body.get(..body.len() - 4).unwrap_or(&[]);
            if crc32(summed).to_le_bytes() != [a, b, c, d] {
                return Err(MessageError::Check);
            }
        }
        (true, _) => return Err(MessageError::Check),
        (false, _) => return Err(MessageError::Content),
    }
    Ok(Numbered { sequence, message })
}

#[cfg(test)]
mod tests;
