//! The CM-5's ATmega128: every register it writes. Unsafe code is here, in the law's assembly
//! (`shared/src/law/avr.rs`) and the program that tests it, and in the table in flash of
//! `shared/src/crc/flash.rs`, and nowhere else.
//!
//! A module per peripheral. Pins are embedded-hal's and the PC line is embedded-io's; for ADC,
//! EEPROM and watchdog embedded-hal 1.0 has no traits, and nothing here waits for a time, so there
//! is no delay. Registers are written by their bits, for the generated names of the USART's frame
//! format are wrong in avr-device 0.9.
#![allow(unsafe_code)]

mod adc;
mod clock;
mod eeprom;
mod flash;
mod port;
mod ring;
mod stack;
mod timer;
mod usart;
mod watchdog;

use crate::board::Board;
use crate::design::CLOCK_PER_US;
use avr_device::atmega128a::Peripherals;
use embedded_io::{Read as _, ReadReady as _, Write as _, WriteReady as _};
use handstand_shared::message::ResetCause;
use port::{Buttons, Leds};
use usart::Link;

/// The board, taken over whatever state a boot loader left it in.
pub struct Cm5 {
    registers: Peripherals,
    link: Link,
    buttons: Buttons,
    leds: Leds,
    reset_cause: ResetCause,
    stack: stack::Look,
}

impl Cm5 {
    /// Charger off, watchdog on, then all else. Call once, first of all.
    pub fn start() -> Self {
        avr_device::interrupt::disable();
        // SAFETY: called once, before any interrupt is on.
        let registers = unsafe { Peripherals::steal() };
        port::charger_off(&registers);
        watchdog::start(&registers);
        let reset_cause = watchdog::take_reset_cause(&registers);
        let stack = stack::Look::paint();
        let (buttons, leds) = port::start(&registers);
        timer::start(&registers);
        usart::bus::start(&registers);
        // SAFETY: the line is used through this alone from here on.
        let link = Link::start(unsafe { Peripherals::steal() }.USART1);
        adc::start(&registers);
        // SAFETY: everything an interrupt uses is set up.
        unsafe { avr_device::interrupt::enable() };
        Cm5 {
            registers,
            link,
            buttons,
            leds,
            reset_cause,
            stack,
        }
    }
}

impl Board for Cm5 {
    fn clock(&self) -> u16 {
        timer::clock(&self.registers)
    }

    fn tick_due(&mut self) -> bool {
        let is_due = timer::tick_due(&self.registers);
        if !is_due {
            self.stack.go_on();
        }
        is_due
    }

    fn feed_watchdog(&mut self) {
        avr_device::asm::wdr();
    }

    #[inline(always)]
    fn bus_send(&mut self, bytes: &[u8]) {
        self.bus_send_part(bytes);
        usart::bus::end(&self.registers);
    }

    #[inline(always)]
    fn bus_send_part(&mut self, bytes: &[u8]) {
        usart::bus::put(&self.registers, bytes);
    }

    #[inline(always)]
    fn bus_receive(&mut self, within_us: u16) -> Option<u8> {
        usart::bus::receive(&self.registers, within_us.saturating_mul(CLOCK_PER_US))
    }

    #[inline(always)]
    fn bus_hear(&mut self, out: &mut [u8], first_us: u16, between_us: u16, all_us: u16) -> usize {
        let counts = |us: u16| us.saturating_mul(CLOCK_PER_US);
        let [first, between, all] = [first_us, between_us, all_us].map(counts);
        usart::bus::hear(&self.registers, out, first, between, all)
    }

    fn wait(&mut self, us: u16) {
        usart::bus::finish(&self.registers);
        let began = self.clock();
        while crate::board::since_us(self, began) < us {}
    }

    #[inline(always)]
    fn bus_flush(&mut self) {
        usart::bus::flush();
    }

    fn link_receive(&mut self) -> Option<u8> {
        let Ok(is_there) = self.link.read_ready();
        is_there.then(|| {
            let mut byte = [0];
            let Ok(_) = self.link.read(&mut byte);
            byte[0]
        })
    }

    fn link_overruns(&mut self) -> u8 {
        self.link.take_lost()
    }

    fn link_room(&self) -> usize {
        self.link.room()
    }

    fn link_send(&mut self, bytes: &[u8]) {
        // Writing waits for room, so only where there is some.
        if let Ok(true) = self.link.write_ready() {
            let Ok(_) = self.link.write(bytes);
        }
    }

    fn buttons(&mut self) -> u8 {
        self.buttons.down()
    }

    fn set_leds(&mut self, leds: u8) {
        self.leds.show(leds);
    }

    fn gyro(&mut self) -> u16 {
        adc::latest(&self.registers)
    }

    fn compiled_plan(&self, at: u16) -> Option<u8> {
        flash::plan(at)
    }

    fn eeprom_read(&mut self, address: u16) -> u8 {
        eeprom::read(&self.registers, address)
    }

    fn eeprom_write(&mut self, address: u16, byte: u8) -> bool {
        eeprom::write(&self.registers, address, byte)
    }

    fn eeprom_ready(&self) -> bool {
        eeprom::is_ready(&self.registers)
    }

    fn reset_cause(&self) -> ResetCause {
        self.reset_cause
    }

    fn stack(&mut self) -> (u16, u16) {
        self.stack.used_and_size()
    }
}
