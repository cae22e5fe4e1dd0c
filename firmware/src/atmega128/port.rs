//! Pins of the CM-5: charger, bus direction, link choice, buttons and LEDs, each one of
//! embedded-hal's digital pins.

mod pin;

use crate::panel::{button, led};
use avr_device::atmega128a::{PORTB, PORTC, PORTD, PORTE, Peripherals};
use core::convert::Infallible;
use embedded_hal::digital::{InputPin, OutputPin, PinState};
use pin::{Input, Output};

/// Low charges the battery.
type Charger = Output<PORTB, 5>;
/// High drives the bus.
type Transmit = Output<PORTE, 2>;
/// High lets the bus in.
type Receive = Output<PORTE, 3>;
type ZigbeeReset = Output<PORTD, 4>;
/// High: the link's receiver hears the PC,
type FromPc = Output<PORTD, 5>;
/// or the radio, never both.
type FromZigbee = Output<PORTD, 6>;
type BusIn = Input<PORTE, 0>;
type BusOut = Output<PORTE, 1>;
type LinkOut = Output<PORTD, 3>;

/// The charger stays off, whatever happens next.
pub fn charger_off(r: &Peripherals) {
    Charger::new(PinState::High);
    // SAFETY: any bits are a valid port. The others of this port are free.
    unsafe { r.PORTB.ddrb().write(|w| w.bits(Charger::MASK)) };
}

/// All other pins, whatever a boot loader left them as; the bus listens.
pub fn start(r: &Peripherals) -> (Buttons, Leds) {
    // SAFETY: any bits are a valid port.
    unsafe {
        // Interrupts are vectored to the application: IVCE first, then IVSEL = 0.
        r.CPU.mcucr().write(|w| w.bits(1));
        r.CPU.mcucr().write(|w| w.bits(0));
        r.EXINT.eimsk().write(|w| w.bits(0));
        r.PORTC.ddrc().write(|w| w.bits(0));
        r.PORTD.ddrd().write(|w| w.bits(0));
        r.PORTE.ddre().write(|w| w.bits(0));
        r.PORTF.ddrf().write(|w| w.bits(0));
        r.PORTF.portf().write(|w| w.bits(0));
    }
    Transmit::new(PinState::Low);
    Receive::new(PinState::High);
    BusIn::new();
    BusOut::new(PinState::High);
    ZigbeeReset::new(PinState::High);
    FromZigbee::new(PinState::Low);
    FromPc::new(PinState::High);
    LinkOut::new(PinState::High);
    (Buttons::new(), Leds::new())
}

/// The bus is driven.
#[inline(always)]
pub fn bus_transmits() {
    // SAFETY: only this and `bus_listens` change these pins, never both at once.
    let (mut transmit, mut receive) = unsafe { (Transmit::steal(), Receive::steal()) };
    let Ok(()) = receive.set_low();
    let Ok(()) = transmit.set_high();
}

/// The bus is let in.
#[inline(always)]
pub fn bus_listens() {
    // SAFETY: as in `bus_transmits`.
    let (mut transmit, mut receive) = unsafe { (Transmit::steal(), Receive::steal()) };
    let Ok(()) = transmit.set_low();
    let Ok(()) = receive.set_high();
}

/// The buttons, which pull their pins low.
pub struct Buttons {
    up: Input<PORTE, 4>,
    down: Input<PORTE, 5>,
    left: Input<PORTE, 6>,
    right: Input<PORTE, 7>,
    start: Input<PORTD, 0>,
}

impl Buttons {
    fn new() -> Self {
        Buttons {
            up: Input::new(),
            down: Input::new(),
            left: Input::new(),
            right: Input::new(),
            start: Input::new(),
        }
    }

    /// Those that are down, as [`crate::panel::button`].
    pub fn down(&mut self) -> u8 {
        held(&mut self.up, button::UP)
            | held(&mut self.down, button::DOWN)
            | held(&mut self.left, button::LEFT)
            | held(&mut self.right, button::RIGHT)
            | held(&mut self.start, button::START)
    }
}

#[inline(always)]
fn held(pin: &mut impl InputPin<Error = Infallible>, bit: u8) -> u8 {
    let Ok(is_low) = pin.is_low();
    if is_low { bit } else { 0 }
}

/// The LEDs, which shine while their pins are low.
pub struct Leds {
    power: Output<PORTC, 0>,
    txd: Output<PORTC, 1>,
    rxd: Output<PORTC, 2>,
    aux: Output<PORTC, 3>,
    manage: Output<PORTC, 4>,
    program: Output<PORTC, 5>,
    play: Output<PORTC, 6>,
}

impl Leds {
    /// All dark.
    fn new() -> Self {
        Leds {
            power: Output::new(PinState::High),
            txd: Output::new(PinState::High),
            rxd: Output::new(PinState::High),
            aux: Output::new(PinState::High),
            manage: Output::new(PinState::High),
            program: Output::new(PinState::High),
            play: Output::new(PinState::High),
        }
    }

    /// Lights those of [`crate::panel::led`] and no others.
    pub fn show(&mut self, lit: u8) {
        shine(&mut self.power, lit & led::POWER != 0);
        shine(&mut self.txd, lit & led::TXD != 0);
        shine(&mut self.rxd, lit & led::RXD != 0);
        shine(&mut self.aux, lit & led::AUX != 0);
        shine(&mut self.manage, lit & led::MANAGE != 0);
        shine(&mut self.program, lit & led::PROGRAM != 0);
        shine(&mut self.play, lit & led::PLAY != 0);
    }
}

#[inline(always)]
fn shine(pin: &mut impl OutputPin<Error = Infallible>, is_lit: bool) {
    let Ok(()) = pin.set_state(PinState::from(!is_lit));
}
