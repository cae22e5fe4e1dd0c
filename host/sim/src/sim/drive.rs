//! Drive torque at a joint, from the drive's input, its regulator, its motor and the effects on
//! them.

use super::joint_plan::{ActiveEffect, JointPlan};
use crate::effects::{AtRest, DriveState, MemoryCell, Signals};
use crate::model::Drive;

/// Longest step of a motor by itself, in parts of the time in which its drive brakes it, and the
/// shortest that it ever needs, s: a motor without inertia is nowhere by itself for long.
const MOTOR_STEP: f64 = 0.7;
const SHORTEST_MOTOR_STEP_S: f64 = 2e-4;

/// Input of a drive at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DriveInput {
    /// The input in SI of the drive's kind.
    pub input: f64,
    /// Supply over nominal supply; 1 where unknown.
    pub supply_ratio: f64,
    /// Whether the drive is energised.
    pub energised: bool,
    /// Time of the motion, s.
    pub time_s: f64,
    /// Measured speed of another moment, rad/s, for a placebo regressor.
    pub shuffled_rad_s: f64,
    /// Constant torque on the joint from outside, N m.
    pub disturbance_nm: f64,
}

impl DriveInput {
    /// Energised at the nominal supply, input 0.
    pub const ZERO: DriveInput = DriveInput {
        input: 0.0,
        supply_ratio: 1.0,
        energised: true,
        time_s: 0.0,
        shuffled_rad_s: 0.0,
        disturbance_nm: 0.0,
    };
}

impl From<DriveInput> for Signals {
    fn from(at: DriveInput) -> Signals {
        Signals {
            input: at.input,
            supply_ratio: at.supply_ratio,
            time_s: at.time_s,
        }
    }
}

/// What a regulator reads of its own encoder.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct OwnReading {
    /// The reading, rad.
    pub angle_rad: f64,
    /// By how much it moves in half an integration step, rad: a law that jumps at a reading between
    /// two steps is taken as the mean over it, or it jumps a part of a step too soon or too late.
    pub moves_rad: f64,
}

impl From<f64> for OwnReading {
    /// At an instant.
    fn from(angle_rad: f64) -> Self {
        OwnReading {
            angle_rad,
            moves_rad: 0.0,
        }
    }
}

impl JointPlan {
    /// Whether the torque follows from the input alone, whatever the joint's angle and speed.
    pub(super) fn torque_is_held(&self) -> bool {
        let regulated = match &self.drive {
            Drive::Passive | Drive::Torque => false,
            Drive::Duty(motor) => motor.no_load_speed_rad_s.is_finite(),
            Drive::Position { .. } | Drive::Speed { .. } => true,
        };
        let standstill = self.standstill();
        let follows_speed = |e: &ActiveEffect| {
            let slope = e.effect.slope(e.values(), &standstill);
            slope.is_none_or(|slope| slope.per_rad_s != 0.0)
        };
        !regulated && !self.output.iter().any(follows_speed)
    }

    /// Longest step that follows a motor between rigid flanks, s: a part of the time in which its
    /// drive brakes it; infinite where the flanks of its gear are not rigid, or no torque falls
    /// with speed.
    pub(super) fn longest_motor_step_s(&self) -> f64 {
        let Some(coupling) = self.rigid_flanks() else {
            return f64::INFINITY;
        };
        let motor = self.drive.motor();
        let own = motor.map_or(0.0, |motor| 1.0 / motor.no_load_speed_rad_s);
        let regulated = match self.drive {
            Drive::Speed { gain_s_per_rad, .. } => gain_s_per_rad,
            _ => 0.0,
        };
        let standstill = self.standstill();
        let of_effects = self.output.iter().map(|e| {
            let slope = e.effect.slope(e.values(), &standstill);
            slope.map_or(0.0, |slope| -slope.per_rad_s)
        });
        let brakes = self.full_torque_nm * (own + regulated) + of_effects.sum::<f64>();
        (MOTOR_STEP * coupling.inertia_kg_m2 / brakes.max(0.0)).max(SHORTEST_MOTOR_STEP_S)
    }

    fn standstill(&self) -> AtRest {
        AtRest {
            angle_rad: 0.0,
            duty: 0.0,
            torque_nm: 0.0,
            full_torque_nm: self.full_torque_nm,
        }
    }

    /// Torque of the drive, N m, at a reading of the joint's own encoder and a speed.
    #[inline]
    pub(super) fn drive_torque_nm(
        &self,
        at: DriveInput,
        reading: OwnReading,
        speed_rad_s: f64,
        memory: &[MemoryCell],
    ) -> f64 {
        if !at.energised || self.drive == Drive::Passive {
            return 0.0;
        }
        let duty = self.duty(at, reading, speed_rad_s);
        let slope = self
            .drive
            .motor()
            .map_or(0.0, |motor| 1.0 / motor.no_load_speed_rad_s);
        let mut state = DriveState {
            speed_rad_s,
            duty,
            full_torque_nm: self.full_torque_nm,
            supply_ratio: at.supply_ratio,
            memory: MemoryCell::EMPTY,
        };
        let torque = self.full_torque_nm * (duty - slope * speed_rad_s);
        self.output.iter().fold(torque, |torque, e| {
            state.memory = e.recall(memory);
            e.effect.drive(e.values(), torque, &state)
        })
    }

    /// Duty that the drive applies, -1 to 1, at a reading of the joint's own encoder and a speed: 0
    /// while it is not energised.
    #[inline]
    pub(super) fn duty(&self, at: DriveInput, reading: OwnReading, speed_rad_s: f64) -> f64 {
        if !at.energised {
            return 0.0;
        }
        let mut spread = 0.0;
        let duty = match &self.drive {
            Drive::Passive => return 0.0,
            Drive::Torque => at.input / self.full_torque_nm,
            Drive::Duty(_) => at.input,
            Drive::Position { gain_per_rad, .. } => {
                let duty = gain_per_rad * (at.input - reading.angle_rad);
                if duty.abs() < 1.0 {
                    spread = gain_per_rad.abs() * reading.moves_rad;
                }
                duty.clamp(-1.0, 1.0)
            }
            Drive::Speed {
                gain_s_per_rad,
                motor,
            } => {
                let forward = if motor.no_load_speed_rad_s.is_finite() {
                    at.input / motor.no_load_speed_rad_s
                } else {
                    0.0
                };
                (forward + gain_s_per_rad * (at.input - speed_rad_s)).clamp(-1.0, 1.0)
            }
        };
        self.command.iter().fold(duty, |duty, e| {
            if spread == 0.0 {
                e.effect.command(e.values(), duty)
            } else {
                e.effect.mean_command(e.values(), duty, spread)
            }
        })
    }
}
