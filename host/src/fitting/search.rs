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
    jacobian: Vec<WindowJacobian>,
    /// Whether the derivatives are those at the present values, not corrected ones of steps before.
    fresh: bool,
}

/// What a step brought.
struct Step {
    /// By how much the cost fell.
    fall: f64,
    /// By how much it would have fallen, were the residual straight.
    foretold: f64,
    values: DVector<f64>,
    nodes: Vec<DVector<f64>>,
}

/// A fall within this share of the foretold one, either way, speaks for the derivatives.
const TRUSTED: std::ops::RangeInclusive<f64> = 0.5..=2.0;
/// Tries with growing damping: with fresh derivatives, and with corrected ones.
const TRIES: (usize, usize) = (9, 2);
/// Up to as many unknowns, fresh derivatives cost no more than a poor step.
const CHEAP: usize = 3;
/// Fewer samples than this are few.
const FEW_SAMPLES: usize = 500;

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
            jacobian: Vec::new(),
            fresh: false,
        }
    }

    /// Goes on where an earlier fit to the same data ended.
    pub fn resume(fit: &'a Fit, data: &'a Data, guesses: Vec<Guess>) -> Self {
        Search {
            free: &fit.free,
            data,
            guesses,
            model: fit.model.clone(),
            nodes: fit.nodes.clone(),
            residuals: fit.residuals.clone(),
            simulations: 0,
            jacobian: fit.jacobian.clone(),
            fresh: fit.fresh,
        }
    }

    pub fn run(mut self, options: FitOptions) -> Fit {
        let mut damping = 1e-3;
        let mut converged = false;
        let mut quiet = 0;
        if self.jacobian.is_empty() {
            self.derive();
        }
        for _ in 0..options.iterations {
            let before = self.cost();
            let was_fresh = self.fresh;
            let Some(step) = self.step(&mut damping) else {
                if was_fresh {
                    converged = true;
                    break;
                }
                damping = 1e-3;
                self.derive();
                continue;
            };
            let least = options.tolerance * before;
            let small = step.fall < least;
            quiet = if small { quiet + 1 } else { 0 };
            // Only fresh derivatives tell that there is no way down; after so small a step they still hold.
            if was_fresh && small && (quiet >= 2 || step.foretold < least) {
                self.correct(&step);
                self.fresh = true;
                converged = true;
                break;
            }
            if small && options.rough {
                self.correct(&step);
                break;
            }
            if small || !TRUSTED.contains(&(step.fall / step.foretold)) || self.is_cheap() {
                self.derive();
            } else {
                self.correct(&step);
            }
        }
        if !self.fresh && !options.rough {
            self.derive();
        }
        Fit {
            model: self.model,
            free: self.free.to_vec(),
            nodes: self.nodes,
            residuals: self.residuals,
            converged,
            simulations: self.simulations,
            jacobian: self.jacobian,
            fresh: self.fresh,
        }
    }

    /// Whether fresh derivatives cost next to nothing: few unknowns, or few samples, whose valleys are many and narrow.
    fn is_cheap(&self) -> bool {
        self.free.len() + self.nodes.first().map_or(0, Node::unknowns) <= CHEAP
            || self.data.samples() < FEW_SAMPLES
    }

    /// Fresh derivatives.
    fn derive(&mut self) {
        self.jacobian = self.jacobian();
        self.fresh = true;
    }

    /// Derivatives corrected by what a step brought.
    fn correct(&mut self, step: &Step) {
        let mut jacobian = std::mem::take(&mut self.jacobian);
        for (w, window) in jacobian.iter_mut().enumerate() {
            window.correct(&step.values, &step.nodes[w], &self.residuals.windows[w]);
            (window.node_precision, window.node_pull) =
                self.prior(&self.nodes[w], &self.guesses[w]);
            window.node_edge = self.guesses[w].edges(&self.nodes[w]);
            window.hold_edges();
        }
        self.jacobian = jacobian;
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
    fn step(&mut self, damping: &mut f64) -> Option<Step> {
        let before = self.cost();
        let tries = if self.fresh { TRIES.0 } else { TRIES.1 };
        for _ in 0..tries {
            let normal = Normal::assemble(self.free.len(), &self.jacobian, *damping);
            let (model, values) = self.moved(&normal, *damping);
            let mut nodes = self.nodes.clone();
            let mut node_steps = Vec::with_capacity(nodes.len());
            for (window, node) in nodes.iter_mut().enumerate() {
                node_steps.push(self.move_node(node, window, &normal.node_step(window, &values)));
            }
            let residuals = residuals(&model, self.data, &nodes);
            self.simulations += 1;
            let prior = self.prior_cost(&nodes);
            let after = residuals.cost() + prior;
            if after < before {
                let windows = self.jacobian.iter().zip(&node_steps);
                let straight: f64 = windows
                    .map(|(window, node)| window.straight(&values, node).norm_squared())
                    .sum();
                self.model = model;
                self.nodes = nodes;
                self.residuals = residuals;
                self.fresh = false;
                *damping = (*damping / 8.0).max(1e-9);
                return Some(Step {
                    fall: before - after,
                    foretold: before - (straight + prior),
                    values,
                    nodes: node_steps,
                });
            }
            *damping = (*damping * 6.0).max(1e-6);
        }
        None
    }

    /// Moves a window's start state as far as it may go, and says how far that was.
    fn move_node(&self, node: &mut Node, window: usize, step: &DVector<f64>) -> DVector<f64> {
        let mut from = node.clone();
        for i in 0..node.unknowns() {
            *node.at(i) += step[i];
        }
        self.guesses[window].clamp(node);
        DVector::from_fn(node.unknowns(), |i, _| *node.at(i) - *from.at(i))
    }
}
