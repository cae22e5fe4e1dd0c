//! What a joint's drive and friction carry from one step of the truth to the next.

use super::physics::{DriveCommand, Physics};

/// Memory of one joint.
#[derive(Debug, Clone, Default)]
pub struct History {
    /// Duty that a ramp has reached; none before the first command.
    ramped: Option<f64>,
    /// Duty that a filter of the command has reached; none before the first command.
    filtered: Option<f64>,
    /// 0 cold, 1 after long at full duty.
    warmth: f64,
    /// For how long the drive has been overloaded, s.
    overloaded_s: f64,
    /// How far the bristles of dry friction are bent, rad.
    bristle: f64,
    /// By how much a motor behind a gear that gives is ahead of its joint, rad, and its speed,
    /// rad/s.
    motor: [f64; 2],
}

impl History {
    /// The command that the drive follows `h` s later, having ramped and been filtered: by the
    /// bilinear rule, of which a step of 50 us leaves no error to speak of.
    pub fn ramp(&mut self, physics: &Physics, push: DriveCommand, h: f64) -> DriveCommand {
        let before = self.ramped.filter(|_| push.torque_on).unwrap_or(push.duty);
        let reach = physics.duty_per_s * h;
        let duty = push.duty.clamp(before - reach, before + reach);
        self.ramped = Some(duty);
        let lag = physics.command_lag_s;
        let from = self.filtered.filter(|_| push.torque_on).unwrap_or(duty);
        let to = from + h / (lag + 0.5 * h) * (duty - from);
        self.filtered = Some(if lag > 0.0 { to } else { duty });
        let duty = if lag > 0.0 { 0.5 * (from + to) } else { duty };
        DriveCommand { duty, ..push }
    }

    /// After `h` s under this command during which the joint has turned by `turned` rad.
    pub fn pass(&mut self, physics: &Physics, push: DriveCommand, turned: f64, h: f64) {
        let duty = if push.torque_on {
            physics.applied(push.duty)
        } else {
            0.0
        };
        if physics.warming > 0.0 {
            self.warmth += h / physics.warming_s * (duty * duty - self.warmth);
        }
        let counts = if duty.abs() > physics.fold_level {
            h
        } else {
            -h
        };
        self.overloaded_s = (self.overloaded_s + counts).clamp(0.0, 2.0 * physics.fold_after_s);
        if physics.bristle_nm > 0.0 {
            let bent = self.bristle * physics.bristle_nm_rad / physics.bristle_nm;
            self.bristle += turned - turned.abs() * bent;
        }
    }

    /// Carries a motor behind a gear that gives on by `h` s at the speeds that it and its joint
    /// have.
    pub fn drift(&mut self, h: f64, joint_speed: f64) {
        self.motor[0] += h * (self.motor[1] - joint_speed);
    }

    /// Torque that arrives at the joint, N m, of a motor that gives `drive` N m at a speed of its
    /// shaft, rad/s; `speed` is the joint's.
    pub fn passed_on(&self, physics: &Physics, drive: impl Fn(f64) -> f64, speed: f64) -> f64 {
        if physics.motor_inertia == 0.0 {
            return self.share(physics) * drive(speed);
        }
        let [ahead, own] = self.motor;
        physics.through_gear(ahead, own - speed)
    }

    /// Speeds that motor up or down for `h` s; `drive` and `joint_speed` as in `passed_on`.
    pub fn kick(
        &mut self,
        physics: &Physics,
        drive: impl Fn(f64) -> f64,
        joint_speed: f64,
        h: f64,
    ) {
        if physics.motor_inertia > 0.0 {
            let [ahead, own] = self.motor;
            let left =
                self.share(physics) * drive(own) - physics.through_gear(ahead, own - joint_speed);
            self.motor[1] += h / physics.motor_inertia * left;
        }
    }

    /// Share of its torque that the drive gives.
    pub fn share(&self, physics: &Physics) -> f64 {
        let warm = 1.0 / (1.0 + physics.warming * self.warmth);
        if physics.fold_after_s > 0.0 && self.overloaded_s >= physics.fold_after_s {
            warm * physics.fold_share
        } else {
            warm
        }
    }

    /// Torque of the bent bristles on the joint, N m.
    pub fn bristle_nm(&self, physics: &Physics) -> f64 {
        -physics.bristle_nm_rad * self.bristle
    }
}
