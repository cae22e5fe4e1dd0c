//! What a sampled control law is to the loop.

use std::fmt;

/// What is measured at a sample, as deviations from the readings at the pose that is held, in the
/// model's convention.
#[derive(Debug, Clone, Copy)]
pub struct Measurement<'a> {
    /// Angle of each joint, rad.
    pub angle_rad: &'a [f64],
    /// Speed of each joint, rad/s.
    pub speed_rad_s: &'a [f64],
}

/// A sampled control law. Its settings are its own; what it remembers from sample to sample is lent
/// to it, so that one controller serves many runs at once.
pub trait Controller: Sync + fmt::Debug {
    /// How many numbers it remembers.
    fn memory_len(&self) -> usize {
        0
    }

    /// Prepares its memory for a new run.
    fn reset(&self, memory: &mut [f64]) {
        memory.fill(0.0);
    }

    /// Commands to the drives from the base outwards, N m or what the loop's
    /// [`Commands`](super::Commands) say, into `command`.
    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command: &mut [f64]);
}

impl<C: Controller + ?Sized> Controller for &C {
    fn memory_len(&self) -> usize {
        (**self).memory_len()
    }

    fn reset(&self, memory: &mut [f64]) {
        (**self).reset(memory);
    }

    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command: &mut [f64]) {
        (**self).control(memory, measured, command);
    }
}
