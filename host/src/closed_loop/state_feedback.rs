//! u = u0 - K (x - x0), on past torques too if the gains have columns for them.

use super::{Controller, Seen};

/// Static state feedback on angles and speeds.
#[derive(Debug, Clone, PartialEq)]
pub struct StateFeedback {
    /// Gains, one row per driven joint: N m/rad for each joint's angle, then N m s/rad for each joint's speed, then, for
    /// designs that know of a delay, shares of every torque asked for one sample ago, two samples ago, ...
    pub gains: Vec<Vec<f64>>,
    /// State that is held: deviations of angles, rad, then of speeds, rad/s. Eccentric masses are compensated here.
    pub hold: Vec<f64>,
    /// Torque that is given at that state, N m.
    pub feed_nm: Vec<f64>,
}

impl StateFeedback {
    /// Holds the pose of a robot of `joints` joints, without torque.
    pub fn new(joints: usize, gains: Vec<Vec<f64>>) -> Self {
        StateFeedback {
            hold: vec![0.0; 2 * joints],
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
    fn memory_len(&self) -> usize {
        self.gains.first().map_or(0, Vec::len) - self.hold.len()
    }

    #[inline]
    fn control(&self, memory: &mut [f64], seen: Seen<'_>, torque_nm: &mut [f64]) {
        let joints = seen.angle_rad.len();
        let (hold_angle, hold_speed) = self.hold.split_at(joints);
        for ((torque, row), feed) in torque_nm.iter_mut().zip(&self.gains).zip(&self.feed_nm) {
            let (angle_gain, rest) = row.split_at(joints);
            let (speed_gain, past_gain) = rest.split_at(joints);
            *torque = feed
                - dot(angle_gain, seen.angle_rad, hold_angle)
                - dot(speed_gain, seen.speed_rad_s, hold_speed);
            for (gain, past) in past_gain.iter().zip(memory.iter()) {
                *torque -= gain * past;
            }
        }
        remember(memory, torque_nm);
    }
}

/// Makes the torques the newest of those that `memory` holds.
#[inline]
pub(crate) fn remember(memory: &mut [f64], torque_nm: &[f64]) {
    if memory.is_empty() {
        return;
    }
    let kept = memory.len() - torque_nm.len();
    memory.copy_within(..kept, torque_nm.len());
    memory[..torque_nm.len()].copy_from_slice(torque_nm);
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
