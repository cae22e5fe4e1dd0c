//! Elements of a MATLAB file, version 5: a tag with type and length, then data, to 8 bytes.

use super::number::MatNumber;
use crate::table::Broken;

/// Types of data.
pub(super) mod kind {
    pub const I8: u32 = 1;
    pub const U8: u32 = 2;
    pub const I16: u32 = 3;
    pub const U16: u32 = 4;
    pub const I32: u32 = 5;
    pub const U32: u32 = 6;
    pub const F32: u32 = 7;
    pub const F64: u32 = 9;
    pub const I64: u32 = 12;
    pub const U64: u32 = 13;
    pub const MATRIX: u32 = 14;
    pub const COMPRESSED: u32 = 15;
}

/// Reads elements one after the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Elements<'a> {
    pub bytes: &'a [u8],
    pub big_endian: bool,
}

/// One element.
#[derive(Debug, Clone, Copy)]
pub(super) struct MatElement<'a> {
    pub kind: u32,
    pub data: &'a [u8],
    big_endian: bool,
}

impl<'a> Elements<'a> {
    /// The next element; none at the end.
    ///
    /// # Errors
    /// One that is longer than what is left.
    pub fn next(&mut self) -> Result<Option<MatElement<'a>>, Broken> {
        // Fewer bytes than a tag are filling.
        let Some(tag) = self.bytes.get(..8) else {
            return Ok(None);
        };
        let first = word(&tag[..4], self.big_endian);
        let (kind, length, from): (u32, usize, usize) = match first >> 16 {
            0 => (first, word(&tag[4..], self.big_endian) as usize, 8),
            // Up to four bytes stand in the tag itself.
            length => (first & 0xffff, length as usize, 4),
        };
        if from == 4 && length > 4 {
            return Err("a short element is too long");
        }
        let end = from
            .checked_add(length)
            .ok_or("an element is longer than the file")?;
        let data = self
            .bytes
            .get(from..end)
            .ok_or("it ends in the middle of an element")?;
        // Compressed elements are not filled up.
        let whole = match (from, kind) {
            (4, _) => 8,
            (_, kind::COMPRESSED) => end,
            _ => end.next_multiple_of(8).min(self.bytes.len()),
        };
        self.bytes = &self.bytes[whole..];
        Ok(Some(MatElement {
            kind,
            data,
            big_endian: self.big_endian,
        }))
    }

    /// The next element.
    ///
    /// # Errors
    /// As [`Elements::next`], and the end.
    pub fn required(&mut self) -> Result<MatElement<'a>, Broken> {
        self.next()?.ok_or("a variable lacks a part")
    }
}

impl<'a> MatElement<'a> {
    /// The elements within.
    pub fn within(&self) -> Elements<'a> {
        Elements {
            bytes: self.data,
            big_endian: self.big_endian,
        }
    }

    /// Text of one byte a letter.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(self.data)
            .trim_end_matches('\0')
            .to_string()
    }

    /// Whole numbers of 32 bits.
    pub fn words(&self) -> Vec<u32> {
        self.data
            .chunks_exact(4)
            .map(|four| word(four, self.big_endian))
            .collect()
    }

    /// Its numbers; none of what holds no numbers.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        let number = match self.kind {
            kind::I8 => MatNumber::I8,
            kind::U8 => MatNumber::U8,
            kind::I16 => MatNumber::I16,
            kind::U16 => MatNumber::U16,
            kind::I32 => MatNumber::I32,
            kind::U32 => MatNumber::U32,
            kind::F32 => MatNumber::F32,
            kind::F64 => MatNumber::F64,
            kind::I64 => MatNumber::I64,
            kind::U64 => MatNumber::U64,
            _ => return None,
        };
        Some(number.all(self.data, self.big_endian))
    }
}

fn word(bytes: &[u8], big_endian: bool) -> u32 {
    let mut four = [0; 4];
    four.copy_from_slice(bytes);
    if big_endian {
        u32::from_be_bytes(four)
    } else {
        u32::from_le_bytes(four)
    }
}
