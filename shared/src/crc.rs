//! Checks of the PC line: CRC-16 0xA2EB on every frame, CRC-32 (IEEE 802.3) on what must never be
//! mistaken.
//!
//! 0xA2EB keeps Hamming distance 6 up to 13 bytes and 4 up to 64 (Koopman & Chakravarty 2004,
//! "Cyclic redundancy code polynomial selection for embedded networks"). On the AVR constants live
//! in its 4096 bytes of RAM. The CRC-16's table, which every byte of the line needs, lies in flash
//! there; for CRC-32 it looks up half bytes, 64 bytes of a table instead of 1024.

#[cfg(target_arch = "avr")]
mod flash;

/// Check value before the first byte.
pub const START_16: u16 = 0xffff;

/// CRC-16 of 0xA2EB, most significant bit first, over `bytes`, going on from `crc`.
#[cfg(not(target_arch = "avr"))]
pub fn crc16(mut crc: u16, bytes: &[u8]) -> u16 {
    for byte in bytes {
        crc = byte16(crc, *byte);
    }
    crc
}
#[cfg(target_arch = "avr")]
pub use flash::crc16;

/// CRC-32 of IEEE 802.3 (as in zip and PNG) over `bytes`.
pub fn crc32(bytes: &[u8]) -> u32 {
    !extend32(u32::MAX, bytes)
}

/// Goes on with an unfinished CRC-32: starts from all ones, ends inverted.
pub fn extend32(mut crc: u32, bytes: &[u8]) -> u32 {
    for byte in bytes {
        crc = byte32(crc, *byte);
    }
    crc
}

/// `crc` after `bits` more zeros.
const fn bitwise16(mut crc: u16, bits: u8) -> u16 {
    let mut bit = 0;
    while bit < bits {
        let carry = crc & 0x8000 != 0;
        crc <<= 1;
        if carry {
            crc ^= 0xa2eb;
        }
        bit += 1;
    }
    crc
}

/// `crc` after `bits` more zeros.
const fn bitwise32(mut crc: u32, bits: u8) -> u32 {
    let mut bit = 0;
    while bit < bits {
        let carry = crc & 1 != 0;
        crc >>= 1;
        if carry {
            crc ^= 0xedb8_8320;
        }
        bit += 1;
    }
    crc
}

/// What eight more bits make of the upper byte alone.
const TABLE_16: [u16; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        table[byte] = bitwise16((byte as u16) << 8, 8);
        byte += 1;
    }
    table
};

#[cfg(not(target_arch = "avr"))]
fn byte16(crc: u16, byte: u8) -> u16 {
    crc << 8 ^ TABLE_16[usize::from((crc >> 8) as u8 ^ byte)]
}

#[cfg_attr(not(target_arch = "avr"), allow(dead_code))]
mod half_bytes {
    const TABLE_32: [u32; 16] = {
        let mut table = [0; 16];
        let mut half = 0;
        while half < 16 {
            table[half] = super::bitwise32(half as u32, 4);
            half += 1;
        }
        table
    };

    pub fn byte32(crc: u32, byte: u8) -> u32 {
        let crc = crc ^ byte as u32;
        let crc = crc >> 4 ^ TABLE_32[usize::from(crc as u8 & 15)];
        crc >> 4 ^ TABLE_32[usize::from(crc as u8 & 15)]
    }
}

#[cfg(not(target_arch = "avr"))]
mod whole_bytes {
    const TABLE_32: [u32; 256] = {
        let mut table = [0; 256];
        let mut byte = 0;
        while byte < 256 {
            table[byte] = super::bitwise32(byte as u32, 8);
            byte += 1;
        }
        table
    };

    pub fn byte32(crc: u32, byte: u8) -> u32 {
        crc >> 8 ^ TABLE_32[usize::from(crc as u8 ^ byte)]
    }
}

#[cfg(target_arch = "avr")]
use half_bytes::byte32;
#[cfg(not(target_arch = "avr"))]
use whole_bytes::byte32;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crc32_is_the_one_everybody_knows() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
        assert_eq!(crc32(b""), 0);
    }

    #[test]
    fn all_forms_are_the_bitwise_one() {
        for crc in (0..=u16::MAX).step_by(257) {
            let wide = u32::from(crc) << 16 ^ u32::from(crc).wrapping_mul(40_503);
            for byte in 0..=255 {
                let slow = bitwise16(crc ^ u16::from(byte) << 8, 8);
                assert_eq!(byte16(crc, byte), slow);
                let slow = bitwise32(wide ^ u32::from(byte), 8);
                assert_eq!(whole_bytes::byte32(wide, byte), slow);
                assert_eq!(half_bytes::byte32(wide, byte), slow);
            }
        }
    }

    /// The polynomial's own words: x^16 + x^15 + x^13 + x^9 + x^7 + x^6 + x^5 + x^3 + x + 1.
    #[test]
    fn crc16_of_a_single_one_is_the_polynomial() {
        assert_eq!(crc16(0, &[1]), 0xa2eb);
    }

    /// From all ones, zeros before a frame's content are not mistaken for none.
    #[test]
    fn crc16_begins_with_ones() {
        assert_eq!(crc16(START_16, b"123456789"), 0x9db1);
        assert_ne!(crc16(START_16, &[0]), crc16(START_16, &[0, 0]));
    }
}
