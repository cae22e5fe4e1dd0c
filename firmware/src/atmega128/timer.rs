//! Timer 1 makes the tick, timer 3 is the clock.

use crate::design::{CLOCK_PER_US, TICK_US};
use avr_device::atmega128a::Peripherals;

const BY_8: u8 = 0b010;
const CLEAR_ON_COMPARE: u8 = 1 << 3;
const TICK: u8 = 1 << 4; // OCF1A
const TOP: u16 = TICK_US * CLOCK_PER_US - 1;

/// Both run, without interrupts; all other timers stop.
pub fn start(r: &Peripherals) {
    // SAFETY: any bits are valid in these registers.
    unsafe {
        r.TC1.timsk().write(|w| w.bits(0));
        r.TC3.etimsk().write(|w| w.bits(0));
        r.TC0.tccr0().write(|w| w.bits(0));
        r.TC2.tccr2().write(|w| w.bits(0));
        r.TC1.tccr1a().write(|w| w.bits(0));
        r.TC1.tccr1b().write(|w| w.bits(0));
        r.TC1.tcnt1().write(|w| w.bits(0));
        r.TC1.ocr1a().write(|w| w.bits(TOP));
        r.TC1.tifr().write(|w| w.bits(TICK));
        r.TC1.tccr1b().write(|w| w.bits(CLEAR_ON_COMPARE | BY_8));
        r.TC3.tccr3a().write(|w| w.bits(0));
        r.TC3.tccr3b().write(|w| w.bits(BY_8));
    }
}

/// Counts of timer 3. No interrupt touches a 16-bit register, so the two halves belong together.
#[inline(always)]
pub fn clock(r: &Peripherals) -> u16 {
    r.TC3.tcnt3().read().bits()
}

/// Whether a period has passed since the last time.
pub fn tick_due(r: &Peripherals) -> bool {
    let due = r.TC1.tifr().read().bits() & TICK != 0;
    if due {
        // SAFETY: writing a one clears the flag.
        unsafe { r.TC1.tifr().write(|w| w.bits(TICK)) };
    }
    due
}
