//! Checks of the PC line: CRC-16 0xA2EB on every frame, CRC-32 (IEEE 802.3) on what must never be mistaken.
//!
//! 0xA2EB keeps Hamming distance 6 up to 13 bytes and 4 up to 64 (Koopman & Chakravarty 2004, "Cyclic redundancy code
//! polynomial selection for embedded networks"). The AVR computes bit by bit: a table would cost it 512 of its 4096
//! bytes of RAM. The PC looks bytes up; both are the same function, and tested to be.

/// Check value before the first byte.
pub const START_16: u16 = 0xffff;

/// CRC-16 of 0xA2EB, most significant bit first, over `bytes`, going on from `crc`.
pub fn crc16(crc: u16, bytes: &[u8]) -> u16 {
    bytes.iter().fold(crc, |crc, &byte| crc16_byte(crc, byte))
}

/// As [`crc16`], of one byte.
#[cfg(target_arch = "avr")]
pub fn crc16_byte(crc: u16, byte: u8) -> u16 {
    bitwise16(crc ^ u16::from(byte) << 8)
}

/// As [`crc16`], of one byte.
#[cfg(not(target_arch = "avr"))]
pub fn crc16_byte(crc: u16, byte: u8) -> u16 {
    const TABLE: [u16; 256] = {
        let mut table = [0; 256];
        let mut byte = 0;
        while byte < 256 {
            table[byte] = bitwise16((byte as u16) << 8);
            byte += 1;
        }
        table
    };
    crc << 8 ^ TABLE[usize::from((crc >> 8) as u8 ^ byte)]
}

const fn bitwise16(mut crc: u16) -> u16 {
    let mut bit = 0;
    while bit < 8 {
        crc = if crc & 0x8000 == 0 {
            crc << 1
        } else {
            crc << 1 ^ 0xa2eb
        };
        bit += 1;
    }
    crc
}

/// CRC-32 of IEEE 802.3 (as in zip and PNG) over `bytes`.
pub fn crc32(bytes: &[u8]) -> u32 {
    !extend32(u32::MAX, bytes)
}

/// Goes on with an unfinished CRC-32: starts from all ones, ends inverted.
pub fn extend32(crc: u32, bytes: &[u8]) -> u32 {
    bytes.iter().fold(crc, |crc, &byte| {
        let mut crc = crc ^ u32::from(byte);
        for _ in 0..8 {
            crc = if crc & 1 == 0 {
                crc >> 1
            } else {
                crc >> 1 ^ 0xedb8_8320
            };
        }
        crc
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crc32_is_the_one_everybody_knows() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
        assert_eq!(crc32(b""), 0);
    }

    #[test]
    fn the_table_is_the_bitwise_form() {
        for crc in (0..=u16::MAX).step_by(257) {
            for byte in 0..=255 {
                assert_eq!(crc16_byte(crc, byte), bitwise16(crc ^ u16::from(byte) << 8));
            }
        }
    }

    /// The polynomial's own words: x^16 + x^15 + x^13 + x^9 + x^7 + x^6 + x^5 + x^3 + x + 1.
    #[test]
    fn crc16_of_a_single_one_is_the_polynomial() {
        assert_eq!(crc16(0, &[1]), 0xa2eb);
    }
}
