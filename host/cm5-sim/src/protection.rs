//! A motor that pushes in vain protects itself.
//!
//! The e-manual: when the load can't be held, error bit 5 is set, and if the shutdown register has that bit, the torque
//! limit falls to 0 until it is written anew. Share and time are not published; those here are ours.

use super::servo::Servo;
use handstand_shared::control_table::{SHUTDOWN, TORQUE_ENABLE, TORQUE_LIMIT};
use handstand_shared::dynamixel::ErrorBits;

/// Output above which the motor counts as labouring, of full output.
const LABOUR: f64 = 0.8;
/// Speed below which it labours in vain, rad/s.
const STANDSTILL_RAD_S: f64 = 0.1;
/// How long it bears that, s.
const PATIENCE_S: f64 = 1.0;

/// What the servo's protection remembers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Protection {
    in_vain_s: f64,
    tripped: bool,
}

impl Protection {
    /// Whether it has tripped, and the torque limit was not written since.
    pub fn is_tripped(&self) -> bool {
        self.tripped
    }
}

impl Servo {
    /// Watches the motor for another `dt_s`.
    pub(super) fn protect(&mut self, dt_s: f64) {
        let output = self.output().duty(self.shaft.angle_rad);
        let in_vain = output.abs() >= LABOUR && self.shaft.speed_rad_s.abs() < STANDSTILL_RAD_S;
        let protection = &mut self.protection;
        protection.in_vain_s = if in_vain {
            protection.in_vain_s + dt_s
        } else {
            0.0
        };
        if protection.in_vain_s >= PATIENCE_S {
            self.overload();
        }
    }

    /// Trips the protection.
    pub fn overload(&mut self) {
        self.protection = Protection {
            in_vain_s: 0.0,
            tripped: true,
        };
        if ErrorBits(self.get(SHUTDOWN) as u8).has(ErrorBits::OVERLOAD) {
            self.set(TORQUE_LIMIT, 0);
            self.set(TORQUE_ENABLE, 0);
        }
    }

    /// The torque limit was written: it is ready again, unless that was 0.
    pub(super) fn recover(&mut self) {
        if self.get(TORQUE_LIMIT) > 0 {
            self.protection = Protection::default();
        }
    }
}
