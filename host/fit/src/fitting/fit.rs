//! A model fitted to motions: options and result.

use super::data::FitProblem;
use super::normal::WindowJacobian;
use super::residual::Residuals;
use super::window_start::WindowStart;
use crate::model::{Model, ParameterPath};

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct FitOptions {
    /// Most iterations, each one linearisation.
    pub iterations: usize,
    /// Stop when the cost is reduced by less than this share.
    pub tolerance: f64,
    /// Whether to leave out the derivatives at the end: for a fit that is only compared, or
    /// [resumed](Fit::resume).
    pub rough: bool,
    /// Whether to stop where the derivatives it began with lead down no further: for a fit that
    /// only tells whether more of it is worth while.
    pub glance: bool,
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions {
            iterations: 30,
            tolerance: 1e-5,
            rough: false,
            glance: false,
        }
    }
}

impl FitOptions {
    /// The defaults, but for the number of iterations.
    pub fn iterations(iterations: usize) -> Self {
        FitOptions {
            iterations,
            ..FitOptions::default()
        }
    }

    /// The same without the derivatives at the end.
    pub fn rough(self) -> Self {
        FitOptions {
            rough: true,
            ..self
        }
    }

    /// The same as long as the derivatives at hand lead down.
    pub fn glance(self) -> Self {
        FitOptions {
            glance: true,
            ..self.rough()
        }
    }
}

/// A fitted model.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The model at the fitted values.
    pub model: Model,
    /// What was free.
    pub free: Vec<ParameterPath>,
    /// Start state of every window.
    pub window_starts: Vec<WindowStart>,
    /// Weighted residuals at the end.
    pub residuals: Residuals,
    /// Whether the tolerance was met before the iterations ran out.
    pub converged: bool,
    /// Simulations of the whole data that it took.
    pub simulations: usize,
    pub(super) jacobian: Vec<WindowJacobian>,
    /// How often what is known of the values beforehand counts.
    pub(super) prior_weight: f64,
    /// Whether the derivatives are those at the fitted values, not corrected ones of steps before.
    pub(super) fresh: bool,
}

impl Fit {
    /// Fitted values in the order of `free`.
    pub fn values(&self) -> Vec<f64> {
        let value = |path: &ParameterPath| path.get(&self.model).unwrap_or(f64::NAN);
        self.free.iter().map(value).collect()
    }

    /// Which values lie on a bound: a warning, not a result.
    pub fn on_bound(&self) -> Vec<bool> {
        let free = self.free.iter().zip(self.values());
        free.map(|(path, value)| {
            let (low, high) = path.bounds(&self.model);
            let near = |bound: f64| (value - bound).abs() <= 1e-9 * bound.abs().max(1e-6);
            near(low) || near(high)
        })
        .collect()
    }

    /// Root-mean-square error, rad, over all joints with a measured angle and every sample of
    /// `data` that was measured, rad/s where no angle is; `data` are those of the fit.
    pub fn rms(&self, data: &FitProblem) -> f64 {
        let (mut sum, mut count) = (0.0, 0usize);
        for (window, residuals) in data.windows.iter().zip(&self.residuals.windows) {
            let signals = residuals.chunks(window.samples.len()).enumerate();
            for (signal, part) in signals.filter(|(signal, _)| data.counts(*signal)) {
                let measured = &data.measured(window.motion, signal)[window.samples.clone()];
                for (residual, _) in part.iter().zip(measured).filter(|(_, m)| !m.is_nan()) {
                    sum += (residual * data.sigma[signal]).powi(2);
                    count += 1;
                }
            }
        }
        (sum / count.max(1) as f64).sqrt()
    }
}
