//! Any controller as a linear law about rest.
//!
//! Every controller here is linear about rest once its filter is stationary and nothing saturates.
//! Its matrices are read off it by small deviations, so that what is judged is the code that runs.

use super::DesignModel;
use crate::error::Result;
use crate::sim::closed_loop::{Controller, Measurement};
use crate::synth::{self, zoh};
use nalgebra::{DMatrix, DVector};

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
            controller.control(
                memory,
                Measurement {
                    angle_rad,
                    speed_rad_s,
                },
                &mut torque,
            );
            torque
        };
        let still = vec![0.0; 2 * joints];
        for _ in 0..STATIONARY {
            step(&mut rest, &still);
        }
        let deviated = |place: Option<usize>, measured: &[f64]| {
            let mut memory = rest.clone();
            if let Some(place) = place {
                memory[place] += DEVIATION;
            }
            let torque = step(&mut memory, measured);
            let memory = memory
                .iter()
                .zip(&rest)
                .map(|(new, old)| (new - old) / DEVIATION);
            (
                memory.collect::<Vec<f64>>(),
                torque.iter().map(|t| t / DEVIATION).collect::<Vec<f64>>(),
            )
        };
        let from_memory: Vec<_> = (0..rest.len()).map(|i| deviated(Some(i), &still)).collect();
        let from_seen: Vec<_> = (0..2 * joints)
            .map(|i| {
                let mut measured = still.clone();
                measured[i] = DEVIATION;
                deviated(None, &measured)
            })
            .collect();
        let columns = |all: &[(Vec<f64>, Vec<f64>)], torque: bool| {
            let height = if torque { drives } else { rest.len() };
            let column = |one: &(Vec<f64>, Vec<f64>)| {
                DVector::from_vec(if torque { one.1.clone() } else { one.0.clone() })
            };
            let mut matrix = DMatrix::zeros(height, all.len());
            for (j, one) in all.iter().enumerate() {
                matrix.set_column(j, &column(one));
            }
            matrix
        };
        LinearLaw {
            a: columns(&from_memory, false),
            b: columns(&from_seen, false),
            c: columns(&from_memory, true),
            d: columns(&from_seen, true),
        }
    }

    /// Spectral radius of the loop closed through the plant of `model`, `delay_s` late.
    ///
    /// # Errors
    /// Delays that the sampled plant cannot hold.
    pub fn spectral_radius(&self, model: &DesignModel, delay_s: f64) -> Result<f64> {
        let plant = zoh(&model.plant, model.period_s, delay_s)?;
        let (n, memory, measured) = (plant.a.nrows(), self.a.nrows(), self.d.ncols());
        let mut closed = DMatrix::zeros(n + memory, n + memory);
        let mut c = DMatrix::zeros(measured, n);
        c.view_mut((0, 0), (measured, measured))
            .fill_with_identity();
        closed
            .view_mut((0, 0), (n, n))
            .copy_from(&(&plant.a + &plant.b * &self.d * &c));
        closed
            .view_mut((0, n), (n, memory))
            .copy_from(&(&plant.b * &self.c));
        closed
            .view_mut((n, 0), (memory, n))
            .copy_from(&(&self.b * &c));
        closed.view_mut((n, n), (memory, memory)).copy_from(&self.a);
        Ok(synth::spectral_radius(&closed))
    }
}
