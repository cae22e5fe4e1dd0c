//! The gyro on pad PF3, measured over and over.

use avr_device::atmega128a::Peripherals;

const FROM_AVCC: u8 = 1 << 6;
const CHANNEL: u8 = 3;
/// On, started, free running, clock / 128: a conversion takes 104 us.
const RUNNING: u8 = 0x80 | 0x40 | 0x20 | 0x07;

/// Conversions begin and go on.
pub fn start(r: &Peripherals) {
    // SAFETY: plain bits, as in the data sheet.
    unsafe {
        r.ADC.admux().write(|w| w.bits(FROM_AVCC | CHANNEL));
        r.ADC.adcsra().write(|w| w.bits(RUNNING));
    }
}

/// The last conversion, 0..=1023.
pub fn latest(r: &Peripherals) -> u16 {
    r.ADC.adc().read().bits() & 0x3ff
}
