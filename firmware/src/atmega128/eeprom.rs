//! The EEPROM, byte by byte.

use avr_device::atmega128a::Peripherals;

const READ: u8 = 1;
const WRITE: u8 = 1 << 1;
const MASTER: u8 = 1 << 2;

/// Whether no write is going on.
pub fn is_ready(r: &Peripherals) -> bool {
    r.EEPROM.eecr().read().bits() & WRITE == 0
}

/// Reads a byte, after a write that may still be going on (at most 8.5 ms).
pub fn read(r: &Peripherals, address: u16) -> u8 {
    for _ in 0..50_000u16 {
        if is_ready(r) {
            break;
        }
    }
    // SAFETY: plain bits.
    unsafe {
        r.EEPROM.eear().write(|w| w.bits(address));
        r.EEPROM.eecr().write(|w| w.bits(READ));
    }
    r.EEPROM.eedr().read().bits()
}

/// Begins to write a byte; false if one is still being written.
pub fn write(r: &Peripherals, address: u16, byte: u8) -> bool {
    if !is_ready(r) {
        return false;
    }
    avr_device::interrupt::free(|_| {
        // SAFETY: WRITE must follow MASTER within four cycles; interrupts are off.
        unsafe {
            r.EEPROM.eear().write(|w| w.bits(address));
            r.EEPROM.eedr().write(|w| w.bits(byte));
            r.EEPROM.eecr().write(|w| w.bits(MASTER));
            r.EEPROM.eecr().write(|w| w.bits(MASTER | WRITE));
        }
    });
    true
}
