//! The integration step, chosen from the data: as coarse as the measurement allows to search with,
//! as fine as a found explanation needs to be judged by.

use super::covariance::intervals;
use super::data::FitProblem;
use super::fit::{Fit, FitOptions};
use super::residual::{Residuals, residuals};
use super::solve::fit;
use super::window_start::WindowStart;
use crate::model::{Model, STEP_S};
use crate::motion::Motion;

/// Change of a prediction, in standard deviations of a reading, that no verdict hangs on.
const NEGLIGIBLE: f64 = 0.03;

/// The same where steps are dear: a hundredth of what noise leaves in a square.
const NEGLIGIBLE_SPATIAL: f64 = 0.1;

/// Longest step that a model may take because its own laws allow it, s: of those that are tried on
/// it, the torque of some has corners. A robot in space, whose steps are dear, takes them longer.
const LONGEST_S: f64 = 0.0051;
const LONGEST_SPATIAL_S: f64 = 0.0101;

/// Share of what a fit leaves that its steps may account for: 2 % of the error.
const SHARE: f64 = 0.2;

/// Share of the squared error by which shorter steps may leave more: a fit that is lost in a motion
/// finds other valleys.
const HIGHER: f64 = 0.005;

/// Share of a value's standard error that its steps may account for.
const OF_ERROR: f64 = 0.25;

/// Most halvings: an eighth of the step.
const HALVINGS: usize = 3;

/// The model with the largest step, a whole fraction of the sampling period, whose predictions over
/// these windows differ from those at the model's own step by next to nothing against the noise.
pub fn coarsened(model: &Model, data: &FitProblem) -> Model {
    let window_starts: Vec<WindowStart> = data
        .windows
        .iter()
        .map(|window| data.guessed(window))
        .collect();
    let fine = residuals(model, data, &window_starts);
    let period_s = shortest_period_s(data);
    let steps = (1..=8).map(|parts| period_s / f64::from(parts));
    let steps = steps.take_while(|step_s| *step_s > 1.5 * model.step_s);
    let (longest_s, negligible) = match model.robot {
        Some(_) => (LONGEST_SPATIAL_S, NEGLIGIBLE_SPATIAL),
        None => (LONGEST_S, NEGLIGIBLE),
    };
    for step_s in steps.filter(|step_s| *step_s < longest_s) {
        let coarse = with_step(model, step_s);
        if difference(&fine, &residuals(&coarse, data, &window_starts)) < negligible {
            return coarse;
        }
    }
    model.clone()
}

/// The fit, or one in shorter steps where its own are too long: where half of them change the
/// predictions by a share of what it leaves that counts, and what is left falls by half of that
/// once everything is refitted. A model that is wrong, or lost in a motion that no start state
/// determines, changes too, and leaves no less.
///
/// A law with corners needs shorter steps than the model it was added to: a dead zone, a limit, a
/// grip that slips.
pub(crate) fn in_fine_steps(found: Fit, data: &FitProblem, options: FitOptions) -> Fit {
    halved_while(found, data, options, |found, fine| {
        let left = found.residuals.mean_square();
        let halved = residuals(fine, data, &found.window_starts);
        let changed = difference(&found.residuals, &halved).powi(2);
        let counts = changed >= SHARE * SHARE * left;
        counts.then(|| left - 0.5 * changed.min(left))
    })
}

/// The fit, or one in steps so short that half of them would move none of its values by a share of
/// the standard error that counts. The fit must have its derivatives.
pub(crate) fn in_steps_for_values(found: Fit, data: &FitProblem, options: FitOptions) -> Fit {
    halved_while(found, data, options, |found, fine| {
        let most_left = (1.0 + HIGHER) * found.residuals.mean_square();
        moves_values(found, fine, data).then_some(most_left)
    })
}

/// The fit, or one in steps halved and refitted for as long as `most_left`, told the fit and its
/// model in half the steps, has a mean square that the refit must not exceed, and it does not.
fn halved_while(
    mut found: Fit,
    data: &FitProblem,
    options: FitOptions,
    most_left: impl Fn(&Fit, &Model) -> Option<f64>,
) -> Fit {
    for _ in 0..HALVINGS {
        // No step is longer than what lies between two samples.
        let half_s = 0.5 * found.model.step_s.min(shortest_period_s(data));
        if !STEP_S.allow(half_s) {
            break;
        }
        let fine = with_step(&found.model, half_s);
        let Some(most_left) = most_left(&found, &fine) else {
            break;
        };
        let refitted = fit(
            &fine,
            &found.free,
            data,
            Some(&found.window_starts),
            options,
        );
        if refitted.residuals.mean_square() > most_left {
            break;
        }
        found = Fit {
            simulations: found.simulations + refitted.simulations + 1,
            ..refitted
        };
    }
    found
}

/// Whether a fit of this other model, which differs in its steps, would have other values; as far
/// as the derivatives tell.
fn moves_values(found: &Fit, other: &Model, data: &FitProblem) -> bool {
    let Some((intervals, _)) = intervals(found, data) else {
        return false;
    };
    let after = residuals(other, data, &found.window_starts);
    let moved = found.moved_by(&after);
    let mut values = moved.iter().zip(&intervals);
    values.any(|(moved, interval)| moved.abs() > OF_ERROR * interval.standard_error)
}

fn with_step(model: &Model, step_s: f64) -> Model {
    Model {
        step_s,
        ..model.clone()
    }
}

/// Root-mean-square difference of two predictions, in standard deviations of a reading.
fn difference(one: &Residuals, other: &Residuals) -> f64 {
    let squares = one.less(other).into_iter().flatten().map(|d| d * d);
    (squares.sum::<f64>() / one.count().max(1) as f64).sqrt()
}

/// Usual time between samples, s, of the motion with most of them a second.
fn shortest_period_s(data: &FitProblem) -> f64 {
    let periods = data.motions.iter().map(period_s);
    periods.fold(f64::INFINITY, f64::min)
}

/// Usual time between samples, s.
fn period_s(motion: &Motion) -> f64 {
    motion.duration_s() / motion.len().saturating_sub(1).max(1) as f64
}
