//! From what the drive is told to the torque at the joint.

use super::plant::JointPlan;
use crate::effects::DriveState;
use crate::model::Drive;

/// What the motion's log says of the drive at an instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told {
    /// The input in SI of the drive's kind.
    pub input: f64,
    /// Supply over nominal supply; 1 where unknown.
    pub supply_ratio: f64,
    /// Whether the drive is energised.
    pub energised: bool,
    /// Measured speed of another moment, rad/s, for a placebo.
    pub shuffled_rad_s: f64,
}

impl JointPlan {
    /// Torque of the drive, N m, at a reading of the joint's own encoder and a speed.
    #[inline]
    pub(super) fn drive_torque_nm(&self, told: Told, reading_rad: f64, speed_rad_s: f64) -> f64 {
        if !told.energised {
            return 0.0;
        }
        let (duty, slope) = match &self.drive {
            Drive::Passive => return 0.0,
            Drive::Torque => (told.input / self.full_torque_nm, 0.0),
            Drive::Duty(motor) => (told.input, 1.0 / motor.no_load_speed_rad_s),
            Drive::Position {
                gain_per_rad,
                motor,
            } => (
                (gain_per_rad * (told.input - reading_rad)).clamp(-1.0, 1.0),
                1.0 / motor.no_load_speed_rad_s,
            ),
            Drive::Speed {
                gain_s_per_rad,
                motor,
            } => {
                let forward = if motor.no_load_speed_rad_s.is_finite() {
                    told.input / motor.no_load_speed_rad_s
                } else {
                    0.0
                };
                (
                    (forward + gain_s_per_rad * (told.input - speed_rad_s)).clamp(-1.0, 1.0),
                    1.0 / motor.no_load_speed_rad_s,
                )
            }
        };
        let duty = self
            .command
            .iter()
            .fold(duty, |duty, e| e.effect.command(e.values(), duty));
        let state = DriveState {
            speed_rad_s,
            duty,
            full_torque_nm: self.full_torque_nm,
            supply_ratio: told.supply_ratio,
        };
        let torque = self.full_torque_nm * (duty - slope * speed_rad_s);
        self.output.iter().fold(torque, |torque, e| {
            e.effect.drive(e.values(), torque, &state)
        })
    }
}
