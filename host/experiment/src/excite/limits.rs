//! Within which limits servos are moved, and why a motion cannot be held in them.

use crate::error::{Error, Result};

/// Half of the angle that an AX-12 turns through, rad: 150 degrees either way.
const SERVO_RAD: f64 = 2.617_993_877_991_494;
/// Unloaded speed of an AX-12 at 12 V, rad/s: 59 turns a minute.
const SERVO_RAD_S: f64 = 6.18;

/// One joint: its servos, and how far and fast it may move.
#[derive(Debug, Clone, PartialEq)]
pub struct JointLimits {
    /// Servos that turn it; those after the first face the other way.
    pub servos: Vec<u8>,
    /// Lowest angle, rad.
    pub low_rad: f64,
    /// Highest angle, rad.
    pub high_rad: f64,
    /// Fastest change of the goal, rad/s.
    pub speed_rad_s: f64,
}

impl JointLimits {
    /// Middle of its range, rad.
    pub fn middle_rad(&self) -> f64 {
        0.5 * (self.low_rad + self.high_rad)
    }

    /// Half of its range, rad.
    pub fn half_rad(&self) -> f64 {
        0.5 * (self.high_rad - self.low_rad)
    }

    /// Whether a servo can be held within them.
    ///
    /// # Errors
    /// Which limit it cannot.
    pub fn check(&self) -> Result<()> {
        let (low_rad, high_rad) = (self.low_rad, self.high_rad);
        let Some(servo) = self.servos.first() else {
            return Err(no_servo());
        };
        let is_range = low_rad < high_rad && low_rad >= -SERVO_RAD && high_rad <= SERVO_RAD;
        let speed = self.speed_rad_s;
        if !is_range {
            return Err(Error::usage(
                format!("angles {low_rad} to {high_rad} rad of servo {servo}"),
                format!("give a lower and a higher angle within {SERVO_RAD:.2} rad of the centre"),
            ));
        }
        if !(speed > 0.0 && speed <= SERVO_RAD_S) {
            return Err(Error::usage(
                format!("{speed} rad/s"),
                format!("give more than 0, up to {SERVO_RAD_S} rad/s"),
            ));
        }
        Ok(())
    }
}

/// No joint or no servo of one.
pub(super) fn no_servo() -> Error {
    Error::usage(
        "no servo is named",
        "name the servos of each joint: --joints 1+2/11+12",
    )
}
