//! The watchdog, and why the controller started.

use avr_device::atmega128a::Peripherals;
use handstand_shared::message::ResetCause;

const CHANGE: u8 = 1 << 4;
const ENABLE: u8 = 1 << 3;
/// 32768 cycles of its own oscillator: 28 ms at 5 V.
const AFTER_30_MS: u8 = 0b001;

/// From now on a tick must be completed every 30 ms. It may be on already, after a reset by it.
pub fn start(r: &Peripherals) {
    avr_device::asm::wdr();
    // SAFETY: the data sheet's sequence; the second write must follow within four cycles, and
    // interrupts are off.
    unsafe {
        r.WDT.wdtcr().write(|w| w.bits(CHANGE | ENABLE));
        r.WDT.wdtcr().write(|w| w.bits(ENABLE | AFTER_30_MS));
    }
    // The new time counts from here.
    avr_device::asm::wdr();
}

/// Reads and clears the reset flags.
pub fn take_reset_cause(r: &Peripherals) -> ResetCause {
    let flags = r.CPU.mcucsr().read().bits();
    // SAFETY: zeros clear the flags; the JTAG disable bit (7) stays as it is.
    unsafe { r.CPU.mcucsr().write(|w| w.bits(flags & 0x80)) };
    ResetCause(flags & 0x1f)
}
