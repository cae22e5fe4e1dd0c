//! Pins of the CM-5: charger, bus direction, link choice, buttons and LEDs.

use avr_device::atmega128a::Peripherals;

const CHARGER: u8 = 1 << 5; // PB5: low charges the battery.
const TRANSMIT: u8 = 1 << 2; // PE2 drives the bus.
const RECEIVE: u8 = 1 << 3; // PE3 lets the bus in.
const ZIGBEE_RESET: u8 = 1 << 4; // PD4, high: not in reset.
const FROM_PC: u8 = 1 << 5; // PD5: the link's receiver hears the PC,
const FROM_ZIGBEE: u8 = 1 << 6; // PD6: or the radio, never both.

/// The charger stays off, whatever happens next.
pub fn charger_off(r: &Peripherals) {
    // SAFETY: any bits are a valid port. Level before direction: the pin never goes low.
    unsafe {
        r.PORTB.portb().write(|w| w.bits(CHARGER));
        r.PORTB.ddrb().write(|w| w.bits(CHARGER));
    }
}

/// All other pins; the bus listens.
pub fn start(r: &Peripherals) {
    // SAFETY: any bits are a valid port.
    unsafe {
        // Interrupts are vectored to the application, whatever a boot loader did: IVCE first, then IVSEL = 0.
        r.CPU.mcucr().write(|w| w.bits(1));
        r.CPU.mcucr().write(|w| w.bits(0));
        r.PORTE.porte().write(|w| w.bits(0xf0 | RECEIVE | 0b11));
        r.PORTE.ddre().write(|w| w.bits(TRANSMIT | RECEIVE | 0b10));
        r.PORTD
            .portd()
            .write(|w| w.bits(0b1001 | ZIGBEE_RESET | FROM_PC));
        r.PORTD
            .ddrd()
            .write(|w| w.bits(0b1000 | ZIGBEE_RESET | FROM_PC | FROM_ZIGBEE));
        r.PORTC.portc().write(|w| w.bits(0x7f));
        r.PORTC.ddrc().write(|w| w.bits(0x7f));
        r.PORTF.portf().write(|w| w.bits(0));
        r.PORTF.ddrf().write(|w| w.bits(0));
        r.EXINT.eimsk().write(|w| w.bits(0));
    }
}

/// The bus is driven.
#[inline(always)]
pub fn bus_transmits(r: &Peripherals) {
    // SAFETY: single bits of a port.
    unsafe {
        r.PORTE.porte().modify(|p, w| w.bits(p.bits() & !RECEIVE));
        r.PORTE.porte().modify(|p, w| w.bits(p.bits() | TRANSMIT));
    }
}

/// The bus is let in.
#[inline(always)]
pub fn bus_listens(r: &Peripherals) {
    // SAFETY: single bits of a port.
    unsafe {
        r.PORTE.porte().modify(|p, w| w.bits(p.bits() & !TRANSMIT));
        r.PORTE.porte().modify(|p, w| w.bits(p.bits() | RECEIVE));
    }
}

/// The buttons that are down, as [`crate::panel::button`]: PE4 to PE7, then PD0.
pub fn buttons(r: &Peripherals) -> u8 {
    let arrows = !r.PORTE.pine().read().bits() >> 4;
    let start = (!r.PORTD.pind().read().bits() & 1) << 4;
    arrows | start
}

/// Lights LEDs, as [`crate::panel::led`]; they are active low.
pub fn set_leds(r: &Peripherals, leds: u8) {
    // SAFETY: any bits are a valid port.
    unsafe { r.PORTC.portc().write(|w| w.bits(!leds & 0x7f)) };
}
