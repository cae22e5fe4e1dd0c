//! The CRC-16's table in the AVR's flash, where it takes no RAM.
#![allow(unsafe_code)]

use core::arch::asm;

#[unsafe(link_section = ".progmem.data.crc16")]
static TABLE: [u16; 256] = super::TABLE_16;

/// The word for this byte.
#[inline(always)]
pub fn word_16(byte: u8) -> u16 {
    let address = (&raw const TABLE)
        .cast::<u16>()
        .wrapping_add(usize::from(byte));
    let (low, high): (u8, u8);
    // SAFETY: reads flash within TABLE, which the linker keeps in the first 64 KiB.
    unsafe {
        asm!(
            "lpm {low}, Z+",
            "lpm {high}, Z",
            low = out(reg) low,
            high = out(reg) high,
            inout("Z") address => _,
            options(pure, nomem, nostack, preserves_flags)
        );
    }
    u16::from_le_bytes([low, high])
}
