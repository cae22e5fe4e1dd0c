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

/// A status packet among bytes that came.
pub(super) struct FoundStatus {
    /// Who sent it.
    pub from: u8,
    /// What it says.
    pub reading: Reading,
    /// How many bytes came with it and behind it.
    pub behind: usize,
}

/// The status packet of servo `id` in these bytes, or else of another.
pub(super) fn status(protocol: Protocol, bytes: &[u8], id: u8) -> Option<FoundStatus> {
    let mut found: Option<FoundStatus> = None;
    let mut take = |from: u8, reading: Reading, behind: usize| {
        if found.as_ref().is_none_or(|found| found.from != id) {
            found = Some(FoundStatus {
                from,
                reading,
                behind,
            });
        }
    };
    match protocol {
        Protocol::One => {
            let mut parser = Parser::<MAX_PACKET>::default();
            for (place, byte) in bytes.iter().enumerate() {
                if let Some(packet) = parser.push(*byte) {
                    let (from, reading) = of_one(packet);
                    take(from, reading, bytes.len() - place - 1);
                }
            }
        }
        Protocol::Two => (placed_statuses(bytes).into_iter())
            .for_each(|(from, reading, end)| take(from, reading, bytes.len() - end)),
    }
    found
}

/// Every status packet of Protocol 2.0 in these bytes.
pub(super) fn statuses(bytes: &[u8]) -> Vec<(u8, Reading)> {
    let all = placed_statuses(bytes).into_iter();
    all.map(|(id, reading, _)| (id, reading)).collect()
}

/// The same, each with the place behind its last byte; the end of the bytes where a false packet
/// had swallowed it.
fn placed_statuses(bytes: &[u8]) -> Vec<(u8, Reading, usize)> {
    let mut receiver = Box::<Receiver<{ two::MAX_PACKET }>>::default();
    let mut found = Vec::new();
    let mut take = |packet: two::Packet, end: usize| {
        if let Some((error, data)) = packet.status() {
            let (error, data) = (StatusError::Byte(error), data.collect());
            found.push((packet.id(), Reading { error, data }, end));
        }
    };
    for (place, byte) in bytes.iter().enumerate() {
        let packet = receiver.push(*byte);
        packet
            .into_iter()
            .for_each(|packet| take(packet, place + 1));
    }
    // No more will come: what a false packet swallowed is looked for within it.
    while !receiver.is_empty() {
        receiver.give_up();
        while let Some(packet) = receiver.next_packet() {
            take(packet, bytes.len());
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
