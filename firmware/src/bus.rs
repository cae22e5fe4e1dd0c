//! Requests to the servos, and their answers in bounded time.

use crate::board::Board;
use crate::design::{BETWEEN_BYTES_US, FIRST_BYTE_US};
use handstand_shared::control_table::{Register, TORQUE_ENABLE};
use handstand_shared::dynamixel::{
    BROADCAST, ErrorBits, OVERHEAD, Request, WHOLE_SUM, read_packet,
};
use handstand_shared::message::Statistics;
use handstand_shared::packed::SERVOS;
use handstand_shared::raw::ReturnDelay;

/// Why there is no answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// No byte in time.
    Silent,
    /// Bytes, but no packet of the right length and checksum.
    Garbled,
    /// Another servo answered.
    Stranger,
}

/// Reads `N` bytes from `address` on. Waits for as long as return delay and length say, and no longer.
pub fn read<B: Board, const N: usize>(
    board: &mut B,
    id: u8,
    address: u8,
    delay: ReturnDelay,
) -> Result<([u8; N], ErrorBits), Failure> {
    board.bus_flush();
    board.bus_send(&read_packet(id, address, N as u8));
    answer(board, id, delay)
}

/// Sums up while it waits for bytes, so that little is left to do after the last one.
fn answer<B: Board, const N: usize>(
    board: &mut B,
    id: u8,
    delay: ReturnDelay,
) -> Result<([u8; N], ErrorBits), Failure> {
    let first_us = delay.to_us().saturating_add(FIRST_BYTE_US);
    let mut sum = board.bus_receive(first_us).ok_or(Failure::Silent)?;
    let mut next = || {
        let byte = board
            .bus_receive(BETWEEN_BYTES_US)
            .ok_or(Failure::Garbled)?;
        sum = sum.wrapping_add(byte);
        Ok(byte)
    };
    let header = next()?;
    let (from, length, error) = (next()?, next()?, next()?);
    let mut data = [0; N];
    for slot in &mut data {
        *slot = next()?;
    }
    next()?;
    if sum != WHOLE_SUM || header != 0xff || usize::from(length) != N + 2 {
        return Err(Failure::Garbled);
    }
    match from == id {
        true => Ok((data, ErrorBits(error))),
        false => Err(Failure::Stranger),
    }
}

/// Counts an answer or the lack of it.
pub fn count<T>(statistics: &mut Statistics, outcome: &Result<T, Failure>) {
    let counter = match outcome {
        Ok(_) => &mut statistics.answers,
        Err(Failure::Silent) => &mut statistics.timeouts,
        Err(Failure::Garbled) => &mut statistics.garbled,
        Err(Failure::Stranger) => &mut statistics.strangers,
    };
    *counter = counter.saturating_add(1);
}

/// Writes the same value to a register of every servo.
pub fn write_all<B: Board>(board: &mut B, register: Register, value: u16) {
    let bytes = value.to_le_bytes();
    let data = bytes.get(..usize::from(register.size)).unwrap_or(&bytes);
    let request = Request::Write {
        address: register.address,
        data,
    };
    let mut out = [0; 10];
    if let Some(length) = request.emit(BROADCAST, &mut out) {
        board.bus_send(out.get(..length).unwrap_or(&[]));
    }
}

/// Torque off, everywhere. Twice, for nobody answers a broadcast.
pub fn torque_off<B: Board>(board: &mut B) {
    write_all(board, TORQUE_ENABLE, 0);
    write_all(board, TORQUE_ENABLE, 0);
}

/// Writes a value of its own to a register of each of these servos, in one packet.
pub fn write_each<B: Board>(
    board: &mut B,
    register: Register,
    values: impl Iterator<Item = (u8, u16)>,
) {
    const BLOCKS: usize = SERVOS * 3;
    let mut blocks = [0; BLOCKS];
    let mut slots = blocks.iter_mut();
    let mut used = 0;
    for (id, value) in values.take(SERVOS) {
        let [low, high] = value.to_le_bytes();
        let block = [id, low, high];
        for byte in block.iter().take(1 + usize::from(register.size)) {
            if let Some(slot) = slots.next() {
                *slot = *byte;
                used += 1;
            }
        }
    }
    let request = Request::SyncWrite {
        address: register.address,
        width: register.size,
        blocks: blocks.get(..used).unwrap_or(&[]),
    };
    let mut out = [0; OVERHEAD + 2 + BLOCKS];
    if used > 0
        && let Some(length) = request.emit(BROADCAST, &mut out)
    {
        board.bus_send(out.get(..length).unwrap_or(&[]));
    }
}
