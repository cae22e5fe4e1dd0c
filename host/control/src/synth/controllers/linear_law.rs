//! Any controller as a linear law about rest.
//!
//! Every controller here is linear about rest once its filter is stationary and nothing saturates.
//! Its matrices are read off it by small deviations, so that what is judged is the code that runs.

use super::DesignModel;
use crate::error::Result;
use crate::sim::closed_loop::{Controller, Measurement};
use crate::synth::{self, zoh};
use nalgebra::{DMatrix, DVector, stack};

/// Samples after which every controller's filter is stationary.
const STATIONARY: usize = 1200;

/// Size of a deviation: rad, rad/s, or of a number of its memory.
const DEVIATION: f64 = 1e-6;

/// A controller about rest: memory' = A memory + B measured, command = C memory + D measured.
#[derive(Debug, Clone)]
pub struct LinearLaw {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
}

impl LinearLaw {
    /// Reads the matrices off a controller by small deviations.
    pub fn of(controller: &dyn Controller, model: &DesignModel) -> LinearLaw {
        let (joints, drives) = (model.joints(), model.drives());
        let mut rest = vec![0.0; controller.memory_len()];
        controller.reset(&mut rest);
        let step = |memory: &mut [f64], measured: &[f64]| {
            let (angle_rad, speed_rad_s) = measured.split_at(joints);
            let mut torque = vec![0.0; drives];
            let measured = Measurement {
                angle_rad,
                speed_rad_s,
            };
            controller.control(memory, measured, &mut torque);
            torque
        };
        let still = vec![0.0; 2 * joints];
        for _ in 0..STATIONARY {
            step(&mut rest, &still);
        }
        // Change of memory and command, per unit of deviation.
        let deviated = |memory: &mut [f64], measured: &[f64]| {
            let torque = step(memory, measured);
            let memory = memory.iter().zip(&rest).map(|(new, old)| new - old);
            let change = memory.chain(torque).collect::<Vec<f64>>();
            DVector::from_vec(change) / DEVIATION
        };
        let height = rest.len() + drives;
        let mut from_memory = DMatrix::zeros(height, rest.len());
        for place in 0..rest.len() {
            let mut memory = rest.clone();
            memory[place] += DEVIATION;
            from_memory.set_column(place, &deviated(&mut memory, &still));
        }
        let mut from_measured = DMatrix::zeros(height, 2 * joints);
        for place in 0..2 * joints {
            let mut measured = still.clone();
            measured[place] = DEVIATION;
            from_measured.set_column(place, &deviated(&mut rest.clone(), &measured));
        }
        LinearLaw {
            a: from_memory.rows(0, rest.len()).into_owned(),
            b: from_measured.rows(0, rest.len()).into_owned(),
            c: from_memory.rows(rest.len(), drives).into_owned(),
            d: from_measured.rows(rest.len(), drives).into_owned(),
        }
    }

    /// Spectral radius of the loop closed through the plant of `model`, `delay_s` late.
    ///
    /// # Errors
    /// Delays that the sampled plant cannot hold.
    pub fn spectral_radius(&self, model: &DesignModel, delay_s: f64) -> Result<f64> {
        let plant = zoh(&model.plant, model.period_s, delay_s)?;
        let measured = DMatrix::identity(self.d.ncols(), plant.a.nrows());
        let driven = &plant.a + &plant.b * &self.d * &measured;
        let closed = stack![driven, &plant.b * &self.c; &self.b * &measured, self.a];
        Ok(synth::spectral_radius(&closed))
    }
}
