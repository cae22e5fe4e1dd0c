//! The circumstances of a run, together.

use super::{Actuator, Clock, Gyro, Sensor, Velocity};
use handstand_shared::raw::Position;

/// Sensor, actuator and clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// What the controller sees.
    pub sensor: Sensor,
    /// What becomes of its commands.
    pub actuator: Actuator,
    /// When it is called.
    pub clock: Clock,
}

impl Conditions {
    /// Everything exact, unlimited and on time.
    pub fn ideal(period_s: f64) -> Self {
        Conditions {
            sensor: Sensor::EXACT,
            actuator: Actuator::IDEAL,
            clock: Clock::every(period_s),
        }
    }

    /// All that the paper measured on the robot at once: 10-bit angles, speeds of the driven joints from their
    /// differences, a 10 deg/s gyro on the arms, a dead zone of 10 %, 2 N m at most, one period of delay.
    pub fn measured(period_s: f64) -> Self {
        Conditions {
            sensor: Sensor {
                position_resolution_rad: Position::LSB_RAD,
                position_noise_rad: 0.0,
                velocity: Velocity::Difference,
                gyro: Some(Gyro {
                    resolution_rad_s: 10f64.to_radians(),
                    noise_rad_s: 0.0,
                }),
            },
            actuator: Actuator {
                saturates: true,
                dead_zone: 0.1,
                delay_periods: 1.0,
                ..Actuator::IDEAL
            },
            clock: Clock::every(period_s),
        }
    }
}
