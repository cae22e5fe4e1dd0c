//! Gains and Kalman filter as the one controller that a design with `--lqg` states, in a loop.

use crate::sim::closed_loop::{Controller, Measurement};
use crate::synth::Compensator;

/// z(k+1) = A z + B y, u = u0 + C z + D y within the inputs' limits, y the angles and the first
/// link's rate. In floating point.
#[derive(Debug, Clone)]
pub struct CompensatorLaw {
    /// The controller.
    pub compensator: Compensator,
    /// Inputs at the pose.
    pub u0: Vec<f64>,
    /// Largest inputs.
    pub limit: Vec<f64>,
}

impl Controller for CompensatorLaw {
    fn memory_len(&self) -> usize {
        self.compensator.a.nrows()
    }

    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command: &mut [f64]) {
        let Compensator { a, b, c, d, .. } = &self.compensator;
        let rate = measured.speed_rad_s.first();
        let y: Vec<f64> = measured.angle_rad.iter().chain(rate).copied().collect();
        let row = |of: &nalgebra::DMatrix<f64>, i: usize, x: &[f64]| -> f64 {
            of.row(i).iter().zip(x).map(|(k, x)| k * x).sum()
        };
        for (i, command) in command.iter_mut().enumerate() {
            let asked = self.u0[i] + row(c, i, memory) + row(d, i, &y);
            *command = asked.clamp(-self.limit[i], self.limit[i]);
        }
        let next = |i: usize| row(a, i, memory) + row(b, i, &y);
        let next: Vec<f64> = (0..memory.len()).map(next).collect();
        memory.copy_from_slice(&next);
    }
}
