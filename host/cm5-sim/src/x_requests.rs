//! Execute instructions of Protocol 2.0 on a servo's control table.

use super::x_servo::{TABLE, XServo};
use handstand_shared::control_table::Access;
use handstand_shared::control_table::x::*;
use handstand_shared::dynamixel2::{ErrorByte, Request};

/// A reboot or factory reset silences a servo for so long, ns; assumed.
const RESTART_NS: u64 = 100_000_000;
/// A write into EEPROM, ns for each byte; assumed to be as the AX-12's.
const EEPROM_NS: u64 = 6_000_000;

/// What a servo answers: error code and data.
pub(super) type Answer = (u8, Vec<u8>);

const ACCESS: u8 = 7;
const RESULT: u8 = 1;
const INSTRUCTION: u8 = 2;
const RANGE: u8 = 4;
const LENGTH: u8 = 5;
const LIMIT: u8 = 6;

impl XServo {
    /// Execute an instruction for this servo alone, received at `now_ns`; what it answers, whatever
    /// its status return level, and from which level on.
    pub(super) fn execute(&mut self, now_ns: u64, request: Request) -> (Answer, i32) {
        self.heard_ns = now_ns;
        self.measure();
        let done = |error: u8| (error, Vec::new());
        match request {
            Request::Ping => {
                let [low, high] = self.model.number.to_le_bytes();
                ((0, vec![low, high, self.get(FIRMWARE) as u8]), 0)
            }
            Request::Read { address, count } => (self.read(address, count), 1),
            Request::Write { address, data } => (done(self.write(now_ns, address, data)), 2),
            Request::RegWrite { address, data } => {
                self.registered = Some((address, data.to_vec()));
                self.set(REGISTERED, 1);
                (done(0), 2)
            }
            Request::Action => {
                self.set(REGISTERED, 0);
                let error = match self.registered.take() {
                    Some((address, data)) => self.write(now_ns, address, &data),
                    None => INSTRUCTION,
                };
                (done(error), 2)
            }
            Request::FactoryReset(kept) => {
                let (id, baud) = (self.get(ID), self.get(BAUD));
                self.reset();
                if kept != 0xff {
                    self.set(ID, id);
                }
                if kept == 2 {
                    self.set(BAUD, baud);
                }
                self.silent_until_ns = now_ns + RESTART_NS;
                (done(0), 2)
            }
            Request::Reboot => {
                self.reboot();
                self.silent_until_ns = now_ns + RESTART_NS;
                (done(0), 2)
            }
            Request::Clear => (done(self.clear_turns()), 2),
            // Nothing in the simulation needs what a backup stores.
            Request::Backup { .. } => (done(u8::from(self.torque_is_on()) * RESULT), 2),
            Request::SyncRead { .. }
            | Request::SyncWrite { .. }
            | Request::BulkRead { .. }
            | Request::BulkWrite { .. } => (done(INSTRUCTION), 2),
        }
    }

    /// The answer to a read of `count` bytes.
    pub(super) fn read(&self, address: u16, count: u16) -> Answer {
        let from = usize::from(address);
        match self.table.get(from..from + usize::from(count)) {
            Some(bytes) => (0, bytes.to_vec()),
            None => (ACCESS, Vec::new()),
        }
    }

    /// Its error byte with this code.
    pub(super) fn error_byte(&self, code: u8) -> ErrorByte {
        let alert = match self.get(HARDWARE_ERROR) {
            0 => 0,
            _ => ErrorByte::ALERT,
        };
        ErrorByte(alert | code)
    }

    fn clear_turns(&mut self) -> u8 {
        if self.get(MOVING) != 0 {
            return RESULT;
        }
        let turn = 2.0 * std::f64::consts::PI;
        let from_zero = self.shaft.angle_rad + turn / 2.0;
        self.shaft.angle_rad = from_zero.rem_euclid(turn) - turn / 2.0;
        self.measure();
        0
    }

    /// All or nothing: a value that is refused changes no register. Returns the error code.
    pub(super) fn write(&mut self, now_ns: u64, address: u16, data: &[u8]) -> u8 {
        let (from, to) = (usize::from(address), usize::from(address) + data.len());
        if to > TABLE {
            return ACCESS;
        }
        let items = self.model.items().filter(|item| {
            let at = usize::from(item.address);
            at < to && from < at + usize::from(item.size)
        });
        let items: Vec<_> = items.copied().collect();
        if items.is_empty() {
            return ACCESS;
        }
        for item in &items {
            let at = usize::from(item.address);
            let bytes = at.checked_sub(from).and_then(|at| data.get(at..));
            let bytes = bytes.and_then(|bytes| bytes.get(..usize::from(item.size)));
            let is_locked = item.is_eeprom && self.torque_is_on();
            if item.access == Access::Read || is_locked {
                return ACCESS;
            }
            let Some(code) = bytes.and_then(|bytes| item.code(bytes)) else {
                return LENGTH;
            };
            let least = if *item == BUS_WATCHDOG { 0 } else { item.min };
            let is_goal = matches!(item.address, 100 | 102 | 104 | 116);
            if !(least..=item.max).contains(&code) || is_goal && self.watchdog_has_tripped() {
                return RANGE;
            }
            let within = self.get(MIN_POSITION)..=self.get(MAX_POSITION);
            let is_bound = *item == GOAL_POSITION && self.get(OPERATING_MODE) == 3;
            if is_bound && !within.contains(&code) {
                return LIMIT;
            }
        }
        self.table[from..to].copy_from_slice(data);
        let written = |one| items.contains(&one);
        if written(TORQUE_ENABLE) && self.get(HARDWARE_ERROR) & self.get(SHUTDOWN) != 0 {
            self.set(TORQUE_ENABLE, 0);
        }
        if written(BUS_WATCHDOG) {
            self.rearm(now_ns);
        }
        if items[0].is_eeprom {
            self.silent_until_ns = now_ns + EEPROM_NS * data.len() as u64;
        }
        0
    }
}
