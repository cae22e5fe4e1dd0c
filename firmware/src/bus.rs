//! Requests to the servos, and their answers in bounded time.
//!
//! A request goes out while the program does something else, such as looking at the answer before
//! it.

use crate::board::{Board, since_us};
use crate::design::{
    ANSWER_US, BETWEEN_BYTES_US, BETWEEN_WRITES_US, COMMANDS_US, FIRST_BYTE_US, FLUSH_BYTES,
};
use handstand_shared::control_table::{Register, TORQUE_ENABLE};
use handstand_shared::dynamixel::{
    BROADCAST, ErrorBits, OVERHEAD, Request, WHOLE_SUM, check_byte, sync_write_head,
};
use handstand_shared::message::Statistics;
use handstand_shared::raw::ReturnDelay;

/// Most bytes of registers read at once: from torque enable to temperature.
pub const MOST_READ: usize = 20;

/// An answer's bytes as they came; fewer than were asked for if the servo fell silent.
#[derive(Debug, Clone, Default)]
pub struct Answer {
    bytes: [u8; OVERHEAD + MOST_READ],
    used: u8,
}

/// A READ, as it goes out.
pub type ReadPacket = [u8; 8];

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

/// Sends a READ of at most [`MOST_READ`] bytes. What came unasked is forgotten.
#[inline(always)]
pub fn ask<B: Board>(board: &mut B, request: &ReadPacket) {
    board.bus_flush();
    board.bus_send(request);
}

/// The bytes of the answer to a READ of `count`. Waits for as long as return delay and length say,
/// and no longer.
#[inline(always)]
pub fn hear<B: Board>(board: &mut B, count: u8, delay: ReturnDelay, answer: &mut Answer) {
    let first_us = delay.to_us().saturating_add(FIRST_BYTE_US);
    let whole = (OVERHEAD + usize::from(count)).min(answer.bytes.len());
    let out = answer.bytes.get_mut(..whole).unwrap_or(&mut []);
    answer.used = board.bus_hear(out, first_us, BETWEEN_BYTES_US, ANSWER_US) as u8;
    if !matches!(answer.bytes, [0xff, 0xff, ..]) {
        find_header(board, whole, answer);
    }
}

/// Moves an answer behind a stray byte, as a line that turns round may give, to where it belongs,
/// and takes the rest of it.
#[cold]
#[inline(never)]
fn find_header<B: Board>(board: &mut B, whole: usize, answer: &mut Answer) {
    let used = usize::from(answer.used);
    let heard = answer.bytes.get(..used).unwrap_or(&[]);
    let Some(stray) = heard.windows(2).position(|pair| pair == [0xff, 0xff]) else {
        return;
    };
    let from = answer.bytes;
    let kept = from.get(stray..used).unwrap_or(&[]);
    (answer.bytes.iter_mut().zip(kept)).for_each(|(slot, byte)| *slot = *byte);
    let kept = kept.len();
    if let Some(rest) = answer.bytes.get_mut(kept..whole) {
        let more = board.bus_hear(rest, BETWEEN_BYTES_US, BETWEEN_BYTES_US, ANSWER_US);
        answer.used = (kept + more) as u8;
    }
}

/// The `N` registers in an answer, if it is one of this servo, whole and undamaged.
#[inline(always)]
pub fn look<const N: usize>(answer: &Answer, id: u8) -> Result<([u8; N], ErrorBits), Failure> {
    let bytes = answer.bytes.get(..usize::from(answer.used));
    let bytes = bytes.unwrap_or(&[]);
    if bytes.is_empty() {
        return Err(Failure::Silent);
    }
    let [0xff, 0xff, from, length, error, rest @ ..] = bytes else {
        return Err(Failure::Garbled);
    };
    let sum = bytes.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
    match rest.first_chunk::<N>() {
        Some(data) if rest.len() == N + 1 && usize::from(*length) == N + 2 && sum == WHOLE_SUM => {
            if *from == id {
                Ok((*data, ErrorBits(*error)))
            } else {
                Err(Failure::Stranger)
            }
        }
        _ => Err(Failure::Garbled),
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
#[inline(never)]
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

/// Torque off, everywhere, when nothing is known of what the servos were hearing: a restart within
/// a packet leaves them waiting for its rest, which would swallow what follows.
pub fn torque_off_at_start<B: Board>(board: &mut B) {
    write_all(board, TORQUE_ENABLE, 0);
    const PIECE: u16 = 32;
    for _ in 0..FLUSH_BYTES / PIECE {
        board.bus_send(&[0xff; PIECE as usize]);
    }
    torque_off(board);
}

/// Torque off, everywhere. Twice, for no servo answers a broadcast, and a servo that was just
/// written ignores the first.
pub fn torque_off<B: Board>(board: &mut B) {
    write_all(board, TORQUE_ENABLE, 0);
    pause(board);
    write_all(board, TORQUE_ENABLE, 0);
}

/// Waits as long as a servo may need to obey a write: it ignores one that comes before.
pub fn pause<B: Board>(board: &mut B) {
    board.wait(BETWEEN_WRITES_US);
}

/// Waits until servos obey another write after one of commands that was handed over at this reading
/// of the clock.
pub fn pause_since<B: Board>(board: &mut B, handed_over: u16) {
    const US: u16 = COMMANDS_US + BETWEEN_WRITES_US;
    board.wait(US.saturating_sub(since_us(board, handed_over)));
}

/// Writes a value of its own to a register of each of `servos` servos, in one packet, which goes
/// out while it is made.
pub fn write_each<B: Board>(
    board: &mut B,
    register: Register,
    servos: u8,
    values: impl Iterator<Item = (u8, u16)>,
) {
    if servos == 0 {
        return;
    }
    let head = sync_write_head(register.address, register.size, servos);
    board.bus_send_part(&head);
    let mut sum = head.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
    for (id, value) in values.take(usize::from(servos)) {
        let [low, high] = value.to_le_bytes();
        sum = sum.wrapping_add(id).wrapping_add(low);
        if register.size == 1 {
            board.bus_send_part(&[id, low]);
        } else {
            sum = sum.wrapping_add(high);
            board.bus_send_part(&[id, low, high]);
        }
    }
    board.bus_send(&[check_byte(sum)]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_board::TestBoard;

    fn gap_us(board: &TestBoard) -> u16 {
        let [.., (_, [_, ended]), (_, [began, _])] = &board.sent[..] else {
            panic!("two packets");
        };
        began - ended
    }

    /// A servo ignores a write that comes right behind another.
    #[test]
    fn torque_off_is_said_twice_with_a_pause_between() {
        let mut board = TestBoard::default();
        torque_off(&mut board);
        assert_eq!(board.sent.len(), 2);
        assert_eq!(board.sent[0].0, board.sent[1].0);
        let gap = gap_us(&board);
        assert!(
            (BETWEEN_WRITES_US..BETWEEN_WRITES_US + 5).contains(&gap),
            "{gap}"
        );
    }

    /// Less what has passed since they were handed over.
    #[test]
    fn commands_have_gone_out_and_were_obeyed_before_the_next() {
        for passed in [0, 100, 1000] {
            let mut board = TestBoard::default();
            let handed_over = board.clock();
            board.pass_us(passed);
            pause_since(&mut board, handed_over);
            let waited = board.now_us() - passed;
            let due = (COMMANDS_US + BETWEEN_WRITES_US).saturating_sub(passed);
            assert!((due..due + 5).contains(&waited), "{passed}: {waited}");
        }
    }
}
