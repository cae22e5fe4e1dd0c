//! USART0 is the servo bus, USART1 the PC line.

use super::ring::{Ring, SharedByte};
use super::timer::clock;
use crate::design::{BUS_UBRR, CLOCK_PER_US, LINK_UBRR};
use avr_device::atmega128a::Peripherals;

/// From the servos. A whole answer of 14 bytes can wait here.
pub static BUS_IN: Ring<64> = Ring::new();
/// To the servos: a SYNC_WRITE to 18 of them has 62 bytes.
pub static BUS_OUT: Ring<64> = Ring::new();
/// From the PC: more than what comes in while a tick runs, 57 bytes per 10 ms.
pub static LINK_IN: Ring<128> = Ring::new();
/// To the PC: a report, an answer and telemetry together.
pub static LINK_OUT: Ring<256> = Ring::new();

const DOUBLE_SPEED: u8 = 1 << 1;
const SENT: u8 = 1 << 6;
const SENT_INTERRUPT: u8 = 1 << 6;
const EIGHT_BITS: u8 = 0b110;
const RECEIVED: u8 = 1 << 7;
const RECEIVER_ON: u8 = 1 << 4;
const RECEIVER: u8 = RECEIVER_ON | 1 << 7; // with its interrupt
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

/// The bus's transmitter: idle, or a packet is on its way. Written by the program when idle, by the interrupt when it ends.
static BUS: SharedByte = SharedByte::new(IDLE);
const IDLE: u8 = 0;
/// More of the packet will be handed over.
const OPEN: u8 = 1;
/// All of it was.
const CLOSED: u8 = 2;

/// Longest time a packet takes, us: 63 bytes of 10 us in [`BUS_OUT`], and as much again for interrupts between them.
const LONGEST_US: u16 = 1300;

/// Hands over bytes of a packet, which go out while the program goes on; the first ones of it wait until the packet
/// before is out, and drive the bus.
#[inline(always)]
pub fn put(r: &Peripherals, mut bytes: &[u8]) {
    if BUS.get() != OPEN
        && let Some((first, rest)) = bytes.split_first()
    {
        finish(r);
        BUS.set(OPEN);
        super::port::bus_transmits(r);
        transmit(r, *first);
        bytes = rest;
    }
    bytes.iter().for_each(|byte| BUS_OUT.push(*byte));
    wake_bus(r);
}

/// Gives the transmitter a byte, for which it has room.
#[inline(always)]
fn transmit(r: &Peripherals, byte: u8) {
    // SAFETY: plain bits.
    unsafe {
        r.USART0.udr0().write(|w| w.bits(byte));
        // Cleared by a one: it is set again when this byte is out, and by no earlier one.
        r.USART0.ucsr0a().write(|w| w.bits(DOUBLE_SPEED | SENT));
    }
}

/// The packet that was begun is whole: after its last stop bit the bus is let in.
#[inline(always)]
pub fn end(r: &Peripherals) {
    BUS.set(CLOSED);
    wake_bus(r);
}

/// Whether a packet is on its way.
#[inline(always)]
pub fn is_sending() -> bool {
    BUS.get() != IDLE
}

/// Waits until the last stop bit is out. A USART that is not done after twice the longest time is broken, and given up.
#[inline(always)]
pub fn finish(r: &Peripherals) {
    let start = clock(r);
    while is_sending() {
        if clock(r).wrapping_sub(start) >= LONGEST_US * CLOCK_PER_US {
            give_up(r);
        }
    }
}

/// Takes bytes from the servos until `out` is full, or nothing comes for `first` counts of the clock, or `between` after the
/// first byte; how many came. It polls: an interrupt costs half of the time a byte lasts.
#[inline(always)]
pub fn hear(r: &Peripherals, out: &mut [u8], first: u16, between: u16) -> usize {
    finish(r);
    // SAFETY: plain bits; nothing is being sent.
    let receiver = |bits| unsafe { r.USART0.ucsr0b().write(|w| w.bits(bits)) };
    receiver(RECEIVER_ON | TRANSMITTER);
    let mut limit = first;
    let mut used = 0;
    'bytes: for slot in out {
        let start = clock(r);
        *slot = loop {
            // What came before the interrupt was off.
            if let Some(byte) = BUS_IN.pop() {
                break byte;
            }
            if r.USART0.ucsr0a().read().bits() & RECEIVED != 0 {
                break r.USART0.udr0().read().bits();
            }
            if clock(r).wrapping_sub(start) >= limit {
                break 'bytes;
            }
        };
        used += 1;
        limit = between;
    }
    receiver(RECEIVER | TRANSMITTER);
    used
}

#[cold]
#[inline(never)]
fn give_up(r: &Peripherals) {
    // SAFETY: plain bits; the interrupts that use the rest are off by them.
    unsafe { r.USART0.ucsr0b().write(|w| w.bits(RECEIVER | TRANSMITTER)) };
    while BUS_OUT.pop().is_some() {}
    super::port::bus_listens(r);
    BUS.set(IDLE);
}

/// Something is in [`BUS_OUT`], or nothing more will be.
#[inline(always)]
fn wake_bus(r: &Peripherals) {
    // SAFETY: plain bits, in one store.
    unsafe {
        r.USART0
            .ucsr0b()
            .write(|w| w.bits(RECEIVER | TRANSMITTER | EMPTY_INTERRUPT))
    };
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
    // SAFETY: the program reads the data register only while this interrupt is off.
    let r = unsafe { Peripherals::steal() };
    BUS_IN.push(r.USART0.udr0().read().bits());
}

#[avr_device::interrupt(atmega128a)]
fn USART0_UDRE() {
    // SAFETY: the program writes these registers only before a packet, and then in one store each.
    let r = unsafe { Peripherals::steal() };
    unsafe {
        match BUS_OUT.pop() {
            Some(byte) => transmit(&r, byte),
            None => {
                let last = BUS.get() == CLOSED;
                let ending = if last { SENT_INTERRUPT } else { 0 };
                let bits = RECEIVER | TRANSMITTER | ending;
                r.USART0.ucsr0b().write(|w| w.bits(bits));
            }
        }
    }
}

#[avr_device::interrupt(atmega128a)]
fn USART0_TX() {
    // SAFETY: single bits of a port, and a register the program leaves alone while a packet is on its way.
    let r = unsafe { Peripherals::steal() };
    super::port::bus_listens(&r);
    unsafe { r.USART0.ucsr0b().write(|w| w.bits(RECEIVER | TRANSMITTER)) };
    BUS.set(IDLE);
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
