//! The CRC of Protocol 2.0: polynomial 0x8005, start 0, most significant bit first, nothing
//! inverted (CRC-16/UMTS, also called BUYPASS).

const POLYNOMIAL: u16 = 0x8005;

const TABLE: [u16; 256] = table();

const fn table() -> [u16; 256] {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut crc = (byte as u16) << 8;
        let mut bit = 0;
        while bit < 8 {
            let carry = crc & 0x8000 != 0;
            crc <<= 1;
            if carry {
                crc ^= POLYNOMIAL;
            }
            bit += 1;
        }
        table[byte] = crc;
        byte += 1;
    }
    table
}

/// CRC over `bytes`, going on from `crc`, which is 0 at the first byte.
pub fn crc16(crc: u16, bytes: &[u8]) -> u16 {
    bytes.iter().fold(crc, |crc, byte| {
        let at = usize::from((crc >> 8) as u8 ^ byte);
        crc << 8 ^ TABLE[at]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_check_value_and_table() {
        assert_eq!(crc16(0, b"123456789"), 0xfee8);
        let entries = [1, 2, 0x80, 0xff].map(|at| TABLE[at]);
        assert_eq!(entries, [0x8005, 0x800f, 0x8303, 0x0202]);
        let sum: u32 = TABLE.iter().map(|entry| u32::from(*entry)).sum();
        assert_eq!(sum, 0x41_ff80);
    }
}
