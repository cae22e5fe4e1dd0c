//! A CM-5 board in process: queues, simulated servos and a simulated clock.
//!
//! Time passes on the lines alone: the logic itself takes none here, as it does on the chip, so
//! tick times are those of the bus.

use super::bus::Bus;
use handstand_firmware::app::App;
use handstand_firmware::board::Board;
use handstand_firmware::design::{LINK_BAUD, TICK_US};
use handstand_shared::dynamixel::timing::BYTE_NS;
use handstand_shared::message::ResetCause;
use std::collections::VecDeque;

const TICK_NS: u64 = TICK_US as u64 * 1000;
/// A byte of 8N1 on the PC line, ns.
const LINK_BYTE_NS: u64 = 10_000_000_000 / LINK_BAUD as u64;
/// The chip's queue from the PC, bytes.
const WAITING: usize = 127;
/// The chip's queue towards the PC, bytes.
const ROOM: usize = 255;
const EEPROM_BYTE_NS: u64 = 8_500_000;
/// Bytes of EEPROM.
const EEPROM_SIZE: usize = 4096;

/// The board on which [`App`] runs as on the chip.
#[derive(Debug)]
pub struct HostBoard {
    now_ns: u64,
    next_tick_ns: u64,
    /// The servos.
    pub bus: Bus,
    /// Bytes on a line, each with the moment its stop bit ends.
    from_pc: VecDeque<(u64, u8)>,
    /// Those that have arrived and were not taken, and those that found no room.
    waiting: VecDeque<u8>,
    lost: u8,
    to_pc: VecDeque<(u64, u8)>,
    /// When the line to the PC is free.
    free_ns: u64,
    /// Buttons held down, see [`handstand_firmware::panel::button`].
    pub buttons: u8,
    /// LEDs lit, see [`handstand_firmware::panel::led`].
    pub leds: u8,
    /// Time that the program takes for a byte from the PC, ns: none, unless a test is about it.
    pub byte_ns: u64,
    /// The same for a byte of EEPROM that is read, ns.
    pub eeprom_read_ns: u64,
    /// ADC code of the gyro, 0..=1023, used where no robot is attached.
    pub gyro: u16,
    /// The plan compiled into the program.
    pub compiled: Vec<u8>,
    /// Contents of the EEPROM.
    pub eeprom: Vec<u8>,
    eeprom_ready_ns: u64,
    /// Bytes of EEPROM written until the power fails, and the value of the torn byte.
    pub cut: Option<(u32, u8)>,
    /// The power has failed.
    pub dead: bool,
    /// Why the controller started.
    pub reset_cause: ResetCause,
    /// How often the watchdog was fed.
    pub feeds: u64,
    fed_ns: u64,
    /// The longest the watchdog was not fed, ns.
    pub longest_unfed_ns: u64,
}

impl HostBoard {
    /// Power on in front of these servos, the EEPROM erased.
    pub fn new(bus: Bus) -> Self {
        Self::at(0, bus)
    }

    /// The same at this time since power came to the servos, ns.
    pub fn at(now_ns: u64, bus: Bus) -> Self {
        HostBoard {
            now_ns,
            next_tick_ns: now_ns + TICK_NS,
            bus,
            from_pc: VecDeque::new(),
            waiting: VecDeque::new(),
            lost: 0,
            to_pc: VecDeque::new(),
            free_ns: 0,
            buttons: 0,
            leds: 0,
            byte_ns: 0,
            eeprom_read_ns: 0,
            gyro: GYRO_AT_REST,
            compiled: Vec::new(),
            eeprom: vec![0xff; EEPROM_SIZE],
            eeprom_ready_ns: 0,
            cut: None,
            dead: false,
            reset_cause: ResetCause(ResetCause::POWER),
            feeds: 0,
            fed_ns: now_ns,
            longest_unfed_ns: 0,
        }
    }

    /// Commands take as long as on the chip, where simavr measured them: 10 us for a byte from the
    /// PC, 8.8 ms to read the 1200 bytes of a plan.
    pub fn take_time(&mut self) {
        self.byte_ns = 10_000;
        self.eeprom_read_ns = 7_300;
    }

    /// Since power came, ns.
    pub fn now_ns(&self) -> u64 {
        self.now_ns
    }

    /// Queue bytes from the PC, at the line's own pace.
    pub fn send_bytes(&mut self, bytes: &[u8]) {
        let last_ns = self.from_pc.back().map_or(0, |(ends, _)| *ends);
        let ends = (1..).map(|count| last_ns.max(self.now_ns) + count * LINK_BYTE_NS);
        self.from_pc.extend(ends.zip(bytes.iter().copied()));
    }

    /// When the last byte queued by the PC arrives, ns; in the past if all have.
    pub fn last_byte_ns(&self) -> u64 {
        self.from_pc.back().map_or(0, |(ends, _)| *ends)
    }

    /// The next byte that has arrived at the PC, and the end of its stop bit, ns.
    pub fn take(&mut self) -> Option<(u64, u8)> {
        let (ends, _) = self.to_pc.front()?;
        (*ends <= self.now_ns).then(|| self.to_pc.pop_front())?
    }

    /// Bytes that the PC sent and the program has not taken.
    fn unread(&self) -> usize {
        self.from_pc.len() + self.waiting.len()
    }

    /// Whether there is a byte for the program to take.
    fn has_unread(&self) -> bool {
        let next = self.from_pc.front();
        !self.waiting.is_empty() || next.is_some_and(|(ends, _)| *ends <= self.now_ns)
    }

    /// Runs until `until_ns`, or until a byte has arrived at the PC if `until_byte`.
    pub fn run(&mut self, app: &mut App, until_ns: u64, until_byte: bool) {
        while !self.dead {
            let before = (self.now_ns, self.unread());
            app.run(self);
            self.bus.advance(self.now_ns);
            let to_pc = self.to_pc.front().map(|(ends, _)| *ends);
            let has_arrived = to_pc.is_some_and(|ends| ends <= self.now_ns);
            if self.now_ns >= until_ns || (until_byte && has_arrived) {
                return;
            }
            let goes_on = self.has_unread() && before != (self.now_ns, self.unread());
            if self.now_ns >= self.next_tick_ns || goes_on {
                // A tick was longer than its period, or a command took long: it goes on at once.
                // Where nothing happened although bytes wait, they wait for the next tick.
                continue;
            }
            let next = [
                Some(self.next_tick_ns),
                self.from_pc.front().map(|(ends, _)| *ends),
                to_pc.filter(|_| until_byte),
                self.bus.next_ns(),
            ];
            // What lies in the past was offered and not taken.
            let next = next.into_iter().flatten().filter(|at| *at > self.now_ns);
            self.now_ns = next.fold(until_ns, u64::min);
        }
    }
}

impl Board for HostBoard {
    fn clock(&self) -> u16 {
        (self.now_ns / 500) as u16
    }

    fn tick_due(&mut self) -> bool {
        let due = self.now_ns >= self.next_tick_ns;
        // The chip's timer has one flag: ticks that were missed are missed.
        while self.now_ns >= self.next_tick_ns {
            self.next_tick_ns += TICK_NS;
        }
        due
    }

    fn feed_watchdog(&mut self) {
        self.feeds += 1;
        self.longest_unfed_ns = self.longest_unfed_ns.max(self.now_ns - self.fed_ns);
        self.fed_ns = self.now_ns;
    }

    fn bus_send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.now_ns += BYTE_NS;
            self.bus.receive(self.now_ns, *byte);
        }
        // Who drives the bus does not hear it: a byte that began meanwhile is missed.
        self.bus.miss(self.now_ns + BYTE_NS - 1);
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

    fn wait(&mut self, us: u16) {
        self.now_ns += u64::from(us) * 1000;
        self.bus.miss(self.now_ns);
    }

    fn bus_flush(&mut self) {
        self.bus.miss(self.now_ns);
    }

    fn link_receive(&mut self) -> Option<u8> {
        while let Some((ends, byte)) = self.from_pc.front().copied()
            && ends <= self.now_ns
        {
            self.from_pc.pop_front();
            if self.waiting.len() < WAITING {
                self.waiting.push_back(byte);
            } else {
                self.lost = self.lost.saturating_add(1);
            }
        }
        let byte = self.waiting.pop_front()?;
        self.now_ns += self.byte_ns;
        Some(byte)
    }

    fn link_overruns(&mut self) -> u8 {
        std::mem::take(&mut self.lost)
    }

    fn link_room(&self) -> usize {
        let waiting = self.free_ns.saturating_sub(self.now_ns) / LINK_BYTE_NS;
        ROOM.saturating_sub(waiting as usize)
    }

    fn link_send(&mut self, bytes: &[u8]) {
        for byte in bytes.iter().take(self.link_room()) {
            self.free_ns = self.free_ns.max(self.now_ns) + LINK_BYTE_NS;
            self.to_pc.push_back((self.free_ns, *byte));
        }
    }

    fn buttons(&mut self) -> u8 {
        self.buttons
    }

    fn set_leds(&mut self, leds: u8) {
        self.leds = leds;
    }

    fn gyro(&mut self) -> u16 {
        let robot = self.bus.robot();
        robot.map_or(self.gyro, |robot| robot.gyro_code())
    }

    fn compiled_plan(&self, at: u16) -> Option<u8> {
        self.compiled.get(usize::from(at)).copied()
    }

    fn eeprom_read(&mut self, address: u16) -> u8 {
        self.now_ns = self.now_ns.max(self.eeprom_ready_ns) + self.eeprom_read_ns;
        let byte = self.eeprom.get(usize::from(address));
        byte.copied().unwrap_or(0xff)
    }

    fn eeprom_write(&mut self, address: u16, byte: u8) -> bool {
        if !self.eeprom_ready() {
            return false;
        }
        self.eeprom_ready_ns = self.now_ns + EEPROM_BYTE_NS;
        let mut written = byte;
        if let Some((left, torn)) = &mut self.cut {
            if *left == 0 {
                written = *torn;
                self.dead = true;
            } else {
                *left -= 1;
            }
        }
        if let Some(slot) = self.eeprom.get_mut(usize::from(address)) {
            *slot = written;
        }
        true
    }

    fn eeprom_ready(&self) -> bool {
        self.now_ns >= self.eeprom_ready_ns
    }

    fn reset_cause(&self) -> ResetCause {
        self.reset_cause
    }

    fn stack(&mut self) -> (u16, u16) {
        (0, 0)
    }
}

const GYRO_AT_REST: u16 = 512;
