//! Bounded least squares by Levenberg-Marquardt on the multiple-shooting residual: Levenberg (1944), Marquardt
//! (1963).

use super::data::Data;
use super::fit::{Fit, FitOptions};
use super::node::{Guess, Node};
use super::normal::{Normal, WindowJacobian};
use super::residual::{Residuals, residuals};
use crate::model::{Model, ParameterPath};
use nalgebra::DVector;

/// A fit under way.
pub(super) struct Search<'a> {
    pub free: &'a [ParameterPath],
    pub data: &'a Data,
    pub guesses: Vec<Guess>,
    pub model: Model,
    pub nodes: Vec<Node>,
    pub residuals: Residuals,
    pub simulations: usize,
}

impl<'a> Search<'a> {
    pub fn new(
        model: &Model,
        free: &'a [ParameterPath],
        data: &'a Data,
        guesses: Vec<Guess>,
        nodes: Vec<Node>,
    ) -> Self {
        let residuals = residuals(model, data, &nodes);
        Search {
            free,
            data,
            guesses,
            model: model.clone(),
            nodes,
            residuals,
            simulations: 1,
        }
    }

    pub fn run(mut self, options: FitOptions) -> Fit {
        let mut damping = 1e-3;
        let mut converged = false;
        let mut quiet = 0;
        let mut jacobian = self.jacobian();
        for _ in 0..options.iterations {
            let before = self.cost();
            let Some(fall) = self.step(&jacobian, &mut damping) else {
                converged = true;
                break;
            };
            jacobian = self.jacobian();
            quiet = if fall < options.tolerance * before {
                quiet + 1
            } else {
                0
            };
            if quiet >= 2 || before - fall <= 0.0 {
                converged = true;
                break;
            }
        }
        Fit {
            model: self.model,
            free: self.free.to_vec(),
            nodes: self.nodes,
            residuals: self.residuals,
            converged,
            simulations: self.simulations,
            jacobian,
        }
    }

    /// Squared residuals plus the nodes' weak priors.
    fn cost(&self) -> f64 {
        self.residuals.cost() + self.prior_cost(&self.nodes)
    }

    fn prior_cost(&self, nodes: &[Node]) -> f64 {
        let mut sum = 0.0;
        for (node, guess) in nodes.iter().zip(&self.guesses) {
            let (precision, pull) = self.prior(node, guess);
            sum += precision.component_mul(&pull).dot(&pull);
        }
        sum
    }

    /// Precision of each unknown of a node and its distance to the guess.
    pub fn prior(&self, node: &Node, guess: &Guess) -> (DVector<f64>, DVector<f64>) {
        let (mut node, mut middle) = (node.clone(), guess.node.clone());
        let unknowns = node.unknowns();
        let precision = DVector::from_fn(unknowns, |i, _| guess.deviation[i].powi(-2));
        let pull = DVector::from_fn(unknowns, |i, _| *middle.at(i) - *node.at(i));
        (precision, pull)
    }

    /// Tries steps with growing damping until one lowers the cost; `None` when none does.
    fn step(&mut self, jacobian: &[WindowJacobian], damping: &mut f64) -> Option<f64> {
        let before = self.cost();
        for _ in 0..9 {
            let normal = Normal::assemble(self.free.len(), jacobian, *damping);
            let (model, moved) = self.moved(&normal, *damping);
            let mut nodes = self.nodes.clone();
            for (window, node) in nodes.iter_mut().enumerate() {
                let step = normal.node_step(window, &moved);
                for i in 0..node.unknowns() {
                    *node.at(i) += step[i];
                }
                self.guesses[window].clamp(node);
            }
            let residuals = residuals(&model, self.data, &nodes);
            self.simulations += 1;
            let after = residuals.cost() + self.prior_cost(&nodes);
            if after < before {
                self.model = model;
                self.nodes = nodes;
                self.residuals = residuals;
                *damping = (*damping / 8.0).max(1e-9);
                return Some(before - after);
            }
            *damping = (*damping * 6.0).max(1e-6);
        }
        None
    }
}
