//! One AX-12: control table and measured values.

use super::fault::Faults;
use super::protection::Protection;
use super::shaft::Shaft;
use handstand_shared::control_table::*;
use handstand_shared::raw::{Position, Signed};

/// Bytes of the control table.
const TABLE: usize = 50;

/// A simulated servo.
#[derive(Debug)]
pub struct Servo {
    pub(super) table: [u8; TABLE],
    pub(super) registered: Option<(u8, Vec<u8>)>,
    pub(super) silent_until_ns: u64,
    /// It ignores writes before.
    pub(super) busy_until_ns: u64,
    /// Whether a goal switches torque on. Both are said of real servos.
    pub goal_switches_on: bool,
    /// Overload protection.
    pub protection: Protection,
    /// Distinguishes servos with the same id: the first one has the id itself.
    pub(super) serial: u64,
    /// What goes wrong with its answers.
    pub faults: Faults,
    /// The shaft. A plant that moves it sets it from outside; `free` is then false.
    pub shaft: Shaft,
    /// Whether the shaft moves on its own, without load.
    pub free: bool,
    /// Whether something blocks the shaft.
    pub jammed: bool,
    /// Load to report, as a share of full output, counter-clockwise positive; of a free shaft its
    /// own.
    pub load: f64,
    /// Supply, V.
    pub supply_v: f64,
    /// Temperature, degrees Celsius.
    pub temperature: f64,
    /// How fast it warms while its torque is on, degrees a second.
    pub warms_per_s: f64,
    /// Requests ignored while silent after an EEPROM write, or dead.
    pub ignored: u64,
}

impl Servo {
    /// Factory settings but for the id and a return delay of 0; on its back, torque off, 9.6 V, 30
    /// degrees.
    pub fn new(id: u8) -> Self {
        let mut servo = Servo {
            table: [0; TABLE],
            registered: None,
            silent_until_ns: 0,
            busy_until_ns: 0,
            goal_switches_on: true,
            protection: Protection::default(),
            serial: u64::from(id),
            faults: Faults::none(u64::from(id)),
            shaft: Shaft {
                angle_rad: 0.0,
                speed_rad_s: 0.0,
            },
            free: true,
            jammed: false,
            load: 0.0,
            supply_v: 9.6,
            temperature: 30.0,
            warms_per_s: 0.0,
            ignored: 0,
        };
        servo.reset();
        servo.set(ID, u16::from(id));
        servo.set(RETURN_DELAY, 0);
        servo
    }

    /// Factory settings.
    pub(super) fn reset(&mut self) {
        for register in REGISTERS {
            self.set(*register, register.default);
        }
        self.set(GOAL_POSITION, Position::CENTRE.0);
    }

    /// Loses its RAM, as it does when its supply dips or its plug moves: torque off, the torque
    /// limit as EEPROM has it, no speed limit, the goal where it stands.
    pub fn restart(&mut self) {
        for register in REGISTERS.iter().filter(|r| r.address >= Register::RAM) {
            self.set(*register, register.default);
        }
        self.set(TORQUE_LIMIT, self.get(MAX_TORQUE));
        self.registered = None;
        self.protection = Protection::default();
        self.measure();
        self.set(GOAL_POSITION, self.get(PRESENT_POSITION));
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

    /// Whether it runs at the line's speed; a UART tolerates 3 %.
    pub(super) fn understands(&self, line_baud: u32) -> bool {
        let own = f64::from(baud_of(self.get(BAUD) as u8));
        (f64::from(line_baud) / own - 1.0).abs() < 0.03
    }

    /// Advance by `dt_s`, the shaft too if it is free, and measure.
    pub fn step(&mut self, dt_s: f64) {
        let regulator = self.regulator();
        if self.jammed {
            self.shaft.speed_rad_s = 0.0;
        } else if self.free {
            self.shaft.step(&regulator, dt_s);
        }
        if self.free {
            self.load = regulator.duty(self.shaft.angle_rad);
        }
        self.protect(dt_s);
        self.measure();
    }

    pub(super) fn measure(&mut self) {
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
}
