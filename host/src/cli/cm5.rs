//! A CM-5 before simulated servos: the firmware's own logic, on this computer, in simulated time.
//!
//! The library knows nothing of the firmware; only this file and what opens it do. Time passes on the lines alone: the
//! logic itself takes none here, as it does on the chip, so tick times are those of the bus.

use handstand::Result;
use handstand::bus_sim::Bus;
use handstand::link::Link;
use handstand_firmware::app::App;
use handstand_firmware::board::Board;
use handstand_firmware::design::{LINK_BAUD, TICK_US};
use handstand_shared::message::ResetCause;
use std::collections::VecDeque;
use std::time::Duration;

const TICK_NS: u64 = TICK_US as u64 * 1000;
const BUS_BYTE_NS: u64 = 10_000;
const LINK_BYTE_NS: u64 = 10_000_000_000 / LINK_BAUD as u64;
/// The chip's queue towards the PC.
const ROOM: usize = 255;
const EEPROM_BYTE_NS: u64 = 8_500_000;

/// Controller, servos and the line between them and the PC.
pub struct Cm5 {
    app: App,
    board: Desk,
    /// Speed of the PC's end, baud.
    baud: u32,
    last_in_ns: u64,
}

/// The board the logic runs on: queues and a clock.
struct Desk {
    now_ns: u64,
    next_tick_ns: u64,
    bus: Bus,
    /// Bytes from the PC with the times they end.
    from_pc: VecDeque<(u64, u8)>,
    /// Bytes to the PC with the times they end.
    to_pc: VecDeque<(u64, u8)>,
    last_out_ns: u64,
    eeprom: Vec<u8>,
    eeprom_ready_ns: u64,
}

impl Cm5 {
    /// Just switched on.
    pub fn new(bus: Bus) -> Self {
        let mut board = Desk {
            now_ns: 0,
            next_tick_ns: TICK_NS,
            bus,
            from_pc: VecDeque::new(),
            to_pc: VecDeque::new(),
            last_out_ns: 0,
            eeprom: vec![0xff; 4096],
            eeprom_ready_ns: 0,
        };
        Cm5 {
            app: App::boot(&mut board),
            board,
            baud: LINK_BAUD,
            last_in_ns: 0,
        }
    }

    /// Runs until `until_ns`, or until a byte for the PC has arrived if `listening`.
    fn run(&mut self, until_ns: u64, listening: bool) {
        loop {
            self.app.run(&mut self.board);
            let board = &mut self.board;
            let arrived = board
                .to_pc
                .front()
                .is_some_and(|(ends, _)| *ends <= board.now_ns);
            if board.now_ns >= until_ns || (listening && arrived) {
                return;
            }
            let next = [
                Some(until_ns),
                Some(board.next_tick_ns),
                board.from_pc.front().map(|(ends, _)| *ends),
                board
                    .to_pc
                    .front()
                    .map(|(ends, _)| *ends)
                    .filter(|_| listening),
                board.bus.next_ns(),
            ];
            // What lies in the past was offered and not taken.
            let next = next
                .into_iter()
                .flatten()
                .filter(|at| *at > board.now_ns)
                .min();
            board.now_ns = next.unwrap_or(until_ns);
        }
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
        if !self.is_heard() {
            return Ok(());
        }
        for byte in bytes {
            self.last_in_ns = self.last_in_ns.max(self.board.now_ns) + LINK_BYTE_NS;
            self.board.from_pc.push_back((self.last_in_ns, *byte));
        }
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
        self.run(self.board.now_ns + nanoseconds(wait), true);
        let mut count = 0;
        while let Some(slot) = bytes.get_mut(count) {
            match self.board.to_pc.front() {
                Some((ends, byte)) if *ends <= self.board.now_ns => *slot = *byte,
                _ => break,
            }
            self.board.to_pc.pop_front();
            count += 1;
        }
        Ok(if self.is_heard() { count } else { 0 })
    }

    fn clear(&mut self) -> Result<()> {
        let now_ns = self.board.now_ns;
        self.board.to_pc.retain(|(ends, _)| *ends > now_ns);
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_nanos(self.board.now_ns)
    }

    fn pause(&mut self, time: Duration) {
        self.run(self.board.now_ns + nanoseconds(time), false);
    }

    fn latency(&self) -> Duration {
        Duration::from_millis(1)
    }
}

impl Board for Desk {
    fn clock(&self) -> u16 {
        (self.now_ns / 500) as u16
    }

    fn tick_due(&mut self) -> bool {
        let due = self.now_ns >= self.next_tick_ns;
        if due {
            self.next_tick_ns += TICK_NS;
            self.bus.advance(self.now_ns);
        }
        due
    }

    fn feed_watchdog(&mut self) {}

    fn bus_send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.now_ns += BUS_BYTE_NS;
            self.bus.hear(self.now_ns, *byte);
        }
    }

    fn bus_receive(&mut self, within_us: u16) -> Option<u8> {
        let until_ns = self.now_ns + u64::from(within_us) * 1000;
        match self.bus.take(until_ns) {
            Some((ends, byte)) => {
                self.now_ns = self.now_ns.max(ends);
                Some(byte)
            }
            None => {
                self.now_ns = until_ns;
                None
            }
        }
    }

    fn bus_flush(&mut self) {
        while self.bus.take(self.now_ns).is_some() {}
    }

    fn link_receive(&mut self) -> Option<u8> {
        let (ends, _) = self.from_pc.front()?;
        if *ends > self.now_ns {
            return None;
        }
        self.from_pc.pop_front().map(|(_, byte)| byte)
    }

    fn link_overruns(&mut self) -> u8 {
        0
    }

    fn link_room(&self) -> usize {
        let waiting = self
            .to_pc
            .iter()
            .filter(|(ends, _)| *ends > self.now_ns)
            .count();
        ROOM.saturating_sub(waiting)
    }

    fn link_send(&mut self, bytes: &[u8]) {
        for byte in bytes.iter().take(self.link_room()) {
            self.last_out_ns = self.last_out_ns.max(self.now_ns) + LINK_BYTE_NS;
            self.to_pc.push_back((self.last_out_ns, *byte));
        }
    }

    fn buttons(&mut self) -> u8 {
        0
    }

    fn set_leds(&mut self, _leds: u8) {}

    fn gyro(&mut self) -> u16 {
        let rate_rad_s = self.bus.robot().map_or(0.0, |robot| robot.rate_rad_s());
        gyro_code(rate_rad_s)
    }

    fn eeprom_read(&mut self, address: u16) -> u8 {
        self.eeprom
            .get(usize::from(address))
            .copied()
            .unwrap_or(0xff)
    }

    fn eeprom_write(&mut self, address: u16, byte: u8) -> bool {
        if !self.eeprom_ready() {
            return false;
        }
        if let Some(slot) = self.eeprom.get_mut(usize::from(address)) {
            *slot = byte;
        }
        self.eeprom_ready_ns = self.now_ns + EEPROM_BYTE_NS;
        true
    }

    fn eeprom_ready(&self) -> bool {
        self.now_ns >= self.eeprom_ready_ns
    }

    fn reset_cause(&self) -> ResetCause {
        ResetCause(ResetCause::POWER)
    }

    fn stack(&self) -> (u16, u16) {
        (0, 0)
    }
}

/// A gyro of one code per degree and second, 512 at rest.
fn gyro_code(rate_rad_s: f64) -> u16 {
    (512.0 + rate_rad_s.to_degrees()).round().clamp(0.0, 1023.0) as u16
}

fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos())
        .unwrap_or(u64::MAX)
        .min(u64::MAX / 4)
}
