//! Bounded least squares by Levenberg-Marquardt on the multiple-shooting residual: Levenberg
//! (1944), Marquardt (1963).

use super::before_log::begin_motions;
use super::data::FitProblem;
use super::fit::{Fit, FitOptions};
use super::prior::ValuePrior;
use super::residual::{left_hidden, residuals};
use super::window_start::{StartGuess, WindowStart};
use crate::model::Model;
use crate::sim::HiddenUnknown;
use nalgebra::DVector;

/// A fit under way.
pub(super) struct LevenbergMarquardt<'a> {
    pub fit: Fit,
    pub data: &'a FitProblem,
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
    window_starts: Vec<DVector<f64>>,
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
    pub fn new(mut fit: Fit, data: &'a FitProblem, mut guesses: Vec<StartGuess>) -> Self {
        let hidden = data.hidden(&fit.model);
        let unknowns = 3 * data.joints() + hidden.len();
        let is_new =
            (fit.window_starts.iter()).any(|window_start| window_start.unknowns.len() != unknowns);
        if is_new {
            // Of a model that hides something else.
            (fit.window_starts.iter_mut())
                .for_each(|window_start| window_start.forget_hidden(data.joints()));
            fit.jacobian.clear();
        }
        if !hidden.is_empty() {
            let left = left_hidden(&fit.model, data, &fit.window_starts);
            let starts = fit.window_starts.iter_mut().zip(&mut guesses);
            let windows = data.windows.iter().zip(&left);
            for ((window_start, guess), (window, left)) in starts.zip(windows) {
                guess.hide(&hidden, left, data.windows_of(window.motion).count());
                window_start.hide_as(guess);
            }
            fit.residuals = residuals(&fit.model, data, &fit.window_starts);
            fit.simulations += 2;
            if is_new {
                begin_motions(&mut fit, data, &hidden);
            }
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
            self.fit.weigh_prior();
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
        self.fit.weigh_prior();
        self.fit
    }

    /// Whether fresh derivatives cost next to nothing: few unknowns, or few samples, whose valleys
    /// are many and narrow.
    fn is_cheap(&self) -> bool {
        let window_start = self.fit.window_starts.first();
        self.fit.free.len() + window_start.map_or(0, |window_start| window_start.unknowns.len())
            <= CHEAP
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
            let (guess, window_start) = (&self.guesses[w], &fit.window_starts[w]);
            window.correct(
                &step.values,
                &step.window_starts[w],
                &fit.residuals.windows[w],
            );
            window.know_start(guess.prior(window_start), guess.edges(window_start));
        }
    }

    /// Squared residuals plus the starts' weak priors and what is known of the values.
    fn cost(&self) -> f64 {
        self.fit.residuals.cost() + self.prior_cost(&self.fit.model, &self.fit.window_starts)
    }

    fn prior_cost(&self, model: &Model, window_starts: &[WindowStart]) -> f64 {
        let mut sum = ValuePrior::of(model, &self.fit.free, self.fit.prior_weight).cost;
        for (window_start, guess) in window_starts.iter().zip(&self.guesses) {
            let (precision, pull) = guess.prior(window_start);
            sum += precision.component_mul(&pull).dot(&pull);
        }
        sum
    }

    /// Tries steps with growing damping until one lowers the cost; `None` when none does.
    fn step(&mut self, damping: &mut f64) -> Option<DescentStep> {
        let before = self.cost();
        let tries = if self.fit.fresh { TRIES.0 } else { TRIES.1 };
        for _ in 0..tries {
            let normal = self.fit.normal_equations(*damping);
            let (model, values) = self.moved(&normal, *damping);
            let mut window_starts = self.fit.window_starts.clone();
            let steps: Vec<DVector<f64>> = window_starts
                .iter_mut()
                .enumerate()
                .map(|(w, window_start)| {
                    self.move_node(window_start, w, &normal.start_step(w, &values))
                })
                .collect();
            let residuals = residuals(&model, self.data, &window_starts);
            self.fit.simulations += 1;
            let prior = self.prior_cost(&model, &window_starts);
            let after = residuals.cost() + prior;
            if after < before {
                let windows = self.fit.jacobian.iter().zip(&steps);
                let linear: f64 = windows
                    .map(|(window, window_start)| {
                        window.linear_residual(&values, window_start).norm_squared()
                    })
                    .sum();
                self.fit.model = model;
                self.fit.window_starts = window_starts;
                self.fit.residuals = residuals;
                self.fit.fresh = false;
                *damping = (*damping / 8.0).max(1e-9);
                return Some(DescentStep {
                    reduction: before - after,
                    predicted: before - (linear + prior),
                    values,
                    window_starts: steps,
                });
            }
            *damping = (*damping * 6.0).max(1e-6);
        }
        None
    }

    /// Moves a window's start state as far as it may go, and says how far that was.
    fn move_node(
        &self,
        window_start: &mut WindowStart,
        window: usize,
        step: &DVector<f64>,
    ) -> DVector<f64> {
        let from = window_start.unknowns.clone();
        window_start.unknowns += step;
        self.guesses[window].clamp(window_start);
        &window_start.unknowns - from
    }
}
