//! An unloaded servo shaft: the default when no robot is simulated.

use super::regulator::Regulator;

/// Angle and speed of a servo shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaft {
    /// Angle from the middle of the range, rad.
    pub angle_rad: f64,
    /// Speed, rad/s.
    pub speed_rad_s: f64,
}

/// Full speed without load at 9.6 V, rad/s: 59 rpm at 12 V, in proportion.
const FULL_SPEED_RAD_S: f64 = 4.9;
/// Time constant of the unloaded gear train, s.
const TIME_CONSTANT_S: f64 = 0.04;
/// Smallest output that moves it, of full output: the paper's dead zone of 7 to 10 %.
const DEAD_ZONE: f64 = 0.08;

impl Shaft {
    /// Advance the unloaded shaft by `dt_s` under the regulator's output.
    pub fn step(&mut self, regulator: &Regulator, dt_s: f64) {
        let duty = regulator.duty(self.angle_rad);
        let moving = if duty.abs() > DEAD_ZONE { duty } else { 0.0 };
        let wanted = moving * FULL_SPEED_RAD_S;
        let wanted = wanted.clamp(-regulator.speed_limit_rad_s, regulator.speed_limit_rad_s);
        self.speed_rad_s += (wanted - self.speed_rad_s) * (dt_s / TIME_CONSTANT_S).min(1.0);
        let next = self.angle_rad + self.speed_rad_s * dt_s;
        self.angle_rad = next.clamp(-2.617, 2.617);
    }
}
