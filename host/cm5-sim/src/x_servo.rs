//! One simulated servo of Protocol 2.0: control table, shaft, hardware errors, bus watchdog.
//!
//! Not simulated: indirect addresses, time-based profiles, gains (the loop is a fixed proportional
//! one), and a robot on the shafts, which turn freely.

use super::fault::Faults;
use super::shaft::Shaft;
use handstand_shared::control_table::models::ServoModel;
use handstand_shared::control_table::x::*;
use handstand_shared::control_table::{
    Item, POSITION_CENTRE, POSITION_LSB_RAD, SPEED_LSB_RAD_S, WATCHDOG_LSB_MS,
};

/// Bytes of the control table.
pub(super) const TABLE: usize = 148;
/// Time constant with which a shaft follows its motor, s; assumed.
const TIME_CONSTANT_S: f64 = 0.02;
/// Error of position from which the motor has full output, rad; assumed.
const FULL_OUTPUT_RAD: f64 = 0.5;

/// A simulated servo of the X or MX(2.0) series.
#[derive(Debug)]
pub struct XServo {
    /// Which model it is.
    pub model: &'static ServoModel,
    pub(super) table: [u8; TABLE],
    pub(super) registered: Option<(u16, Vec<u8>)>,
    pub(super) silent_until_ns: u64,
    /// When the bus watchdog last heard of its host, ns.
    pub(super) heard_ns: u64,
    /// Where the shaft is held since the bus watchdog tripped, rad.
    held_rad: Option<f64>,
    /// What goes wrong with its answers.
    pub faults: Faults,
    /// The shaft; its angle is not bound to one turn.
    pub shaft: Shaft,
    /// Whether something blocks the shaft.
    pub jammed: bool,
    /// Supply, V.
    pub supply_v: f64,
    /// Temperature, degrees Celsius.
    pub temperature: f64,
    /// From the end of a request to the answer beside the return delay, ns.
    pub turnaround_ns: u64,
    output: f64,
}

impl XServo {
    /// Factory settings but for the id, 1000000 baud and a return delay of 0; torque off, in the
    /// middle of its turn, the supply in the middle of its limits.
    pub fn new(model: &'static ServoModel, id: u8, firmware: u8) -> Self {
        let mut servo = XServo {
            model,
            table: [0; TABLE],
            registered: None,
            silent_until_ns: 0,
            heard_ns: 0,
            held_rad: None,
            faults: Faults::none(u64::from(id)),
            shaft: Shaft {
                angle_rad: 0.0,
                speed_rad_s: 0.0,
            },
            jammed: false,
            supply_v: f64::from(model.supply.0 + model.supply.1) * 0.05,
            temperature: 30.0,
            // Measured on MX-64 and MX-106 by others (resibots/dynamixel_control_hw, issue 7).
            turnaround_ns: 50_000,
            output: 0.0,
        };
        servo.set(MODEL, i32::from(model.number));
        servo.set(FIRMWARE, i32::from(firmware));
        servo.reset();
        servo.set(ID, i32::from(id));
        servo.set(BAUD, 3);
        servo.set(RETURN_DELAY, 0);
        servo
    }

    /// Factory settings.
    pub(super) fn reset(&mut self) {
        let model = self.model;
        for (item, code) in [
            (ID, 1),
            (BAUD, 1),
            (RETURN_DELAY, 250),
            (DRIVE_MODE, 0),
            (OPERATING_MODE, 3),
            (SHADOW_ID, 255),
            (PROTOCOL, 2),
            (HOMING_OFFSET, 0),
            (MOVING_THRESHOLD, 10),
            (TEMPERATURE_LIMIT, i32::from(model.temperature_limit)),
            (MAX_VOLTAGE, i32::from(model.supply.1)),
            (MIN_VOLTAGE, i32::from(model.supply.0)),
            (PWM_LIMIT, 885),
            (CURRENT_LIMIT, i32::from(model.current_limit)),
            (ACCELERATION_LIMIT, 32767),
            (VELOCITY_LIMIT, i32::from(model.velocity_limit)),
            (MAX_POSITION, 4095),
            (MIN_POSITION, 0),
            (STARTUP, 0),
            (PWM_SLOPE, 140),
            (SHUTDOWN, i32::from(model.shutdown)),
        ] {
            if model.has(&item) {
                self.set(item, code);
            }
        }
        self.reboot();
    }

    /// RAM as after power-up.
    pub(super) fn reboot(&mut self) {
        self.table[64..].fill(0);
        self.set(STATUS_LEVEL, 2);
        let [vi, vp, pd, pi, pp] = self.model.gains.map(i32::from);
        for (item, code) in [
            (VELOCITY_I, vi),
            (VELOCITY_P, vp),
            (POSITION_D, pd),
            (POSITION_I, pi),
            (POSITION_P, pp),
            (GOAL_PWM, 885),
        ] {
            self.set(item, code);
        }
        if self.model.current_lsb_a.is_some() {
            self.set(GOAL_CURRENT, i32::from(self.model.current_limit));
        }
        self.held_rad = None;
        self.measure();
        self.set(GOAL_POSITION, self.get(PRESENT_POSITION));
    }

    /// Its id.
    pub fn id(&self) -> u8 {
        self.get(ID) as u8
    }

    /// A register's code.
    pub fn get(&self, item: Item) -> i32 {
        let at = usize::from(item.address);
        let bytes = self.table.get(at..at + usize::from(item.size));
        bytes.and_then(|bytes| item.code(bytes)).unwrap_or(0)
    }

    /// Sets a register, whoever may.
    pub fn set(&mut self, item: Item, code: i32) {
        let (at, size) = (usize::from(item.address), usize::from(item.size));
        self.table[at..at + size].copy_from_slice(&item.bytes(code)[..size]);
    }

    /// Whether its torque is on.
    pub fn torque_is_on(&self) -> bool {
        self.get(TORQUE_ENABLE) != 0
    }

    /// Whether the bus watchdog has tripped and was not cleared.
    pub fn watchdog_has_tripped(&self) -> bool {
        self.get(BUS_WATCHDOG) == -1
    }

    /// Sets bits of the hardware error status; torque goes off where the shutdown mask has one.
    pub fn fail(&mut self, bits: u8) {
        let bits = i32::from(bits);
        self.set(HARDWARE_ERROR, self.get(HARDWARE_ERROR) | bits);
        if self.get(SHUTDOWN) & bits != 0 {
            self.set(TORQUE_ENABLE, 0);
        }
    }

    /// Sets the hardware error that a load makes which it cannot hold.
    pub fn overload(&mut self) {
        self.fail(1 << 5);
    }

    /// Whether it runs at the line's speed; a UART tolerates 3 %.
    pub(super) fn understands(&self, line_baud: u32) -> bool {
        let own = baud_of(self.get(BAUD) as u8).unwrap_or(1);
        (f64::from(line_baud) / f64::from(own) - 1.0).abs() < 0.03
    }

    /// Advance to `now_ns`, `dt_s` after the last time, and measure.
    pub(super) fn step(&mut self, now_ns: u64, dt_s: f64) {
        self.watch(now_ns);
        let full_rad_s = f64::from(self.model.velocity_limit) * SPEED_LSB_RAD_S;
        self.output = if self.torque_is_on() {
            self.wanted_output()
        } else {
            0.0
        };
        let mut wanted_rad_s = self.output * full_rad_s;
        let profile_rad_s = f64::from(self.get(PROFILE_VELOCITY)) * SPEED_LSB_RAD_S;
        if profile_rad_s > 0.0 && self.held_rad.is_none() {
            wanted_rad_s = wanted_rad_s.clamp(-profile_rad_s, profile_rad_s);
        }
        let shaft = &mut self.shaft;
        if self.jammed {
            shaft.speed_rad_s = 0.0
        } else {
            let share = (dt_s / TIME_CONSTANT_S).min(1.0);
            shaft.speed_rad_s += (wanted_rad_s - shaft.speed_rad_s) * share;
        }
        shaft.angle_rad += shaft.speed_rad_s * dt_s;
        self.measure();
    }

    /// Trips the bus watchdog if no instruction came in time.
    fn watch(&mut self, now_ns: u64) {
        let code = self.get(BUS_WATCHDOG);
        let most_ns = code.max(0) as u64 * u64::from(WATCHDOG_LSB_MS) * 1_000_000;
        if code > 0 && self.torque_is_on() && now_ns > self.heard_ns + most_ns {
            self.set(BUS_WATCHDOG, -1);
            self.held_rad = Some(self.shaft.angle_rad);
        }
    }

    /// The bus watchdog was written.
    pub(super) fn rearm(&mut self, now_ns: u64) {
        self.heard_ns = now_ns;
        if !self.watchdog_has_tripped() {
            self.held_rad = None;
        }
    }

    fn wanted_output(&self) -> f64 {
        let towards = |goal_rad: f64| (goal_rad - self.shaft.angle_rad) / FULL_OUTPUT_RAD;
        let share = |code: i32, most: u16| f64::from(code) / f64::from(most.max(1));
        let output = match (self.held_rad, self.get(OPERATING_MODE)) {
            (Some(held_rad), _) => towards(held_rad),
            (None, 0) => share(self.get(GOAL_CURRENT), self.model.current_limit),
            (None, 1) => share(self.get(GOAL_VELOCITY), self.model.velocity_limit),
            (None, 16) => share(self.get(GOAL_PWM), 885),
            (None, _) => {
                let code = self.get(GOAL_POSITION) - self.get(HOMING_OFFSET) - POSITION_CENTRE;
                towards(f64::from(code) * POSITION_LSB_RAD)
            }
        };
        output.clamp(-1.0, 1.0)
    }

    pub(super) fn measure(&mut self) {
        let full_rad_s = f64::from(self.model.velocity_limit) * SPEED_LSB_RAD_S;
        let position = (self.shaft.angle_rad / POSITION_LSB_RAD).round() as i32;
        self.set(
            PRESENT_POSITION,
            position + POSITION_CENTRE + self.get(HOMING_OFFSET),
        );
        let speed = (self.shaft.speed_rad_s / SPEED_LSB_RAD_S).round() as i32;
        self.set(PRESENT_VELOCITY, speed);
        self.set(PRESENT_PWM, (self.output * 885.0).round() as i32);
        // What the speed leaves of the output drives current.
        let drop = self.output - self.shaft.speed_rad_s / full_rad_s.max(f64::MIN_POSITIVE);
        match self.model.current_lsb_a {
            Some(_) => {
                let most = f64::from(self.model.current_limit);
                self.set(PRESENT_CURRENT, (drop * most).round() as i32);
            }
            None => self.set(PRESENT_LOAD, (drop * 1000.0).round() as i32),
        }
        let supply = (self.supply_v * 10.0).round() as i32;
        self.set(PRESENT_VOLTAGE, supply);
        self.set(PRESENT_TEMPERATURE, self.temperature.round() as i32);
        self.set(MOVING, i32::from(self.get(PRESENT_VELOCITY).abs() > 10));
        let is_off = supply < self.get(MIN_VOLTAGE) || supply > self.get(MAX_VOLTAGE);
        let is_hot = self.get(PRESENT_TEMPERATURE) > self.get(TEMPERATURE_LIMIT);
        let bits = u8::from(is_off) | u8::from(is_hot) << 2;
        if bits != 0 {
            self.fail(bits);
        }
    }
}
