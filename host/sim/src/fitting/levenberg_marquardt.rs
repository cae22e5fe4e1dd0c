//! Bounded least squares by Levenberg-Marquardt on the multiple-shooting residual: Levenberg
//! (1944), Marquardt (1963).

use super::data::FitData;
use super::fit::{Fit, FitOptions};
use super::node::{Node, StartGuess};
use super::normal::NormalEquations;
use super::residual::{left_hidden, residuals};
use crate::sim::HiddenUnknown;
use nalgebra::DVector;

/// A fit under way.
pub(super) struct LevenbergMarquardt<'a> {
    pub fit: Fit,
    pub data: &'a FitData,
    pub guesses: Vec<StartGuess>,
    /// What no reading tells of where a window begins.
    pub hidden: Vec<HiddenUnknown>,
}

/// A step that lowers the cost.
struct DescentStep {
    /// By how much.
    reduction: f64,
    /// The same for a residual that is linear.
    predicted: f64,
    values: DVector<f64>,
    nodes: Vec<DVector<f64>>,
}

/// A reduction within this share of the predicted one, either way, speaks for the derivatives.
const TRUSTED: std::ops::RangeInclusive<f64> = 0.5..=2.0;
/// Tries with growing damping: with fresh derivatives, and with corrected ones.
const TRIES: (usize, usize) = (9, 2);
/// Up to as many unknowns, fresh derivatives cost no more than a poor step.
const CHEAP: usize = 3;
/// Fewer samples than this are few.
const FEW_SAMPLES: usize = 500;
/// Damping of the first step, and of the first one with fresh derivatives after a failure.
const DAMPING: f64 = 1e-3;

impl<'a> LevenbergMarquardt<'a> {
    /// Goes on from where `fit` stands.
    pub fn new(mut fit: Fit, data: &'a FitData, mut guesses: Vec<StartGuess>) -> Self {
        let hidden = data.hidden(&fit.model);
        let unknowns = 3 * data.joints() + hidden.len();
        if fit.nodes.iter().any(|node| node.unknowns.len() != unknowns) {
            // Of a model that hides something else.
            (fit.nodes.iter_mut()).for_each(|node| node.forget_hidden(data.joints()));
            fit.jacobian.clear();
        }
        if !hidden.is_empty() {
            let left = left_hidden(&fit.model, data, &fit.nodes);
            for ((node, guess), left) in fit.nodes.iter_mut().zip(&mut guesses).zip(&left) {
                guess.hide(&hidden, left);
                node.hide_as(guess);
            }
            fit.residuals = residuals(&fit.model, data, &fit.nodes);
            fit.simulations += 2;
        }
        LevenbergMarquardt {
            fit,
            data,
            guesses,
            hidden,
        }
    }

    pub fn run(mut self, options: FitOptions) -> Fit {
        let mut damping = DAMPING;
        let mut small_steps = 0;
        if self.fit.jacobian.is_empty() {
            self.linearise();
        }
        for _ in 0..options.iterations {
            let before = self.cost();
            let was_fresh = self.fit.fresh;
            let Some(step) = self.step(&mut damping) else {
                if was_fresh {
                    self.fit.converged = true;
                    break;
                }
                if options.glance {
                    break;
                }
                damping = DAMPING;
                self.linearise();
                continue;
            };
            let least = options.tolerance * before;
            let small = step.reduction < least;
            small_steps = if small { small_steps + 1 } else { 0 };
            // Only fresh derivatives tell that there is no way down; after so small a step they
            // still hold.
            if was_fresh && small && (small_steps >= 2 || step.predicted < least) {
                self.correct(&step);
                self.fit.fresh = true;
                self.fit.converged = true;
                break;
            }
            if small && options.rough {
                self.correct(&step);
                break;
            }
            // A fit that is only compared goes on with doubtful derivatives while they lead down.
            let trusted = options.rough || TRUSTED.contains(&(step.reduction / step.predicted));
            if small || !trusted || self.is_cheap() {
                self.linearise();
            } else {
                self.correct(&step);
            }
        }
        if !self.fit.fresh && !options.rough {
            self.linearise();
        }
        self.fit
    }

    /// Whether fresh derivatives cost next to nothing: few unknowns, or few samples, whose valleys
    /// are many and narrow.
    fn is_cheap(&self) -> bool {
        let node = self.fit.nodes.first();
        self.fit.free.len() + node.map_or(0, |node| node.unknowns.len()) <= CHEAP
            || self.data.samples() < FEW_SAMPLES
    }

    /// Fresh derivatives.
    fn linearise(&mut self) {
        self.fit.jacobian = self.jacobian();
        self.fit.fresh = true;
    }

    /// Derivatives corrected by what a step brought.
    fn correct(&mut self, step: &DescentStep) {
        let fit = &mut self.fit;
        for (w, window) in fit.jacobian.iter_mut().enumerate() {
            let (guess, node) = (&self.guesses[w], &fit.nodes[w]);
            window.correct(&step.values, &step.nodes[w], &fit.residuals.windows[w]);
            (window.node_precision, window.node_pull) = guess.prior(node);
            window.node_edge = guess.edges(node);
            window.hold_edges();
        }
    }

    /// Squared residuals plus the nodes' weak priors.
    fn cost(&self) -> f64 {
        self.fit.residuals.cost() + self.prior_cost(&self.fit.nodes)
    }

    fn prior_cost(&self, nodes: &[Node]) -> f64 {
        let mut sum = 0.0;
        for (node, guess) in nodes.iter().zip(&self.guesses) {
            let (precision, pull) = guess.prior(node);
            sum += precision.component_mul(&pull).dot(&pull);
        }
        sum
    }

    /// Tries steps with growing damping until one lowers the cost; `None` when none does.
    fn step(&mut self, damping: &mut f64) -> Option<DescentStep> {
        let before = self.cost();
        let tries = if self.fit.fresh { TRIES.0 } else { TRIES.1 };
        for _ in 0..tries {
            let free = self.fit.free.len();
            let normal = NormalEquations::assemble(free, &self.fit.jacobian, *damping);
            let (model, values) = self.moved(&normal, *damping);
            let mut nodes = self.fit.nodes.clone();
            let steps: Vec<DVector<f64>> = nodes
                .iter_mut()
                .enumerate()
                .map(|(w, node)| self.move_node(node, w, &normal.node_step(w, &values)))
                .collect();
            let residuals = residuals(&model, self.data, &nodes);
            self.fit.simulations += 1;
            let prior = self.prior_cost(&nodes);
            let after = residuals.cost() + prior;
            if after < before {
                let windows = self.fit.jacobian.iter().zip(&steps);
                let linear: f64 = windows
                    .map(|(window, node)| window.linear_residual(&values, node).norm_squared())
                    .sum();
                self.fit.model = model;
                self.fit.nodes = nodes;
                self.fit.residuals = residuals;
                self.fit.fresh = false;
                *damping = (*damping / 8.0).max(1e-9);
                return Some(DescentStep {
                    reduction: before - after,
                    predicted: before - (linear + prior),
                    values,
                    nodes: steps,
                });
            }
            *damping = (*damping * 6.0).max(1e-6);
        }
        None
    }

    /// Moves a window's start state as far as it may go, and says how far that was.
    fn move_node(&self, node: &mut Node, window: usize, step: &DVector<f64>) -> DVector<f64> {
        let from = node.unknowns.clone();
        node.unknowns += step;
        self.guesses[window].clamp(node);
        &node.unknowns - from
    }
}
