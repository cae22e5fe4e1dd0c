//! The simulated bus as a port, in simulated time: nothing waits, and the same requests get the same answers.

use super::port::Link;
use crate::bus_sim::Bus;
use crate::error::Result;
use std::time::Duration;

/// An adapter on the simulated bus.
pub struct InProcess {
    bus: Bus,
    now: u64,
}

impl InProcess {
    /// On this bus, at its speed.
    pub fn new(bus: Bus) -> Self {
        InProcess { bus, now: 0 }
    }

    /// The bus, to look at and to disturb.
    pub fn bus(&mut self) -> &mut Bus {
        &mut self.bus
    }
}

impl Link for InProcess {
    fn name(&self) -> &str {
        "sim"
    }

    fn baud(&self) -> u32 {
        self.bus.line_baud
    }

    fn set_baud(&mut self, baud: u32) -> Result<()> {
        self.bus.line_baud = baud.max(1);
        Ok(())
    }

    fn send(&mut self, bytes: &[u8]) -> Result<()> {
        for byte in bytes {
            self.now += 10_000_000_000 / u64::from(self.bus.line_baud);
            self.bus.hear(self.now, *byte);
        }
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
        let until = self.now + nanoseconds(wait);
        match self.bus.next_ns() {
            Some(ends) if ends <= until => self.now = self.now.max(ends),
            _ => {
                self.now = until;
                return Ok(0);
            }
        }
        let mut count = 0;
        while let Some((slot, (_, byte))) = bytes
            .get_mut(count)
            .and_then(|slot| Some((slot, self.bus.take(self.now)?)))
        {
            *slot = byte;
            count += 1;
        }
        Ok(count)
    }

    fn clear(&mut self) -> Result<()> {
        while self.bus.take(self.now).is_some() {}
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_nanos(self.now)
    }

    fn pause(&mut self, time: Duration) {
        self.now += nanoseconds(time);
        self.bus.advance(self.now);
    }

    fn latency(&self) -> Duration {
        Duration::from_micros(100)
    }
}

fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos())
        .unwrap_or(u64::MAX / 2)
        .min(u64::MAX / 2)
}
