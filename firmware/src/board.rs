//! What the logic needs of its hardware.

use handstand_shared::message::ResetCause;

/// A CM-5, real, simulated or made of queues.
pub trait Board {
    /// Free-running clock, [`crate::design::CLOCK_PER_US`] counts per microsecond; wraps after 32.8
    /// ms.
    fn clock(&self) -> u16;

    /// True once per tick.
    fn tick_due(&mut self) -> bool;

    /// Puts the watchdog off for another 28 ms. Only a tick does so, when it begins and when it
    /// ends, and what reads a plan from EEPROM, while torque is off, once per piece.
    fn feed_watchdog(&mut self);

    /// Sends bytes to the servos, and turns the bus to listening after the last stop bit. They may
    /// go out while the program goes on.
    fn bus_send(&mut self, bytes: &[u8]);

    /// Sends the first bytes of a packet, whose last ones [`Board::bus_send`] will send.
    fn bus_send_part(&mut self, bytes: &[u8]) {
        self.bus_send(bytes);
    }

    /// The next byte from the servos, waiting at most this long for it, us, once all is sent.
    fn bus_receive(&mut self, within_us: u16) -> Option<u8>;

    /// Bytes from the servos, until `out` is full, nothing comes for so long, or they have come for
    /// `all_us`; how many came. The first may take another time than the others, us.
    fn bus_hear(&mut self, out: &mut [u8], first_us: u16, between_us: u16, all_us: u16) -> usize {
        let Some((first, rest)) = out.split_first_mut() else {
            return 0;
        };
        let Some(byte) = self.bus_receive(first_us) else {
            return 0;
        };
        *first = byte;
        let began = self.clock();
        let mut used = 1;
        for slot in rest {
            let left_us = all_us.saturating_sub(since_us(self, began));
            let Some(byte) = self.bus_receive(between_us.min(left_us)) else {
                break;
            };
            *slot = byte;
            used += 1;
        }
        used
    }

    /// Lets this time pass once all is sent to the servos, us.
    fn wait(&mut self, us: u16);

    /// Forgets bytes from the servos that nobody took.
    fn bus_flush(&mut self);

    /// The next byte from the PC.
    fn link_receive(&mut self) -> Option<u8>;

    /// Bytes from the PC that were lost for want of room, since the last call.
    fn link_overruns(&mut self) -> u8;

    /// How many bytes [`Board::link_send`] takes now.
    fn link_room(&self) -> usize;

    /// Queues bytes for the PC; those that find no room are lost.
    fn link_send(&mut self, bytes: &[u8]);

    /// Which buttons are down, see [`crate::panel`].
    fn buttons(&mut self) -> u8;

    /// Which LEDs are lit, see [`crate::panel`].
    fn set_leds(&mut self, leds: u8);

    /// The gyro's voltage, ADC code 0..=1023.
    fn gyro(&mut self) -> u16;

    /// A byte of the plan that was compiled in; none behind its end.
    fn compiled_plan(&self, _at: u16) -> Option<u8> {
        None
    }

    /// A byte of EEPROM.
    fn eeprom_read(&mut self, address: u16) -> u8;

    /// Begins to write a byte of EEPROM; false if the last one is still being written (8.5 ms).
    fn eeprom_write(&mut self, address: u16, byte: u8) -> bool;

    /// Whether the last byte is written.
    fn eeprom_ready(&self) -> bool;

    /// Why the controller started.
    fn reset_cause(&self) -> ResetCause;

    /// How deep the stack has been, and how much of it there is, bytes.
    fn stack(&mut self) -> (u16, u16);
}

/// Microseconds from `start` until now.
pub fn since_us(board: &(impl Board + ?Sized), start: u16) -> u16 {
    board.clock().wrapping_sub(start) / crate::design::CLOCK_PER_US
}
