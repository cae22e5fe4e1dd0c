//! Numbers of a few bytes, as the footer of a Parquet file and its pages hold them.

use crate::table::Broken;

/// Takes a whole number off the front: seven bits a byte, the lowest first.
///
/// # Errors
/// One that is cut short, or longer than 64 bits.
pub(super) fn varint(left: &mut &[u8]) -> Result<u64, Broken> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let (byte, rest) = left.split_first().ok_or("a number is cut short")?;
        *left = rest;
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Ok(value);
        }
    }
    Err("a number is longer than 64 bits")
}

/// Takes a whole number with a sign, which is its lowest bit.
///
/// # Errors
/// As [`varint`].
pub(super) fn zigzag(left: &mut &[u8]) -> Result<i64, Broken> {
    let value = varint(left)?;
    Ok((value >> 1) as i64 ^ -((value & 1) as i64))
}
