//! A board for tests of one part: no servo answers, and its clock goes on by 1 us each time it is
//! read.

use crate::board::Board;
use crate::design::CLOCK_PER_US;
use core::cell::Cell;
use handstand_shared::message::ResetCause;
use std::vec::Vec;

/// Time of a byte to the servos, us.
const BYTE_US: u16 = 10;

/// What was sent, and when.
#[derive(Debug, Default)]
pub struct TestBoard {
    clock_us: Cell<u16>,
    /// Packets to the servos, and when each began and ended, us.
    pub sent: Vec<(Vec<u8>, [u16; 2])>,
}

impl TestBoard {
    /// The time now, us.
    pub fn now_us(&self) -> u16 {
        self.clock_us.get()
    }

    /// Lets this time pass, us.
    pub fn pass_us(&self, us: u16) {
        self.clock_us.set(self.clock_us.get() + us);
    }
}

impl Board for TestBoard {
    fn clock(&self) -> u16 {
        self.pass_us(1);
        self.now_us() * CLOCK_PER_US
    }

    fn tick_due(&mut self) -> bool {
        false
    }

    fn feed_watchdog(&mut self) {}

    fn bus_send(&mut self, bytes: &[u8]) {
        let began = self.now_us();
        self.pass_us(BYTE_US * bytes.len() as u16);
        self.sent.push((bytes.to_vec(), [began, self.now_us()]));
    }

    fn bus_receive(&mut self, within_us: u16) -> Option<u8> {
        self.pass_us(within_us);
        None
    }

    fn wait(&mut self, us: u16) {
        self.pass_us(us);
    }

    fn bus_flush(&mut self) {}

    fn link_receive(&mut self) -> Option<u8> {
        None
    }

    fn link_overruns(&mut self) -> u8 {
        0
    }

    fn link_room(&self) -> usize {
        0
    }

    fn link_send(&mut self, _bytes: &[u8]) {}

    fn buttons(&mut self) -> u8 {
        0
    }

    fn set_leds(&mut self, _leds: u8) {}

    fn gyro(&mut self) -> u16 {
        0
    }

    fn eeprom_read(&mut self, _address: u16) -> u8 {
        0xff
    }

    fn eeprom_write(&mut self, _address: u16, _byte: u8) -> bool {
        false
    }

    fn eeprom_ready(&self) -> bool {
        false
    }

    fn reset_cause(&self) -> ResetCause {
        ResetCause(ResetCause::POWER)
    }

    fn stack(&mut self) -> (u16, u16) {
        (0, 0)
    }
}
