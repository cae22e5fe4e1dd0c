//! Paths of poses: all joints go from pose to pose at once, no faster than their limits.

use super::limits::JointLimits;

/// Poses over time, one row for each sample.
#[derive(Debug, Clone, Default)]
pub(super) struct PosePath {
    /// Per sample, per joint, rad.
    pub rows: Vec<Vec<f64>>,
}

/// Samples that the slowest joint needs to go from one pose to another at a share of its speed.
pub(super) fn samples_between(
    joints: &[JointLimits],
    (from, to): (&[f64], &[f64]),
    share: f64,
    hz: f64,
) -> usize {
    let ways = joints.iter().zip(from.iter().zip(to));
    let time_s = ways.map(|(joint, (a, b))| (b - a).abs() / (share * joint.speed_rad_s));
    (time_s.fold(0.0, f64::max) * hz).ceil().max(1.0) as usize
}

impl PosePath {
    /// Straight to a pose in so many samples.
    pub fn go(&mut self, from: &[f64], to: &[f64], samples: usize) {
        for k in 1..=samples {
            let share = k as f64 / samples as f64;
            let between = from.iter().zip(to);
            self.rows
                .push(between.map(|(a, b)| a + share * (b - a)).collect());
        }
    }

    /// Stays for so many samples.
    pub fn hold(&mut self, pose: &[f64], samples: usize) {
        self.rows
            .extend(std::iter::repeat_n(pose.to_vec(), samples));
    }

    /// The last pose, or this one before the first.
    pub fn last_or<'a>(&'a self, first: &'a [f64]) -> &'a [f64] {
        self.rows.last().map_or(first, Vec::as_slice)
    }
}
