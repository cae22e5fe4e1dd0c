//! How many damaged frames pass: exhaustively, for what can be counted out.

use handstand_shared::frame::{Decoder, MAX_FRAME, decode, encode};
use handstand_shared::message::{Command, Message as _, decode as decode_message};
use rand::{Rng as _, RngCore as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// What was tried and what passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FrameTally {
    /// Error patterns, or random bytes.
    pub tried: u64,
    /// Accepted, with content that was never sent.
    pub wrong: u64,
    /// Of those, frames that would have moved torque or gains.
    pub critical: u64,
}

impl FrameTally {
    fn and(self, other: FrameTally) -> FrameTally {
        FrameTally {
            tried: self.tried + other.tried,
            wrong: self.wrong + other.wrong,
            critical: self.critical + other.critical,
        }
    }
}

/// A frame of `wire` bytes, its final zero not counted.
fn frame(wire: usize, rng: &mut ChaCha8Rng) -> Vec<u8> {
    // One byte is COBS's, three are the check's.
    let mut body = vec![0; wire - 4];
    rng.fill_bytes(&mut body);
    let mut out = [0; MAX_FRAME];
    let length = encode(&body, &mut out).expect("short enough");
    out[..length - 1].to_vec()
}

/// Every pattern of 1 to `most` flipped bits on a frame of 12 bytes.
pub fn patterns(most: usize, seed: u64) -> FrameTally {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    flips(&frame(12, &mut rng), most)
}

/// Every flip of 1 to 3 bits, the zeros at both ends included, on frames of `wire` bytes with
/// `payloads` random bodies.
pub fn bit_flips(wire: usize, payloads: usize, seed: u64) -> FrameTally {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let frames: Vec<Vec<u8>> = (0..payloads).map(|_| frame(wire, &mut rng)).collect();
    let tally = |frame: &Vec<u8>| {
        let mut whole = frame.clone();
        whole.push(0);
        flips(&whole, 3)
    };
    frames
        .par_iter()
        .map(tally)
        .reduce(FrameTally::default, FrameTally::and)
}

/// All patterns of up to `most` flips on these bytes, each read as a stream.
fn flips(bytes: &[u8], most: usize) -> FrameTally {
    let bits = bytes.len() * 8;
    let of_first = |first: usize| {
        let mut line = bytes.to_vec();
        let mut tally = FrameTally::default();
        line[first / 8] ^= 1 << (first % 8);
        deeper(bytes, &mut line, first + 1, most - 1, &mut tally);
        tally
    };
    (0..bits)
        .into_par_iter()
        .map(of_first)
        .reduce(FrameTally::default, FrameTally::and)
}

fn deeper(sent: &[u8], line: &mut [u8], from: usize, left: usize, tally: &mut FrameTally) {
    tally.tried += 1;
    tally.wrong += wrong(sent, line);
    if left == 0 {
        return;
    }
    for bit in from..line.len() * 8 {
        line[bit / 8] ^= 1 << (bit % 8);
        deeper(sent, line, bit + 1, left - 1, tally);
        line[bit / 8] ^= 1 << (bit % 8);
    }
}

/// How many frames the damaged line holds that are accepted; the one sent is damaged, so none may
/// be.
fn wrong(sent: &[u8], line: &[u8]) -> u64 {
    debug_assert_ne!(sent, line);
    // What lies between zeros is read as a frame, as is what the next frame's zero ends.
    let pieces = line
        .split(|byte| *byte == 0)
        .filter(|piece| !piece.is_empty());
    let accepted = pieces.filter(|piece| {
        let mut copy = [0; MAX_FRAME];
        let Some(copy) = copy.get_mut(..piece.len()) else {
            return false;
        };
        copy.copy_from_slice(piece);
        decode(copy).is_ok()
    });
    // The frame itself, cut out whole by a flip in the zero behind it alone, is the one that was
    // sent.
    let whole = sent.strip_suffix(&[0]).unwrap_or(sent);
    accepted.filter(|piece| *piece != whole).count() as u64
}

/// Feeds random bytes to the decoder and counts what it takes for messages.
pub fn random_bytes(count: u64, seed: u64) -> FrameTally {
    const BLOCK: u64 = 1 << 20;
    let blocks = count.div_ceil(BLOCK);
    let of_block = |block: u64| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(block);
        let mut decoder = Decoder::default();
        let mut tally = FrameTally::default();
        let mut bytes = vec![0; BLOCK.min(count - block * BLOCK) as usize];
        rng.fill_bytes(&mut bytes);
        // Half of the blocks have many zeros, which end many short frames.
        if block % 2 == 1 {
            bytes
                .iter_mut()
                .filter(|byte| **byte < 16)
                .for_each(|byte| *byte = 0);
        }
        for byte in &bytes {
            if let Some(Ok(body)) = decoder.push(*byte) {
                tally.wrong += 1;
                let message = decode_message::<Command>(body);
                tally.critical += u64::from(message.is_ok_and(|m| m.message.is_critical()));
            }
        }
        tally.tried += bytes.len() as u64;
        tally
    };
    (0..blocks)
        .into_par_iter()
        .map(of_block)
        .reduce(FrameTally::default, FrameTally::and)
}

/// Random garbage, then frames: how many frames are lost before one is read, at worst.
pub fn resynchronised(trials: usize, seed: u64) -> usize {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut worst = 0;
    for _ in 0..trials {
        let mut decoder = Decoder::default();
        let mut garbage = vec![0; rng.random_range(0..200)];
        rng.fill_bytes(&mut garbage);
        for byte in &garbage {
            let _ = decoder.push(*byte);
        }
        let wire = rng.random_range(5..MAX_FRAME);
        let mut sent = frame(wire, &mut rng);
        sent.push(0);
        let lost = (0..10).take_while(|_| {
            !sent
                .iter()
                .any(|byte| matches!(decoder.push(*byte), Some(Ok(_))))
        });
        worst = worst.max(lost.count());
    }
    worst
}
