//! A model fitted to motions: what may be asked, and what comes of it.

use super::data::Data;
use super::node::{Guess, Node};
use super::normal::WindowJacobian;
use super::residual::Residuals;
use super::search::Search;
use crate::model::{Model, ParameterPath};

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct FitOptions {
    /// Most iterations, each one linearisation.
    pub iterations: usize,
    /// Stop when the cost falls by less than this share.
    pub tolerance: f64,
    /// Whether to leave out the derivatives at the end: for a fit that is only compared, or [resumed](Fit::resume).
    pub rough: bool,
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions {
            iterations: 30,
            tolerance: 1e-5,
            rough: false,
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
    pub nodes: Vec<Node>,
    /// Weighted residuals at the end.
    pub residuals: Residuals,
    /// Whether the tolerance was met before the iterations ran out.
    pub converged: bool,
    /// Simulations of the whole data that it took.
    pub simulations: usize,
    pub(super) jacobian: Vec<WindowJacobian>,
    /// Whether the derivatives are those at the fitted values.
    pub(super) fresh: bool,
}

impl Fit {
    /// Goes on fitting to the same data; a fit that has converged only gets the derivatives it lacks.
    pub fn resume(&self, data: &Data, options: FitOptions) -> Fit {
        if self.converged && (self.fresh || options.rough) {
            return self.clone();
        }
        let iterations = if self.converged {
            0
        } else {
            options.iterations
        };
        let options = FitOptions {
            iterations,
            ..options
        };
        let mut fit = Search::resume(self, data, guesses(data)).run(options);
        fit.converged |= self.converged;
        fit.simulations += self.simulations;
        fit
    }

    /// Fitted values in the order of `free`.
    pub fn values(&self) -> Vec<f64> {
        self.free
            .iter()
            .map(|path| path.get(&self.model).unwrap_or(f64::NAN))
            .collect()
    }

    /// Which values lie on a bound: a warning, not a result.
    pub fn on_bound(&self) -> Vec<bool> {
        self.free
            .iter()
            .zip(self.values())
            .map(|(path, value)| {
                let (low, high) = path.bounds(&self.model);
                let near = |bound: f64| (value - bound).abs() <= 1e-9 * bound.abs().max(1e-6);
                near(low) || near(high)
            })
            .collect()
    }
}

/// Fits the free parameters and every window's start state; nodes are guessed where none are given.
pub fn fit(
    model: &Model,
    free: &[ParameterPath],
    data: &Data,
    nodes: Option<&[Node]>,
    options: FitOptions,
) -> Fit {
    let guesses = guesses(data);
    let nodes = nodes.map_or_else(
        || guesses.iter().map(|g| g.node.clone()).collect(),
        <[Node]>::to_vec,
    );
    Search::new(model, free, data, guesses, nodes).run(options)
}

/// Fits only the windows' start states: how the model, as it is, does on these motions.
pub fn settle(model: &Model, data: &Data) -> Fit {
    fit(
        model,
        &[],
        data,
        None,
        FitOptions {
            iterations: 8,
            ..FitOptions::default()
        },
    )
}

fn guesses(data: &Data) -> Vec<Guess> {
    data.windows.iter().map(|w| Guess::of(data, w)).collect()
}
