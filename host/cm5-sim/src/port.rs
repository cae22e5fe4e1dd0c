//! A CM-5 before simulated servos: the firmware's own logic, on this computer, in simulated time.
//!
//! The library knows nothing of the firmware; only this file and what opens it do.

use handstand::Result;
use handstand::bus_sim::Bus;
use handstand::link::Link;
use handstand_firmware::app::App;
use handstand_firmware::design::LINK_BAUD;
use handstand_firmware::desk::Desk;
use std::time::Duration;

/// Controller, servos and the line between them and the PC.
pub struct Cm5 {
    app: App,
    board: Desk<Bus>,
    /// Speed of the PC's end, baud.
    baud: u32,
}

impl Cm5 {
    /// Just switched on.
    pub fn new(bus: Bus) -> Self {
        let mut board = Desk::new(bus);
        Cm5 {
            app: App::boot(&mut board),
            board,
            baud: LINK_BAUD,
        }
    }

    fn run(&mut self, time: Duration, listening: bool) {
        let until_ns = self.board.now_ns() + nanoseconds(time);
        self.board.run(&mut self.app, until_ns, listening);
    }

    fn is_heard(&self) -> bool {
        (f64::from(self.baud) / f64::from(LINK_BAUD) - 1.0).abs() < 0.03
    }
}

impl Link for Cm5 {
    fn name(&self) -> &str {
        "sim-cm5"
    }

    fn baud(&self) -> u32 {
        self.baud
    }

    fn set_baud(&mut self, baud: u32) -> Result<()> {
        self.baud = baud.max(1);
        Ok(())
    }

    fn send(&mut self, bytes: &[u8]) -> Result<()> {
        if self.is_heard() {
            self.board.type_bytes(bytes);
        }
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
        self.run(wait, true);
        let mut count = 0;
        for slot in bytes {
            let Some((_, byte)) = self.board.arrived() else {
                break;
            };
            *slot = byte;
            count += 1;
        }
        Ok(if self.is_heard() { count } else { 0 })
    }

    fn clear(&mut self) -> Result<()> {
        while self.board.arrived().is_some() {}
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_nanos(self.board.now_ns())
    }

    fn pause(&mut self, time: Duration) {
        self.run(time, false);
    }

    fn latency(&self) -> Duration {
        Duration::from_millis(1)
    }
}

fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos())
        .unwrap_or(u64::MAX)
        .min(u64::MAX / 4)
}
