//! The mark behind a program for the CM-5: what it is, how long, and whether it is whole.
//!
//! `cargo xtask firmware` writes it behind the raw binary; it goes into flash with it. Whoever
//! flashes checks it first: another AVR program, or a file cut short, is none of ours.

use crate::crc::crc32;

/// Bytes of the mark: [`MAGIC`], the program's length and its CRC-32, little-endian.
pub const MARK: usize = 16;
/// What the mark begins with.
pub const MAGIC: [u8; 8] = *b"Handst\x00\x01";

/// Why bytes are no whole program of ours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageFault {
    /// They do not end with a mark.
    NoMark,
    /// The mark is of a program of another length.
    Length {
        /// What the mark says, bytes.
        marked: u32,
    },
    /// The program has another CRC-32 than the mark says.
    Check,
}

/// The mark of a program.
pub fn mark(program: &[u8]) -> [u8; MARK] {
    let mut mark = [0; MARK];
    let bytes = (MAGIC.into_iter())
        .chain((program.len() as u32).to_le_bytes())
        .chain(crc32(program).to_le_bytes());
    mark.iter_mut()
        .zip(bytes)
        .for_each(|(slot, byte)| *slot = byte);
    mark
}

/// The program in front of its mark, if both are whole.
pub fn program(image: &[u8]) -> Result<&[u8], ImageFault> {
    let (program, found) = image.split_last_chunk::<MARK>().ok_or(ImageFault::NoMark)?;
    let [m0, m1, m2, m3, m4, m5, m6, m7, l0, l1, l2, l3, ..] = *found;
    if [m0, m1, m2, m3, m4, m5, m6, m7] != MAGIC {
        return Err(ImageFault::NoMark);
    }
    let marked = u32::from_le_bytes([l0, l1, l2, l3]);
    if marked as usize != program.len() {
        return Err(ImageFault::Length { marked });
    }
    if mark(program) == *found {
        Ok(program)
    } else {
        Err(ImageFault::Check)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    #[test]
    fn a_program_is_found_whole_or_not_at_all() {
        let text: Vec<u8> = (0..200).collect();
        let mut image = text.clone();
        image.extend(mark(&text));
        assert_eq!(image[200..212], *b"Handst\x00\x01\xc8\x00\x00\x00");
        assert_eq!(program(&image), Ok(&text[..]));
        for length in 0..image.len() {
            assert_eq!(program(&image[..length]), Err(ImageFault::NoMark));
        }
        assert_eq!(
            program(&image[1..]),
            Err(ImageFault::Length { marked: 200 })
        );
        for at in 0..image.len() {
            image[at] ^= 4;
            assert!(program(&image).is_err(), "byte {at}");
            image[at] ^= 4;
        }
        image[0] ^= 1;
        assert_eq!(program(&image), Err(ImageFault::Check));
    }
}
