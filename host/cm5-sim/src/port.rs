//! Serial ports of simulated devices, in simulated time: nothing waits, the same requests get the
//! same replies.

use super::bus::Bus;
use super::cm5::{SimulatedCm5 as _, VirtualCm5};
use super::host_board::HostBoard;
use handstand_firmware::design::LINK_BAUD;
use handstand_shared::message::ResetCause;
use std::time::Duration;

/// The serial port of a simulated device.
pub trait SimulatedPort: Send {
    /// Name for the user.
    fn name(&self) -> &'static str;
    /// Speed of the PC's end, baud.
    fn baud(&self) -> u32;
    /// Set the speed of the PC's end, baud.
    fn set_baud(&mut self, baud: u32);
    /// Send bytes to the device.
    fn send(&mut self, bytes: &[u8]);
    /// Wait at most `wait` for bytes from the device; returns how many arrived.
    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> usize;
    /// Discard bytes that arrived and were not received.
    fn clear(&mut self);
    /// Simulated time since the port was there.
    fn now(&self) -> Duration;
    /// Let simulated time pass.
    fn pause(&mut self, time: Duration);
    /// The longest a byte may be late beyond the line's own time.
    fn latency(&self) -> Duration;
}

/// A CM-5 passes nothing on to the servos before, ms.
pub const STARTED_MS: f64 = 250.0;

/// The PC line of a CM-5 that runs the firmware's logic in process.
#[derive(Debug)]
pub struct Cm5Port {
    cm5: VirtualCm5,
    baud: u32,
    began_ns: u64,
}

impl Cm5Port {
    /// A CM-5 in front of these servos that has been on for [`STARTED_MS`].
    pub fn new(bus: Bus) -> Self {
        let mut cm5 = VirtualCm5::start(HostBoard::new(bus));
        cm5.run_ms(STARTED_MS);
        Cm5Port {
            began_ns: cm5.board.now_ns(),
            cm5,
            baud: LINK_BAUD,
        }
    }

    /// What the firmware is told from now on of why it started, as by a boot loader that leaves
    /// other flags.
    pub fn set_reset_cause(&mut self, flags: u8) {
        self.cm5.board.reset_cause = ResetCause(flags);
    }

    fn run(&mut self, time: Duration, until_byte: bool) {
        // No time is none: a tick that is due would take its own, call by call, and whoever asks
        // often enough would make the CM-5 run away from real time.
        if time.is_zero() {
            return;
        }
        let VirtualCm5 { board, app, .. } = &mut self.cm5;
        board.run(app, board.now_ns() + nanoseconds(time), until_byte);
    }

    fn is_understood(&self) -> bool {
        (f64::from(self.baud) / f64::from(LINK_BAUD) - 1.0).abs() < 0.03
    }
}

impl SimulatedPort for Cm5Port {
    fn name(&self) -> &'static str {
        "sim-cm5"
    }

    fn baud(&self) -> u32 {
        self.baud
    }

    fn set_baud(&mut self, baud: u32) {
        self.baud = baud.max(1);
    }

    fn send(&mut self, bytes: &[u8]) {
        if self.is_understood() {
            self.cm5.board.send_bytes(bytes);
        }
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> usize {
        self.run(wait, true);
        let count = fill(bytes, || self.cm5.board.take());
        if self.is_understood() { count } else { 0 }
    }

    fn clear(&mut self) {
        while self.cm5.board.take().is_some() {}
    }

    fn now(&self) -> Duration {
        Duration::from_nanos(self.cm5.board.now_ns() - self.began_ns)
    }

    fn pause(&mut self, time: Duration) {
        self.run(time, false);
    }

    fn latency(&self) -> Duration {
        Duration::from_millis(1)
    }
}

/// Fill `bytes` with those that are taken; returns how many.
pub(super) fn fill(bytes: &mut [u8], mut take: impl FnMut() -> Option<(u64, u8)>) -> usize {
    let mut count = 0;
    for slot in bytes {
        let Some((_, byte)) = take() else {
            break;
        };
        *slot = byte;
        count += 1;
    }
    count
}

/// At most a quarter of all the time there is, so that sums do not overflow.
pub(super) fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos())
        .unwrap_or(u64::MAX)
        .min(u64::MAX / 4)
}
