//! The place for control laws: one file each.

use std::fmt;

/// What a controller is given at a sample, as deviations from the pose it holds.
#[derive(Debug, Clone, Copy)]
pub struct Seen<'a> {
    /// Angle of each joint, rad.
    pub angle_rad: &'a [f64],
    /// Speed of each joint, rad/s.
    pub speed_rad_s: &'a [f64],
}

/// A sampled control law. Its settings are its own; what it remembers from sample to sample is lent to it, so that one
/// controller serves many runs at once.
pub trait Controller: Sync + fmt::Debug {
    /// How many numbers it remembers.
    fn memory_len(&self) -> usize {
        0
    }

    /// Prepares its memory for a new run.
    fn reset(&self, memory: &mut [f64]) {
        memory.fill(0.0);
    }

    /// Torques to ask of the driven joints, N m, from the base outwards, into `torque_nm`.
    fn control(&self, memory: &mut [f64], seen: Seen<'_>, torque_nm: &mut [f64]);
}
