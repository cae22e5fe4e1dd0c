//! Numbers of a MATLAB variable, as both versions of its files store them.

use crate::table::{from_integers, from_unsigned};

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MatNumber {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl MatNumber {
    /// All numbers that the bytes hold; whole numbers that a double cannot hold count from the
    /// first.
    pub fn all(self, data: &[u8], big_endian: bool) -> Vec<f64> {
        match self {
            MatNumber::I8 => each(data, big_endian, |b| f64::from(i8::from_le_bytes(b))),
            MatNumber::U8 => each(data, big_endian, |b| f64::from(u8::from_le_bytes(b))),
            MatNumber::I16 => each(data, big_endian, |b| f64::from(i16::from_le_bytes(b))),
            MatNumber::U16 => each(data, big_endian, |b| f64::from(u16::from_le_bytes(b))),
            MatNumber::I32 => each(data, big_endian, |b| f64::from(i32::from_le_bytes(b))),
            MatNumber::U32 => each(data, big_endian, |b| f64::from(u32::from_le_bytes(b))),
            MatNumber::I64 => from_integers(&each(data, big_endian, i64::from_le_bytes)),
            MatNumber::U64 => from_unsigned(&each(data, big_endian, u64::from_le_bytes)),
            MatNumber::F32 => each(data, big_endian, |b| f64::from(f32::from_le_bytes(b))),
            MatNumber::F64 => each(data, big_endian, f64::from_le_bytes),
        }
    }
}

fn each<const N: usize, T>(data: &[u8], big_endian: bool, of: fn([u8; N]) -> T) -> Vec<T> {
    let (numbers, _) = data.as_chunks::<N>();
    let one = |bytes: &[u8; N]| {
        let mut bytes = *bytes;
        if big_endian {
            bytes.reverse();
        }
        of(bytes)
    };
    numbers.iter().map(one).collect()
}
