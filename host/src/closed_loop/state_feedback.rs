//! u = u0 - K (x - x0).

use super::{Controller, Seen};

/// Static state feedback on angles and speeds.
#[derive(Debug, Clone, PartialEq)]
pub struct StateFeedback {
    /// Gains, one row per driven joint: N m/rad for each joint's angle, then N m s/rad for each joint's speed.
    pub gains: Vec<Vec<f64>>,
    /// State that is held: deviations of angles, rad, then of speeds, rad/s. Eccentric masses are compensated here.
    pub hold: Vec<f64>,
    /// Torque that is given at that state, N m.
    pub feed_nm: Vec<f64>,
}

impl StateFeedback {
    /// Holds the pose itself, without torque.
    pub fn new(gains: Vec<Vec<f64>>) -> Self {
        let states = gains.first().map_or(0, Vec::len);
        StateFeedback {
            hold: vec![0.0; states],
            feed_nm: vec![0.0; gains.len()],
            gains,
        }
    }

    /// Holds other angles, rad from the pose: the compensation of eccentric masses.
    #[must_use]
    pub fn holding(mut self, angle_rad: &[f64]) -> Self {
        self.hold[..angle_rad.len()].copy_from_slice(angle_rad);
        self
    }
}

impl Controller for StateFeedback {
    #[inline]
    fn control(&self, _memory: &mut [f64], seen: Seen<'_>, torque_nm: &mut [f64]) {
        let joints = seen.angle_rad.len();
        let (hold_angle, hold_speed) = self.hold.split_at(joints);
        for ((torque, row), feed) in torque_nm.iter_mut().zip(&self.gains).zip(&self.feed_nm) {
            let (angle_gain, speed_gain) = row.split_at(joints);
            *torque = feed
                - dot(angle_gain, seen.angle_rad, hold_angle)
                - dot(speed_gain, seen.speed_rad_s, hold_speed);
        }
    }
}

/// Sum of k (x - x0).
#[inline]
fn dot(gain: &[f64], x: &[f64], hold: &[f64]) -> f64 {
    gain.iter()
        .zip(x)
        .zip(hold)
        .map(|((k, x), x0)| k * (x - x0))
        .sum()
}
