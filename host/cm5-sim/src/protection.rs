//! Overload protection of a servo.
//!
//! The e-manual: when the load can't be held, error bit 5 is set, and if the shutdown register has
//! that bit, the torque limit falls to 0 until it is written again. Duty and time are not
//! published; those here are assumed.

use super::servo::Servo;
use handstand_shared::control_table::{SHUTDOWN, TORQUE_ENABLE, TORQUE_LIMIT};
use handstand_shared::dynamixel::ErrorBits;

/// Duty cycle from which a stalled motor is overloaded.
const OVERLOAD_DUTY: f64 = 0.8;
/// Speed below which the motor is stalled, rad/s.
const STALL_RAD_S: f64 = 0.1;
/// Time in overload until the protection trips, s.
const TRIP_S: f64 = 1.0;

/// State of the overload protection.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Protection {
    overloaded_s: f64,
    tripped: bool,
}

impl Protection {
    /// Whether it has tripped, and the torque limit was not written since.
    pub fn is_tripped(&self) -> bool {
        self.tripped
    }
}

impl Servo {
    /// Update the protection, and the temperature that it looks at, after another `dt_s`.
    pub(super) fn protect(&mut self, dt_s: f64) {
        if self.get(TORQUE_ENABLE) != 0 {
            self.temperature += self.warms_per_s * dt_s;
        }
        let duty = self.regulator().duty(self.shaft.angle_rad);
        let is_overloaded =
            duty.abs() >= OVERLOAD_DUTY && self.shaft.speed_rad_s.abs() < STALL_RAD_S;
        let protection = &mut self.protection;
        protection.overloaded_s = if is_overloaded {
            protection.overloaded_s + dt_s
        } else {
            0.0
        };
        if protection.overloaded_s >= TRIP_S {
            self.overload();
        }
    }

    /// Trips the protection.
    pub fn overload(&mut self) {
        self.protection = Protection {
            overloaded_s: 0.0,
            tripped: true,
        };
        if ErrorBits(self.get(SHUTDOWN) as u8).has(ErrorBits::OVERLOAD) {
            self.set(TORQUE_LIMIT, 0);
            self.set(TORQUE_ENABLE, 0);
        }
    }

    /// The torque limit was written: the servo recovers unless it was 0.
    pub(super) fn recover(&mut self) {
        if self.get(TORQUE_LIMIT) > 0 {
            self.protection = Protection::default();
        }
    }
}
