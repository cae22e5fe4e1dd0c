//! USART0 is the servo bus, USART1 the PC line.

use super::ring::Ring;
use crate::design::{BUS_UBRR, LINK_UBRR};
use avr_device::atmega128a::Peripherals;

/// From the servos. A whole answer of 14 bytes can wait here.
pub static BUS_IN: Ring<64> = Ring::new();
/// From the PC: more than what comes in while a tick runs, 57 bytes per 10 ms.
pub static LINK_IN: Ring<128> = Ring::new();
/// To the PC: a report, an answer and telemetry together.
pub static LINK_OUT: Ring<256> = Ring::new();

const DOUBLE_SPEED: u8 = 1 << 1;
const EMPTY: u8 = 1 << 5;
const SENT: u8 = 1 << 6;
const EIGHT_BITS: u8 = 0b110;
const RECEIVER: u8 = 1 << 4 | 1 << 7; // with its interrupt
const TRANSMITTER: u8 = 1 << 3;
const EMPTY_INTERRUPT: u8 = 1 << 5;

/// Both at their speeds, 8N1.
pub fn start(r: &Peripherals) {
    // SAFETY: plain bits, as in the data sheet's tables. Double speed before the baud rate.
    unsafe {
        r.USART0.ucsr0b().write(|w| w.bits(0));
        r.USART0.ucsr0a().write(|w| w.bits(DOUBLE_SPEED));
        r.USART0.ucsr0c().write(|w| w.bits(EIGHT_BITS));
        r.USART0.ubrr0h().write(|w| w.bits(0));
        r.USART0.ubrr0l().write(|w| w.bits(BUS_UBRR as u8));
        r.USART0.ucsr0b().write(|w| w.bits(RECEIVER | TRANSMITTER));
        r.USART1.ucsr1b().write(|w| w.bits(0));
        r.USART1.ucsr1a().write(|w| w.bits(DOUBLE_SPEED));
        r.USART1.ucsr1c().write(|w| w.bits(EIGHT_BITS));
        r.USART1.ubrr1h().write(|w| w.bits(0));
        r.USART1.ubrr1l().write(|w| w.bits(LINK_UBRR as u8));
        r.USART1.ucsr1b().write(|w| w.bits(RECEIVER | TRANSMITTER));
    }
}

/// Sends bytes to the servos and waits until the last stop bit is out.
pub fn send(r: &Peripherals, bytes: &[u8]) {
    for byte in bytes {
        wait(|| r.USART0.ucsr0a().read().bits() & EMPTY != 0);
        // SAFETY: writing a one to SENT clears it, so that it is set by the last byte only.
        unsafe {
            r.USART0.ucsr0a().write(|w| w.bits(DOUBLE_SPEED | SENT));
            r.USART0.udr0().write(|w| w.bits(*byte));
        }
    }
    if !bytes.is_empty() {
        wait(|| r.USART0.ucsr0a().read().bits() & SENT != 0);
    }
}

/// A byte lasts 160 cycles; a USART that has not finished after many times that is broken, and is not waited for.
fn wait(done: impl Fn() -> bool) {
    for _ in 0..250u8 {
        if done() {
            return;
        }
    }
}

/// Something is in [`LINK_OUT`].
#[inline(always)]
pub fn wake_link(r: &Peripherals) {
    // SAFETY: plain bits.
    unsafe {
        r.USART1
            .ucsr1b()
            .write(|w| w.bits(RECEIVER | TRANSMITTER | EMPTY_INTERRUPT))
    };
}

#[avr_device::interrupt(atmega128a)]
fn USART0_RX() {
    // SAFETY: only this interrupt reads the data register.
    let r = unsafe { Peripherals::steal() };
    BUS_IN.push(r.USART0.udr0().read().bits());
}

#[avr_device::interrupt(atmega128a)]
fn USART1_RX() {
    // SAFETY: only this interrupt reads the data register.
    let r = unsafe { Peripherals::steal() };
    LINK_IN.push(r.USART1.udr1().read().bits());
}

#[avr_device::interrupt(atmega128a)]
fn USART1_UDRE() {
    // SAFETY: only this interrupt writes the data register; the program changes UCSR1B in one store.
    let r = unsafe { Peripherals::steal() };
    unsafe {
        match LINK_OUT.pop() {
            Some(byte) => r.USART1.udr1().write(|w| w.bits(byte)),
            None => r.USART1.ucsr1b().write(|w| w.bits(RECEIVER | TRANSMITTER)),
        };
    }
}
