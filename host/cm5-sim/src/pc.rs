//! The PC at the other end of a simulated CM-5's line: encodes commands, decodes reports.

use handstand_shared::frame::{Decoder, MAX_FRAME};
use handstand_shared::message::{Command, Report, decode, encode};

/// What arrived from the CM-5, and the sequence numbers of what is sent.
#[derive(Debug, Default)]
pub struct Pc {
    /// Reports that arrived intact, each with the end of its last stop bit, ms.
    pub reports: Vec<(f64, Report)>,
    /// Raw bytes that arrived.
    pub raw: Vec<u8>,
    /// Frames that arrived damaged.
    pub bad_frames: usize,
    /// Number of bytes that arrived since power-on.
    pub bytes: u64,
    decoder: Decoder,
    sequence: u8,
}

impl Pc {
    /// Take a byte from the CM-5, whose stop bit ended at `end_ms`.
    pub fn receive(&mut self, end_ms: f64, byte: u8) {
        self.bytes += 1;
        self.raw.push(byte);
        match (self.decoder.push(byte)).map(|body| body.map(decode::<Report>)) {
            Some(Ok(Ok(report))) => self.reports.push((end_ms, report.message)),
            Some(_) => self.bad_frames += 1,
            None => {}
        }
    }

    /// The frame of a command, and its sequence number.
    ///
    /// # Panics
    /// A command longer than a frame: a bug.
    pub fn frame(&mut self, command: &Command) -> (Vec<u8>, u8) {
        let sequence = self.sequence;
        self.sequence = sequence.wrapping_add(1);
        let mut frame = [0; MAX_FRAME];
        let length = encode(sequence, command, &mut frame).expect("every command fits");
        // A zero in front ends noise on the line, and tells a frame from a servo's packet.
        let is_first = matches!(command, Command::Hello { .. } | Command::Mode(_));
        let zero: &[u8] = if is_first { &[0] } else { &[] };
        ([zero, &frame[..length]].concat(), sequence)
    }
}
