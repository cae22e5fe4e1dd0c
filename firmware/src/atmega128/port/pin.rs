//! One pin of a port.

use avr_device::atmega128a::{PORTB, PORTC, PORTD, PORTE};
use core::convert::Infallible;
use core::marker::PhantomData;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

/// A port whose single bits the AVR sets and clears in one instruction: those below I/O address
/// 0x20. So an interrupt and the program may change pins of the same port.
pub trait Port {
    /// Pins with a bit in `mask` are driven, or not.
    fn drive(mask: u8, is_driven: bool);
    /// Their level, or without being driven their pull-up.
    fn set(mask: u8, is_high: bool);
    /// The levels all pins have.
    fn levels() -> u8;
}

macro_rules! port {
    ($port:ident, $level:ident, $direction:ident, $pins:ident) => {
        impl Port for $port {
            #[inline(always)]
            fn drive(mask: u8, is_driven: bool) {
                // SAFETY: the registers are always there, and any bits are valid in them; so below.
                let direction = unsafe { (*$port::ptr()).$direction() };
                direction.modify(|r, w| unsafe { w.bits(changed(r.bits(), mask, is_driven)) });
            }

            #[inline(always)]
            fn set(mask: u8, is_high: bool) {
                let level = unsafe { (*$port::ptr()).$level() };
                level.modify(|r, w| unsafe { w.bits(changed(r.bits(), mask, is_high)) });
            }

            #[inline(always)]
            fn levels() -> u8 {
                unsafe { (*$port::ptr()).$pins().read().bits() }
            }
        }
    };
}

port!(PORTB, portb, ddrb, pinb);
port!(PORTC, portc, ddrc, pinc);
port!(PORTD, portd, ddrd, pind);
port!(PORTE, porte, ddre, pine);

#[inline(always)]
fn changed(bits: u8, mask: u8, is_set: bool) -> u8 {
    match is_set {
        true => bits | mask,
        false => bits & !mask,
    }
}

/// Pin `BIT` of port `P`, driven.
pub struct Output<P, const BIT: u8>(PhantomData<P>);

impl<P: Port, const BIT: u8> Output<P, BIT> {
    /// Its bit in the port's registers.
    pub const MASK: u8 = 1 << BIT;

    /// Drives it from now on. The level comes before the direction, so that it never shows another
    /// one.
    #[inline(always)]
    pub fn new(level: embedded_hal::digital::PinState) -> Self {
        let mut pin = Output(PhantomData);
        let Ok(()) = pin.set_state(level);
        P::drive(Self::MASK, true);
        pin
    }

    /// The pin, which is driven already.
    ///
    /// # Safety
    /// Whoever else has it must bear that its level changes.
    #[inline(always)]
    pub unsafe fn steal() -> Self {
        Output(PhantomData)
    }
}

impl<P, const BIT: u8> ErrorType for Output<P, BIT> {
    type Error = Infallible;
}

impl<P: Port, const BIT: u8> OutputPin for Output<P, BIT> {
    #[inline(always)]
    fn set_low(&mut self) -> Result<(), Infallible> {
        P::set(Self::MASK, false);
        Ok(())
    }

    #[inline(always)]
    fn set_high(&mut self) -> Result<(), Infallible> {
        P::set(Self::MASK, true);
        Ok(())
    }
}

/// Pin `BIT` of port `P`, listened to, with its pull-up.
pub struct Input<P, const BIT: u8>(PhantomData<P>);

impl<P: Port, const BIT: u8> Input<P, BIT> {
    const MASK: u8 = 1 << BIT;

    /// Listens to it from now on.
    #[inline(always)]
    pub fn new() -> Self {
        P::drive(Self::MASK, false);
        P::set(Self::MASK, true);
        Input(PhantomData)
    }
}

impl<P, const BIT: u8> ErrorType for Input<P, BIT> {
    type Error = Infallible;
}

impl<P: Port, const BIT: u8> InputPin for Input<P, BIT> {
    #[inline(always)]
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(P::levels() & Self::MASK != 0)
    }

    #[inline(always)]
    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(P::levels() & Self::MASK == 0)
    }
}
