//! Execute Dynamixel requests on a servo's control table.

use super::servo::Servo;
use handstand_shared::control_table::*;
use handstand_shared::dynamixel::timing::EEPROM_NS;
use handstand_shared::dynamixel::{BROADCAST, ErrorBits, Request, Status};

impl Servo {
    /// Execute a request received from `began_ns` to `now_ns`; returns the reply's bytes and its
    /// delay, ns.
    pub(super) fn execute(
        &mut self,
        (began_ns, now_ns): (u64, u64),
        id: u8,
        request: Request,
    ) -> Option<(Vec<u8>, u64)> {
        if id != self.id() && id != BROADCAST {
            return None;
        }
        if self.faults.dead || now_ns < self.silent_until_ns {
            self.ignored += 1;
            return None;
        }
        if self.faults.corrupts_request() {
            return self.reject_checksum(id);
        }
        let is_read = matches!(request, Request::Ping | Request::Read { .. });
        if !is_read && began_ns < self.busy_until_ns {
            self.ignored += 1;
            return None;
        }
        self.measure();
        let (me, delay_ns) = (self.id(), self.delay_ns());
        let mut error = ErrorBits(self.alarm());
        let mut data = Vec::new();
        let replies_from = match request {
            Request::Ping => 0,
            Request::Read { address, count } => {
                let to = usize::from(address) + usize::from(count);
                match self.table.get(usize::from(address)..to) {
                    Some(bytes) => data = bytes.to_vec(),
                    None => error = error.with(ErrorBits::RANGE),
                }
                1
            }
            Request::Write { address, data } => {
                error = error.with(self.write(now_ns, address, data));
                2
            }
            Request::RegWrite { address, data } => {
                self.registered = Some((address, data.to_vec()));
                self.set(REGISTERED, 1);
                2
            }
            Request::Action => {
                match self.registered.take() {
                    Some((address, data)) => error = error.with(self.write(now_ns, address, &data)),
                    None => error = error.with(ErrorBits::INSTRUCTION),
                }
                self.set(REGISTERED, 0);
                2
            }
            Request::Reset => {
                self.reset();
                self.silent_until_ns = now_ns + 20 * EEPROM_NS;
                2
            }
            Request::SyncWrite {
                address,
                width,
                blocks,
            } => {
                let mine = |block: &&[u8]| block[0] == me;
                for block in blocks.chunks(usize::from(width) + 1).filter(mine) {
                    let _ = self.write(now_ns, address, &block[1..]);
                }
                return None;
            }
        };
        if id == BROADCAST || self.get(STATUS_LEVEL) < replies_from {
            return None;
        }
        self.reply(me, error, &data, delay_ns)
    }

    /// Reply to a packet for `id` with a wrong checksum; nothing is executed.
    pub(super) fn reject_checksum(&mut self, id: u8) -> Option<(Vec<u8>, u64)> {
        if id != self.id() || self.faults.dead || self.get(STATUS_LEVEL) == 0 {
            return None;
        }
        self.measure();
        let error = ErrorBits(self.alarm()).with(ErrorBits::CHECKSUM);
        self.reply(id, error, &[], self.delay_ns())
    }

    fn delay_ns(&self) -> u64 {
        u64::from(self.get(RETURN_DELAY)) * 2000
    }

    fn reply(
        &mut self,
        id: u8,
        error: ErrorBits,
        data: &[u8],
        delay_ns: u64,
    ) -> Option<(Vec<u8>, u64)> {
        let mut out = [0; 300];
        let length = Status { id, error, data }.emit(&mut out)?;
        let (bytes, late_ns) = self.faults.pass(out[..length].to_vec())?;
        Some((bytes, delay_ns + late_ns))
    }

    fn alarm(&self) -> u8 {
        let supply = self.get(PRESENT_SUPPLY);
        let low = supply < self.get(MIN_SUPPLY) || supply > self.get(MAX_SUPPLY);
        let hot = self.get(PRESENT_TEMPERATURE) > self.get(MAX_TEMPERATURE);
        u8::from(low) | u8::from(hot) << 2 | u8::from(self.protection.is_tripped()) << 5
    }

    /// All or nothing, as the servo does it: a value out of range changes no register.
    fn write(&mut self, now_ns: u64, address: u8, data: &[u8]) -> ErrorBits {
        if self.faults.ignore_writes {
            self.ignored += 1;
            return ErrorBits(0);
        }
        if self.faults.write_ns > 0 {
            self.busy_until_ns = now_ns + self.faults.write_ns;
        }
        let from = usize::from(address);
        let mut changed = self.table;
        let Some(slots) = changed.get_mut(from..from + data.len()) else {
            return ErrorBits::RANGE;
        };
        slots.copy_from_slice(data);
        let touched = |r: &&Register| {
            let at = usize::from(r.address);
            at < from + data.len() && from < at + usize::from(r.size)
        };
        let before = std::mem::replace(&mut self.table, changed);
        for register in REGISTERS.iter().filter(touched) {
            let code = self.get(*register);
            if register.access == Access::Read || !(register.min..=register.max).contains(&code) {
                self.table = before;
                return ErrorBits::RANGE;
            }
        }
        let in_eeprom = data
            .len()
            .min(usize::from(Register::RAM.saturating_sub(address)));
        if in_eeprom > 0 {
            self.silent_until_ns = now_ns + in_eeprom as u64 * EEPROM_NS;
        }
        if REGISTERS.iter().filter(touched).any(|r| *r == TORQUE_LIMIT) {
            self.recover();
        }
        // A goal switches torque on, as the servo's own firmware is said to.
        if REGISTERS
            .iter()
            .filter(touched)
            .any(|r| *r == GOAL_POSITION)
            && self.get(TORQUE_LIMIT) > 0
            && self.goal_switches_on
        {
            self.set(TORQUE_ENABLE, 1);
        }
        ErrorBits(0)
    }
}
