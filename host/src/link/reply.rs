//! Finding a servo's answer among the bytes that came.

use super::protocol::Protocol;
use super::status_error::StatusError;
use handstand_shared::dynamixel::{MAX_PACKET, Packet, Parser, Status};
use handstand_shared::dynamixel2::{self as two, Receiver};

/// A good answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reading {
    /// What the servo complains of.
    pub error: StatusError,
    /// The bytes asked for.
    pub data: Vec<u8>,
}

/// Whether this can be the answer: the bytes asked for, or a refusal of the request.
pub(super) fn is_answer(reading: &Reading, count: usize) -> bool {
    reading.data.len() == count || (reading.data.is_empty() && reading.error.refuses())
}

/// The status packet of servo `id` in these bytes, or else of another.
pub(super) fn status(protocol: Protocol, bytes: &[u8], id: u8) -> Option<(u8, Reading)> {
    let mut found: Option<(u8, Reading)> = None;
    let mut take = |from: u8, reading: Reading| {
        if found.as_ref().is_none_or(|(from, _)| *from != id) {
            found = Some((from, reading));
        }
    };
    match protocol {
        Protocol::One => {
            let mut parser = Parser::<MAX_PACKET>::default();
            for byte in bytes {
                if let Some(packet) = parser.push(*byte) {
                    let (from, reading) = of_one(packet);
                    take(from, reading);
                }
            }
        }
        Protocol::Two => statuses(bytes).into_iter().for_each(|(from, reading)| {
            take(from, reading);
        }),
    }
    found
}

/// Every status packet of Protocol 2.0 in these bytes.
pub(super) fn statuses(bytes: &[u8]) -> Vec<(u8, Reading)> {
    let mut receiver = Box::<Receiver<{ two::MAX_PACKET }>>::default();
    let mut found = Vec::new();
    let mut take = |packet: two::Packet| {
        if let Some((error, data)) = packet.status() {
            let (error, data) = (StatusError::Byte(error), data.collect());
            found.push((packet.id(), Reading { error, data }));
        }
    };
    for byte in bytes {
        receiver.push(*byte).into_iter().for_each(&mut take);
    }
    // No more will come: what a false packet swallowed is looked for within it.
    while !receiver.is_empty() {
        receiver.give_up();
        while let Some(packet) = receiver.next_packet() {
            take(packet);
        }
    }
    found
}

fn of_one(packet: Packet) -> (u8, Reading) {
    let status = Status::of(packet);
    let reading = Reading {
        error: StatusError::Flags(status.error),
        data: status.data.to_vec(),
    };
    (status.id, reading)
}
