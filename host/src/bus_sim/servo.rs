//! One AX-12: its control table, what it does with requests, and its position regulator.

use super::fault::Faults;
use super::motor::Motor;
use handstand_shared::control_table::*;
use handstand_shared::dynamixel::{BROADCAST, ErrorBits, Request, Status};
use handstand_shared::raw::{MovingSpeed, Position, Signed};

const TABLE: usize = 50;
/// An EEPROM write keeps a servo silent, per byte, ns.
const EEPROM_NS: u64 = 6_000_000;

/// A simulated servo.
#[derive(Debug)]
pub struct Servo {
    table: [u8; TABLE],
    registered: Option<(u8, Vec<u8>)>,
    silent_until_ns: u64,
    /// What goes wrong with its answers.
    pub faults: Faults,
    /// The shaft. Set it from outside to hang a robot on it; `free` then has to be false.
    pub shaft: Motor,
    /// Whether the shaft moves on its own, without load.
    pub free: bool,
    /// Load to report, as a share of full output, counter-clockwise positive; of a free shaft its own.
    pub load: f64,
    /// Supply, V.
    pub supply_v: f64,
    /// Temperature, degrees Celsius.
    pub temperature: f64,
    /// Requests heard while silent after an EEPROM write, or dead.
    pub ignored: u64,
}

/// What the regulator makes of the registers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Output {
    /// Share of full output, with torque off nothing.
    drive: Drive,
    /// Torque limit, of full output.
    pub limit: f64,
    /// Largest speed, rad/s.
    pub speed_limit_rad_s: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Drive {
    Off,
    Wheel(f64),
    Joint {
        goal_rad: f64,
        margin_rad: f64,
        slope_rad: f64,
        punch: f64,
    },
}

impl Output {
    /// Share of full output at this angle, counter-clockwise positive.
    pub fn duty(&self, angle_rad: f64) -> f64 {
        let duty = match self.drive {
            Drive::Off => 0.0,
            Drive::Wheel(output) => output,
            Drive::Joint {
                goal_rad,
                margin_rad,
                slope_rad,
                punch,
            } => {
                let error = goal_rad - angle_rad;
                let beyond = (error.abs() - margin_rad).max(0.0);
                let share = if beyond > 0.0 {
                    punch + beyond / slope_rad
                } else {
                    0.0
                };
                share.min(1.0).copysign(error)
            }
        };
        duty.clamp(-self.limit, self.limit)
    }
}

impl Servo {
    /// Factory settings but for the id and a return delay of 0; on its back, torque off, 9.6 V, 30 degrees.
    pub fn new(id: u8) -> Self {
        let mut servo = Servo {
            table: [0; TABLE],
            registered: None,
            silent_until_ns: 0,
            faults: Faults::none(u64::from(id)),
            shaft: Motor {
                angle_rad: 0.0,
                speed_rad_s: 0.0,
            },
            free: true,
            load: 0.0,
            supply_v: 9.6,
            temperature: 30.0,
            ignored: 0,
        };
        for register in REGISTERS {
            servo.set(*register, register.default);
        }
        servo.set(ID, u16::from(id));
        servo.set(RETURN_DELAY, 0);
        servo.set(GOAL_POSITION, Position::CENTRE.0);
        servo
    }

    /// Its id.
    pub fn id(&self) -> u8 {
        self.get(ID) as u8
    }

    /// A register's code.
    pub fn get(&self, register: Register) -> u16 {
        let at = usize::from(register.address);
        match register.size {
            1 => u16::from(self.table[at]),
            _ => u16::from_le_bytes([self.table[at], self.table[at + 1]]),
        }
    }

    /// Sets a register, whoever may.
    pub fn set(&mut self, register: Register, code: u16) {
        let at = usize::from(register.address);
        let bytes = code.to_le_bytes();
        let size = usize::from(register.size);
        self.table[at..at + size].copy_from_slice(&bytes[..size]);
    }

    /// Whether its torque is on.
    pub fn torque_is_on(&self) -> bool {
        self.get(TORQUE_ENABLE) != 0
    }

    /// When within each millisecond its motor interrupt comes, ns: in each servo at another moment, scattered by a
    /// hash, for servos started together would all stall a regular reader alike.
    pub(super) fn stall_phase_ns(&self) -> u64 {
        ((u64::from(self.id()) * 2_654_435_761) >> 8) % 1_000_000
    }

    /// What drives its motor now.
    pub fn output(&self) -> Output {
        let wheel = self.get(CW_LIMIT) == 0 && self.get(CCW_LIMIT) == 0;
        let drive = if !self.torque_is_on() {
            Drive::Off
        } else if wheel {
            let command = Signed(self.get(MOVING_SPEED)).get();
            Drive::Wheel(f64::from(command) * Signed::OUTPUT_LSB)
        } else {
            self.joint()
        };
        let speed = MovingSpeed(self.get(MOVING_SPEED));
        Output {
            drive,
            limit: f64::from(self.get(TORQUE_LIMIT)) / 1023.0,
            speed_limit_rad_s: if wheel {
                f64::INFINITY
            } else {
                speed.to_rad_s()
            },
        }
    }

    fn joint(&self) -> Drive {
        let goal = Position(self.get(GOAL_POSITION));
        let ccw = goal.to_rad() > self.shaft.angle_rad;
        let (margin, slope) = if ccw {
            (CCW_MARGIN, CCW_SLOPE)
        } else {
            (CW_MARGIN, CW_SLOPE)
        };
        // The slope snaps to the next lower power of two: 2, 4, .. 128.
        let slope = 1 << self.get(slope).clamp(2, 128).ilog2();
        Drive::Joint {
            goal_rad: goal.to_rad(),
            margin_rad: f64::from(self.get(margin)) * Position::LSB_RAD,
            slope_rad: f64::from(slope) * Position::LSB_RAD,
            punch: f64::from(self.get(PUNCH)) / 1023.0,
        }
    }

    /// Goes on by `dt_s`, if the shaft is its own, and measures.
    pub fn step(&mut self, dt_s: f64) {
        if self.free {
            let output = self.output();
            self.shaft.step(&output, dt_s);
            self.load = output.duty(self.shaft.angle_rad);
        }
        self.measure();
    }

    fn measure(&mut self) {
        let speed = (self.shaft.speed_rad_s / Signed::SPEED_LSB_RAD_S).round() as i16;
        let load = (self.load / Signed::OUTPUT_LSB).round() as i16;
        self.set(PRESENT_POSITION, Position::from_rad(self.shaft.angle_rad).0);
        self.set(PRESENT_SPEED, Signed::new(speed).0);
        self.set(PRESENT_LOAD, Signed::new(load).0);
        self.set(
            PRESENT_SUPPLY,
            (self.supply_v * 10.0).round().clamp(0.0, 255.0) as u16,
        );
        self.set(
            PRESENT_TEMPERATURE,
            self.temperature.round().clamp(0.0, 255.0) as u16,
        );
        let goal = Position(self.get(GOAL_POSITION)).to_rad();
        let moving =
            self.torque_is_on() && (goal - self.shaft.angle_rad).abs() > 2.0 * Position::LSB_RAD;
        self.set(MOVING, u16::from(moving));
    }

    /// Obeys a request heard at `now_ns`; the answer, its delay in ns, and this servo's id.
    pub(super) fn hear(
        &mut self,
        now_ns: u64,
        id: u8,
        request: Request,
    ) -> Option<(Vec<u8>, u64, u8)> {
        if id != self.id() && id != BROADCAST {
            return None;
        }
        if self.faults.dead || now_ns < self.silent_until_ns {
            self.ignored += 1;
            return None;
        }
        self.measure();
        let (me, delay_ns) = (self.id(), u64::from(self.get(RETURN_DELAY)) * 2000);
        let mut error = ErrorBits(self.alarm());
        let mut data = Vec::new();
        let answers_from = match request {
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
                let shaft = self.shaft;
                *self = Servo {
                    shaft,
                    ..Servo::new(1)
                };
                self.set(RETURN_DELAY, RETURN_DELAY.default);
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
        if id == BROADCAST || self.get(STATUS_LEVEL) < answers_from {
            return None;
        }
        let mut out = [0; 300];
        let status = Status {
            id: me,
            error,
            data: &data,
        };
        let length = status.emit(&mut out)?;
        let (bytes, late_ns) = self.faults.pass(out[..length].to_vec())?;
        Some((bytes, delay_ns + late_ns, me))
    }

    fn alarm(&self) -> u8 {
        let supply = self.get(PRESENT_SUPPLY);
        let low = supply < self.get(MIN_SUPPLY) || supply > self.get(MAX_SUPPLY);
        let hot = self.get(PRESENT_TEMPERATURE) > self.get(MAX_TEMPERATURE);
        u8::from(low) | u8::from(hot) << 2
    }

    /// All or nothing, as the servo does it: a value out of range changes no register.
    fn write(&mut self, now_ns: u64, address: u8, data: &[u8]) -> ErrorBits {
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
        // A goal switches torque on, as the servo's own firmware does.
        if REGISTERS
            .iter()
            .filter(touched)
            .any(|r| *r == GOAL_POSITION)
            && self.get(TORQUE_LIMIT) > 0
        {
            self.set(TORQUE_ENABLE, 1);
        }
        ErrorBits(0)
    }
}
