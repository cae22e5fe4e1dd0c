//! An adapter on the simulated bus, as a USB2Dynamixel is one.

use super::bus::Bus;
use super::port::{SimulatedPort, fill, nanoseconds};
use std::time::Duration;

/// The serial port of an adapter on the bus; its speed is the bus's.
#[derive(Debug)]
pub struct AdapterPort {
    bus: Bus,
    now_ns: u64,
}

impl AdapterPort {
    /// An adapter on this bus.
    pub fn new(bus: Bus) -> Self {
        AdapterPort { bus, now_ns: 0 }
    }

    /// The bus.
    pub fn bus(&mut self) -> &mut Bus {
        &mut self.bus
    }
}

impl SimulatedPort for AdapterPort {
    fn name(&self) -> &'static str {
        "sim"
    }

    fn baud(&self) -> u32 {
        self.bus.line_baud
    }

    fn set_baud(&mut self, baud: u32) {
        self.bus.line_baud = baud.max(1);
    }

    fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.now_ns += 10_000_000_000 / u64::from(self.bus.line_baud);
            self.bus.receive(self.now_ns, *byte);
        }
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> usize {
        let until_ns = self.now_ns + nanoseconds(wait);
        match self.bus.next_ns() {
            Some(end_ns) if end_ns <= until_ns => self.now_ns = self.now_ns.max(end_ns),
            _ => {
                self.now_ns = until_ns;
                return 0;
            }
        }
        fill(bytes, || self.bus.take(self.now_ns))
    }

    fn clear(&mut self) {
        while self.bus.take(self.now_ns).is_some() {}
    }

    fn now(&self) -> Duration {
        Duration::from_nanos(self.now_ns)
    }

    fn pause(&mut self, time: Duration) {
        self.now_ns += nanoseconds(time);
        self.bus.advance(self.now_ns);
    }

    fn latency(&self) -> Duration {
        Duration::from_micros(100)
    }
}
