//! The PC line: frames in, frames out.

use crate::board::Board;
use handstand_shared::frame::{Decoder, MAX_FRAME};
use handstand_shared::message::{Command, Numbered, Report, Statistics, decode, encode};

/// Both directions of the line.
#[derive(Debug, Clone)]
pub struct Link {
    decoder: Decoder,
    /// The frame that was sent last: to clear one for each takes time.
    frame: [u8; MAX_FRAME],
    next_out: u8,
    next_in: Option<u8>,
}

impl Default for Link {
    fn default() -> Self {
        Link {
            decoder: Decoder::default(),
            frame: [0; MAX_FRAME],
            next_out: 0,
            next_in: None,
        }
    }
}

impl Link {
    /// Takes a byte from the PC; the command it completes, if it does.
    // Apart from its caller, which with it would be too long for the AVR's relative jumps.
    #[inline(never)]
    pub fn push(&mut self, byte: u8, statistics: &mut Statistics) -> Option<Numbered<Command>> {
        let command = match self.decoder.push(byte)? {
            Ok(body) => decode(body).ok(),
            Err(_) => None,
        };
        let Some(command) = command else {
            statistics.bad_frames = statistics.bad_frames.saturating_add(1);
            return None;
        };
        statistics.frames = statistics.frames.saturating_add(1);
        if let Some(expected) = self.next_in {
            let lost = u16::from(command.sequence.wrapping_sub(expected));
            statistics.lost_frames = statistics.lost_frames.saturating_add(lost);
        }
        self.next_in = Some(command.sequence.wrapping_add(1));
        Some(command)
    }

    /// Whether a frame has begun.
    pub fn is_idle(&self) -> bool {
        self.decoder.is_idle()
    }

    /// Forgets a frame that was begun.
    pub fn reset(&mut self) {
        self.decoder.reset();
    }

    /// A new session: lost frames are counted from 0.
    pub fn greet(&mut self, statistics: &mut Statistics) {
        statistics.lost_frames = 0;
    }

    /// Queues a report; false if there is no room for all of it now.
    pub fn send<B: Board>(&mut self, board: &mut B, report: &Report) -> bool {
        let Some(length) = encode(self.next_out, report, &mut self.frame) else {
            return false;
        };
        if board.link_room() < length {
            return false;
        }
        board.link_send(self.frame.get(..length).unwrap_or(&[]));
        self.next_out = self.next_out.wrapping_add(1);
        true
    }
}
