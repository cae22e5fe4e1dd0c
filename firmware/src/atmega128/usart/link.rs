//! USART1, the PC line, as embedded-io's reader and writer.

use super::{DOUBLE_SPEED, EIGHT_BITS, EMPTY, EMPTY_INTERRUPT, RECEIVER, TRANSMITTER};
use crate::atmega128::clock::LINK_UBRR;
use crate::atmega128::ring::Ring;
use avr_device::atmega128a::{Peripherals, USART1};
use core::convert::Infallible;
use embedded_io::{ErrorType, Read, ReadReady, Write, WriteReady};

/// From the PC: more than what comes in while a tick runs, 57 bytes per 10 ms.
static IN: Ring<128> = Ring::new();
/// To the PC: a report, an answer and telemetry together.
static OUT: Ring<256> = Ring::new();

/// The line, behind a queue each way that interrupts fill and empty.
pub struct Link(USART1);

impl Link {
    /// At its speed, 8N1.
    pub fn start(usart: USART1) -> Self {
        // SAFETY: plain bits, as in the data sheet's tables. Double speed before the baud rate.
        unsafe {
            usart.ucsr1b().write(|w| w.bits(0));
            usart.ucsr1a().write(|w| w.bits(DOUBLE_SPEED));
            usart.ucsr1c().write(|w| w.bits(EIGHT_BITS));
            usart.ubrr1h().write(|w| w.bits(0));
            usart.ubrr1l().write(|w| w.bits(LINK_UBRR));
            usart.ucsr1b().write(|w| w.bits(RECEIVER | TRANSMITTER));
        }
        Link(usart)
    }

    /// How many bytes [`Write::write`] takes now.
    pub fn room(&self) -> usize {
        OUT.room()
    }

    /// Bytes from the PC that found no room, since the last call.
    pub fn take_lost(&mut self) -> u8 {
        IN.take_lost()
    }
}

/// Bytes that find no room are counted, [`Link::take_lost`]; reading those that do cannot fail.
impl ErrorType for Link {
    type Error = Infallible;
}

impl ReadReady for Link {
    #[inline(always)]
    fn read_ready(&mut self) -> Result<bool, Infallible> {
        Ok(!IN.is_empty())
    }
}

impl Read for Link {
    /// What has come; waits for a first byte, without end.
    #[inline(always)]
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        while !bytes.is_empty() && IN.is_empty() {}
        let mut count = 0;
        for slot in bytes {
            let Some(byte) = IN.pop() else { break };
            *slot = byte;
            count += 1;
        }
        Ok(count)
    }
}

impl WriteReady for Link {
    #[inline(always)]
    fn write_ready(&mut self) -> Result<bool, Infallible> {
        Ok(OUT.room() > 0)
    }
}

impl Write for Link {
    /// Queues what finds room; waits until a byte does, at most the 174 us another one takes to
    /// leave.
    #[inline(always)]
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        while !bytes.is_empty() && OUT.room() == 0 {}
        let count = OUT.push_all(bytes);
        // SAFETY: plain bits, in one store.
        unsafe {
            self.0
                .ucsr1b()
                .write(|w| w.bits(RECEIVER | TRANSMITTER | EMPTY_INTERRUPT))
        };
        Ok(count)
    }

    /// Waits until the last byte is being shifted out. A full queue takes 44 ms, longer than the
    /// watchdog waits.
    fn flush(&mut self) -> Result<(), Infallible> {
        while !OUT.is_empty() || self.0.ucsr1a().read().bits() & EMPTY == 0 {}
        Ok(())
    }
}

#[avr_device::interrupt(atmega128a)]
fn USART1_RX() {
    // SAFETY: only this interrupt reads the data register.
    let r = unsafe { Peripherals::steal() };
    IN.push(r.USART1.udr1().read().bits());
}

#[avr_device::interrupt(atmega128a)]
fn USART1_UDRE() {
    // SAFETY: only this interrupt writes the data register; the program changes UCSR1B in one
    // store.
    let r = unsafe { Peripherals::steal() };
    unsafe {
        match OUT.pop() {
            Some(byte) => r.USART1.udr1().write(|w| w.bits(byte)),
            None => r.USART1.ucsr1b().write(|w| w.bits(RECEIVER | TRANSMITTER)),
        };
    }
}
