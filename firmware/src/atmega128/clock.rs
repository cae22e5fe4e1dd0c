//! What follows from the CM-5's crystal: the clock's divider and the baud registers.

use crate::design::{BUS_BAUD, CLOCK_PER_US, LINK_BAUD};

/// Crystal of the CM-5, Hz.
const CPU_HZ: u32 = 16_000_000;

/// Timers 1 and 3 count every so many cycles: the prescaler that `timer` chooses.
const DIVIDER: u32 = 8;
const _: () = assert!(CPU_HZ / DIVIDER == CLOCK_PER_US as u32 * 1_000_000);

/// Baud register of the PC line at double speed: 16 MHz / 8 / 57600 - 1 = 33.7, so 34, 0.8 % slow.
pub const LINK_UBRR: u8 = ubrr(LINK_BAUD);

/// Baud register of the servo bus at double speed: 16 MHz / 8 / 1 M - 1 = 1, exact.
pub const BUS_UBRR: u8 = ubrr(BUS_BAUD);

/// The baud register at double speed that comes closest; a speed that no register below 256 makes
/// within 2 % does not compile.
const fn ubrr(baud: u32) -> u8 {
    let register = (CPU_HZ / 8 + baud / 2) / baud - 1;
    let made = CPU_HZ / 8 / (register + 1);
    assert!(register < 256 && made.abs_diff(baud) * 100 < 2 * baud);
    register as u8
}
