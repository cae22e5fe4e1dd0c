//! Frames of the PC line: `COBS(body)`, three check bytes, `00`.
//!
//! COBS (Cheshire & Baker 1999) leaves no zero inside, so a zero always ends a frame and one
//! frame's damage stays in it. The CRC-16 runs over the *stuffed* bytes as they lie on the line:
//! over the body alone, one flipped COBS byte would move bytes about and the code's Hamming
//! distance would be lost. Its 16 bits are sent as `1ccccccc 1ccccccc 1sssss cc`, which are never
//! zero; the fixed bits are checked too.
//!
//! A byte may be kept off the line: the body's bytes are combined with the mask `s` * 8 by an
//! exclusive or before they are stuffed, and the sender chooses an `s` that leaves no such byte.
//! The CRC runs over `s` as over a byte in front, so it is as safe as the rest; with `s` = 0 a
//! frame is what it would be without masks.

use crate::crc::{START_16, crc16};

/// Longest body, bytes. With stuffing and check it stays below 64, where the CRC keeps Hamming
/// distance 4.
pub const MAX_BODY: usize = 59;
/// Longest frame, the final zero included.
pub const MAX_FRAME: usize = wire_length(MAX_BODY);
const CHECK: usize = 3;

/// Bytes on the line of a frame with this body.
pub const fn wire_length(body: usize) -> usize {
    body + 1 + CHECK + 1
}

/// Why bytes between two zeros are no frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameError {
    /// Fewer or more bytes than a frame has.
    Length,
    /// The check does not fit.
    Check,
    /// The check fits, but the stuffing is none.
    Stuffing,
}

/// Masks there are.
const MASKS: u8 = 32;

/// Writes the frame of `body` into `out`; its length, or nothing if the body is too long.
pub fn encode(body: &[u8], out: &mut [u8; MAX_FRAME]) -> Option<usize> {
    encode_masked(0, body, out)
}

/// The same without this byte, other than zero and below 128, between the zeros of the line. There
/// are two exceptions. A body made for it leaves none of the masks: its bytes would have to be 32
/// different ones. And a body of `byte` - 1 bytes, none of which a mask makes zero, is stuffed with
/// `byte` in front.
pub fn encode_without(byte: u8, body: &[u8], out: &mut [u8; MAX_FRAME]) -> Option<usize> {
    for selector in 0..MASKS {
        let length = encode_masked(selector, body, out)?;
        if out
            .get(..length)
            .is_some_and(|frame| !frame.contains(&byte))
        {
            return Some(length);
        }
    }
    encode(body, out)
}

/// The same where the body already lies in `out`, behind its first byte: a copy of it takes the AVR
/// time and stack.
pub fn encode_in_place(length: usize, out: &mut [u8; MAX_FRAME]) -> Option<usize> {
    stuff(0, length, out)
}

fn encode_masked(selector: u8, body: &[u8], out: &mut [u8; MAX_FRAME]) -> Option<usize> {
    let slots = out.get_mut(1..=body.len())?;
    (slots.iter_mut().zip(body)).for_each(|(slot, byte)| *slot = *byte ^ mask(selector));
    stuff(selector, body.len(), out)
}

/// Stuffs a masked body in its place, and ends its frame.
fn stuff(selector: u8, length: usize, out: &mut [u8; MAX_FRAME]) -> Option<usize> {
    if length > MAX_BODY {
        return None;
    }
    let stuffed = length + 1;
    let (first, body) = out.get_mut(..stuffed)?.split_first_mut()?;
    // From the back: how far the next zero is, is then known.
    let mut distance = 1;
    for byte in body.iter_mut().rev() {
        if *byte == 0 {
            *byte = distance;
            distance = 1;
        } else {
            distance += 1;
        }
    }
    *first = distance;
    let check = check_bytes(selector, out.get(..stuffed)?);
    let tail = out.get_mut(stuffed..stuffed + CHECK + 1)?;
    let ending = check.iter().chain(&[0]);
    tail.iter_mut()
        .zip(ending)
        .for_each(|(slot, byte)| *slot = *byte);
    Some(stuffed + CHECK + 1)
}

/// The body of a frame given without its final zero; it is unstuffed in place.
pub fn decode(frame: &mut [u8]) -> Result<&[u8], FrameError> {
    let Some(stuffed) = frame
        .len()
        .checked_sub(CHECK)
        .filter(|n| (1..=MAX_BODY + 1).contains(n))
    else {
        return Err(FrameError::Length);
    };
    let (stuffed, check) = frame
        .split_at_mut_checked(stuffed)
        .ok_or(FrameError::Length)?;
    let selector = check.last().map_or(0, |last| last >> 2 & (MASKS - 1));
    if check_bytes(selector, stuffed) != check {
        return Err(FrameError::Check);
    }
    let mask = mask(selector);
    let (&mut first, body) = stuffed.split_first_mut().ok_or(FrameError::Length)?;
    let mut until_zero = first;
    for byte in body.iter_mut() {
        until_zero = until_zero.wrapping_sub(1);
        match (until_zero, *byte) {
            (_, 0) => return Err(FrameError::Stuffing),
            (0, next) => {
                until_zero = next;
                *byte = mask;
            }
            (_, other) => *byte = other ^ mask,
        }
    }
    match until_zero {
        1 => Ok(body),
        _ => Err(FrameError::Stuffing),
    }
}

fn mask(selector: u8) -> u8 {
    selector << 3
}

fn check_bytes(selector: u8, stuffed: &[u8]) -> [u8; CHECK] {
    // A CRC is linear: this is the start from which the selector as a first byte leads on, shifted
    // so that 0 leads to the start of a frame without masks.
    let start = START_16 ^ crc16(0, &[selector]);
    let crc = crc16(start, stuffed);
    [
        0x80 | (crc >> 9) as u8,
        0x80 | (crc >> 2) as u8,
        0x80 | selector << 2 | (crc & 3) as u8,
    ]
}

/// Finds frames in a stream of bytes.
#[derive(Debug, Clone)]
pub struct Decoder {
    bytes: [u8; MAX_FRAME],
    /// Bytes since the last zero; more than fit means that they can be no frame.
    used: u8,
}

impl Default for Decoder {
    fn default() -> Self {
        Decoder {
            bytes: [0; MAX_FRAME],
            used: 0,
        }
    }
}

impl Decoder {
    /// Takes the next byte; the body, or what is wrong, when it ends a frame. Repeated zeros are
    /// idle line.
    pub fn push(&mut self, byte: u8) -> Option<Result<&[u8], FrameError>> {
        if byte != 0 {
            if let Some(slot) = self.bytes.get_mut(usize::from(self.used)) {
                *slot = byte;
                self.used += 1;
            }
            return None;
        }
        let used = usize::from(core::mem::take(&mut self.used));
        match self.bytes.get_mut(..used) {
            None | Some([]) => None,
            Some(frame) => Some(decode(frame)),
        }
    }

    /// Forgets what was collected.
    pub fn reset(&mut self) {
        self.used = 0;
    }

    /// Whether the line is between two frames.
    pub fn is_idle(&self) -> bool {
        self.used == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn framed(body: &[u8]) -> ([u8; MAX_FRAME], usize) {
        // What lay there before is no part of it.
        let mut out = [0xa5; MAX_FRAME];
        let length = encode(body, &mut out).unwrap();
        assert_eq!(length, wire_length(body.len()));
        (out, length)
    }

    #[test]
    fn a_frame_literally() {
        let (out, length) = framed(&[0x11, 0x00, 0x22]);
        let crc = crc16(START_16, &[2, 0x11, 2, 0x22]);
        let check = [
            0x80 | (crc >> 9) as u8,
            0x80 | (crc >> 2) as u8 & 0x7f,
            0x80 | crc as u8 & 3,
        ];
        assert_eq!(&out[..4], [2, 0x11, 2, 0x22]);
        assert_eq!(&out[4..length], [check[0], check[1], check[2], 0]);
    }

    #[test]
    fn a_frame_without_a_byte_literally() {
        // `#` is 0x23; mask 8 of selector 1 makes 0x2b of it, and a zero of 8.
        let mut out = [0; MAX_FRAME];
        let length = encode_without(b'#', &[0x23, 0x08, 0x11], &mut out).unwrap();
        let crc = crc16(START_16 ^ crc16(0, &[1]), &[2, 0x2b, 2, 0x19]);
        assert_eq!(
            crc16(START_16, &[2, 0x2b, 2, 0x19]) ^ crc,
            crc16(0, &[1, 0, 0, 0, 0])
        );
        let check = [
            0x80 | (crc >> 9) as u8,
            0x80 | (crc >> 2) as u8,
            0x84 | (crc & 3) as u8,
        ];
        assert_eq!(&out[..4], [2, 0x2b, 2, 0x19]);
        assert_eq!(&out[4..length], [check[0], check[1], check[2], 0]);
        // Nothing to avoid: as without masks.
        let length = encode_without(b'#', &[0x11, 0x00, 0x22], &mut out).unwrap();
        assert_eq!(out[..length], framed(&[0x11, 0x00, 0x22]).0[..length]);
    }

    /// One or two wrong bits anywhere, those that choose the mask among them.
    #[test]
    fn a_wrong_mask_is_noticed() {
        let mut out = [0; MAX_FRAME];
        let length = encode_without(b'#', &[0x23, 0x08, 0x11, 0], &mut out).unwrap() - 1;
        for first in 0..length * 8 {
            for second in 0..=first {
                let mut damaged = out;
                damaged[first / 8] ^= 1 << (first % 8);
                if second < first {
                    damaged[second / 8] ^= 1 << (second % 8);
                }
                assert!(decode(&mut damaged[..length]).is_err(), "{first} {second}");
            }
        }
    }

    #[test]
    fn too_long_a_body_is_not_framed_and_too_long_a_frame_not_accepted() {
        assert_eq!(encode(&[1; MAX_BODY + 1], &mut [0; MAX_FRAME]), None);
        let mut decoder = Decoder::default();
        for _ in 0..1000 {
            assert_eq!(decoder.push(7), None);
        }
        assert_eq!(decoder.push(0), Some(Err(FrameError::Length)));
        let (out, length) = framed(&[1; MAX_BODY]);
        let bodies = out[..length]
            .iter()
            .filter_map(|b| decoder.push(*b).map(|r| r.map(<[u8]>::len)));
        assert!(bodies.eq([Ok(MAX_BODY)]));
    }

    proptest! {
        #[test]
        fn a_byte_is_kept_off_the_line(body in proptest::collection::vec(prop_oneof![Just(0u8), Just(b'#'), any::<u8>()], 0..=MAX_BODY)) {
            let mut out = [0; MAX_FRAME];
            let length = encode_without(b'#', &body, &mut out).unwrap();
            prop_assert!(body.len() + 1 == usize::from(b'#') || !out[..length].contains(&b'#'));
            prop_assert_eq!(decode(&mut out[..length - 1]), Ok(&body[..]));
        }

        #[test]
        fn every_body_survives(body in proptest::collection::vec(prop_oneof![Just(0u8), any::<u8>()], 0..=MAX_BODY)) {
            let (out, length) = framed(&body);
            prop_assert!(!out[..length - 1].contains(&0));
            let mut decoder = Decoder::default();
            for byte in &out[..length - 1] {
                prop_assert_eq!(decoder.push(*byte), None);
            }
            prop_assert_eq!(decoder.push(0), Some(Ok(&body[..])));
        }

        #[test]
        fn any_bytes_are_taken_and_the_second_frame_after_them_is_found(garbage in proptest::collection::vec(any::<u8>(), 0..300), body in proptest::collection::vec(any::<u8>(), 1..=MAX_BODY)) {
            let mut decoder = Decoder::default();
            for byte in garbage {
                decoder.push(byte);
            }
            let (out, length) = framed(&body);
            for byte in &out[..length] {
                decoder.push(*byte);
            }
            let last = out[..length].iter().filter_map(|b| decoder.push(*b).map(|r| r == Ok(&body[..]))).last();
            prop_assert_eq!(last, Some(true));
        }
    }
}
