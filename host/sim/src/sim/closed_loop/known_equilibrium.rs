//! Angle compensation: a controller that knows where the robot balances.

use super::{Controller, Measurement};

/// A controller that is given deviations from the equilibrium instead of the pose.
#[derive(Debug)]
pub struct KnownEquilibrium<'a> {
    inner: Box<dyn Controller + 'a>,
    equilibrium_rad: Vec<f64>,
}

impl<'a> KnownEquilibrium<'a> {
    /// `equilibrium_rad` counts from the pose, in the model's convention of angles.
    pub fn new(inner: Box<dyn Controller + 'a>, equilibrium_rad: Vec<f64>) -> Self {
        KnownEquilibrium {
            inner,
            equilibrium_rad,
        }
    }
}

impl Controller for KnownEquilibrium<'_> {
    fn memory_len(&self) -> usize {
        self.equilibrium_rad.len() + self.inner.memory_len()
    }

    fn reset(&self, memory: &mut [f64]) {
        self.inner.reset(&mut memory[self.equilibrium_rad.len()..]);
    }

    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command: &mut [f64]) {
        let (angles, inner) = memory.split_at_mut(self.equilibrium_rad.len());
        let deviations = measured.angle_rad.iter().zip(&self.equilibrium_rad);
        for (angle, (measured, equilibrium)) in angles.iter_mut().zip(deviations) {
            *angle = measured - equilibrium;
        }
        let measured = Measurement {
            angle_rad: angles,
            speed_rad_s: measured.speed_rad_s,
        };
        self.inner.control(inner, measured, command);
    }
}
