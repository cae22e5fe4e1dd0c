//! USART0, the servo bus: half duplex, packet by packet.
//!
//! Not as embedded-io's traits: a byte lasts 160 cycles. Packets leave by interrupt while they are
//! still being made, and answers are polled with a time-out of their own for the first byte; a
//! reader of bytes has no words for either.

use super::{
    DOUBLE_SPEED, EIGHT_BITS, EMPTY_INTERRUPT, RECEIVED, RECEIVER, RECEIVER_ON, SENT,
    SENT_INTERRUPT, TRANSMITTER,
};
use crate::atmega128::clock::BUS_UBRR;
use crate::atmega128::port::{bus_listens, bus_transmits};
use crate::atmega128::ring::{Ring, SharedByte};
use crate::atmega128::timer::clock;
use crate::design::CLOCK_PER_US;
use avr_device::atmega128a::Peripherals;

/// From the servos. A whole answer of 26 bytes can wait here.
static IN: Ring<RING> = Ring::new();
const RING: usize = 64;
/// To the servos: a SYNC_WRITE to 18 of them has 62 bytes.
static OUT: Ring<64> = Ring::new();

/// At its speed, 8N1.
pub fn start(r: &Peripherals) {
    // SAFETY: plain bits, as in the data sheet's tables. Double speed before the baud rate.
    unsafe {
        r.USART0.ucsr0b().write(|w| w.bits(0));
        r.USART0.ucsr0a().write(|w| w.bits(DOUBLE_SPEED));
        r.USART0.ucsr0c().write(|w| w.bits(EIGHT_BITS));
        r.USART0.ubrr0h().write(|w| w.bits(0));
        r.USART0.ubrr0l().write(|w| w.bits(BUS_UBRR));
        r.USART0.ucsr0b().write(|w| w.bits(RECEIVER | TRANSMITTER));
    }
}

/// The bus's transmitter: idle, or a packet is on its way. Written by the program when idle, by the
/// interrupt when it ends.
static STATE: SharedByte = SharedByte::new(IDLE);
const IDLE: u8 = 0;
/// More of the packet will be handed over.
const OPEN: u8 = 1;
/// All of it was.
const CLOSED: u8 = 2;

/// Longest time a packet takes, us: 63 bytes of 10 us in [`OUT`], and as much again for interrupts
/// between them.
const LONGEST_US: u16 = 1300;

/// Hands over bytes of a packet, which go out while the program goes on; the first ones of it wait
/// until the packet before is out, and drive the bus.
#[inline(always)]
pub fn put(r: &Peripherals, mut bytes: &[u8]) {
    if STATE.get() != OPEN
        && let Some((first, rest)) = bytes.split_first()
    {
        finish(r);
        STATE.set(OPEN);
        bus_transmits();
        begin(r, *first);
        bytes = rest;
        // The second goes at once: the first will be out before the others are handed over.
        if let Some((second, rest)) = bytes.split_first() {
            OUT.push(*second);
            wake(r);
            bytes = rest;
        }
    }
    bytes.iter().for_each(|byte| OUT.push(*byte));
    wake(r);
}

/// Gives the idle transmitter a packet's first byte. What it sent before is cleared first: three
/// interrupts after the write would last longer than the byte, and its own end would be lost.
#[inline(always)]
fn begin(r: &Peripherals, byte: u8) {
    // SAFETY: plain bits.
    unsafe {
        r.USART0.ucsr0a().write(|w| w.bits(DOUBLE_SPEED | SENT));
        r.USART0.udr0().write(|w| w.bits(byte));
    }
}

/// Gives the transmitter a byte, for which it has room, while interrupts are off.
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
    STATE.set(CLOSED);
    wake(r);
}

/// Whether a packet is on its way.
#[inline(always)]
fn is_sending() -> bool {
    STATE.get() != IDLE
}

/// Waits until the last stop bit is out. A USART that is not done after twice the longest time is
/// broken, and given up.
#[inline(always)]
pub fn finish(r: &Peripherals) {
    let start = clock(r);
    while is_sending() {
        if clock(r).wrapping_sub(start) >= LONGEST_US * CLOCK_PER_US {
            give_up(r);
        }
    }
}

/// The next byte from the servos, waiting for it for so many counts of the clock.
#[inline(always)]
pub fn receive(r: &Peripherals, within: u16) -> Option<u8> {
    if within > 0 {
        finish(r);
    }
    let start = clock(r);
    loop {
        if let Some(byte) = IN.pop() {
            return Some(byte);
        }
        if clock(r).wrapping_sub(start) >= within {
            return None;
        }
    }
}

/// Forgets what came and was not taken.
#[inline(always)]
pub fn flush() {
    // As many as were there: noise may go on filling it.
    for _ in 0..RING {
        if IN.pop().is_none() {
            break;
        }
    }
}

/// Takes bytes from the servos until `out` is full, or nothing comes for `first` counts of the
/// clock, or `between` after the first byte, or bytes have come for `all`; how many came. It polls:
/// an interrupt costs half of the time a byte lasts.
#[inline(always)]
pub fn hear(r: &Peripherals, out: &mut [u8], first: u16, between: u16, all: u16) -> usize {
    finish(r);
    // What came meanwhile, while the interrupt still takes the next ones: the receiver itself holds
    // two bytes.
    let mut used = take_waiting(out, 0);
    // SAFETY: plain bits; nothing is being sent.
    let receiver = |bits| unsafe { r.USART0.ucsr0b().write(|w| w.bits(bits)) };
    receiver(RECEIVER_ON | TRANSMITTER);
    // What came before the interrupt was off.
    used = take_waiting(out, used);
    let mut limit = if used == 0 { first } else { between };
    let mut began = clock(r);
    'bytes: for slot in out.iter_mut().skip(used) {
        let start = clock(r);
        if used > 0 && start.wrapping_sub(began) >= all {
            break;
        }
        *slot = loop {
            if r.USART0.ucsr0a().read().bits() & RECEIVED != 0 {
                break r.USART0.udr0().read().bits();
            }
            if clock(r).wrapping_sub(start) >= limit {
                break 'bytes;
            }
        };
        if used == 0 {
            began = clock(r);
        }
        used += 1;
        limit = between;
    }
    receiver(RECEIVER | TRANSMITTER);
    used
}

/// Takes what the interrupt has taken, from this place on; how many are there then.
#[inline(always)]
fn take_waiting(out: &mut [u8], mut used: usize) -> usize {
    while let Some(slot) = out.get_mut(used) {
        let Some(byte) = IN.pop() else { break };
        *slot = byte;
        used += 1;
    }
    used
}

#[cold]
#[inline(never)]
fn give_up(r: &Peripherals) {
    // SAFETY: plain bits; the interrupts that use the rest are off by them.
    unsafe { r.USART0.ucsr0b().write(|w| w.bits(RECEIVER | TRANSMITTER)) };
    while OUT.pop().is_some() {}
    bus_listens();
    STATE.set(IDLE);
}

/// Something is in [`OUT`], or nothing more will be.
#[inline(always)]
fn wake(r: &Peripherals) {
    // SAFETY: plain bits, in one store.
    unsafe {
        r.USART0
            .ucsr0b()
            .write(|w| w.bits(RECEIVER | TRANSMITTER | EMPTY_INTERRUPT))
    };
}

#[avr_device::interrupt(atmega128a)]
fn USART0_RX() {
    // SAFETY: the program reads the data register only while this interrupt is off.
    let r = unsafe { Peripherals::steal() };
    IN.push(r.USART0.udr0().read().bits());
}

#[avr_device::interrupt(atmega128a)]
fn USART0_UDRE() {
    // SAFETY: the program writes these registers only before a packet, and then in one store each.
    let r = unsafe { Peripherals::steal() };
    unsafe {
        match OUT.pop() {
            Some(byte) => transmit(&r, byte),
            None => {
                let last = STATE.get() == CLOSED;
                let ending = if last { SENT_INTERRUPT } else { 0 };
                let bits = RECEIVER | TRANSMITTER | ending;
                r.USART0.ucsr0b().write(|w| w.bits(bits));
            }
        }
    }
}

#[avr_device::interrupt(atmega128a)]
fn USART0_TX() {
    bus_listens();
    // SAFETY: a register the program leaves alone while a packet is on its way.
    let r = unsafe { Peripherals::steal() };
    unsafe { r.USART0.ucsr0b().write(|w| w.bits(RECEIVER | TRANSMITTER)) };
    STATE.set(IDLE);
}
