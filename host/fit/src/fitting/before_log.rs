//! What was before a log begins: where a fit looks for it first.
//!
//! A drive that had long had its first input obeys that at once, and one that has rested is far
//! from its limit. There the derivative by what was before is nothing, or leads nowhere, so a fit
//! would never leave it.

use super::data::FitProblem;
use super::fit::Fit;
use super::residual::residuals;
use crate::motion::Motion;
use crate::sim::{HiddenQuantity, HiddenUnknown, Plant};

#[cfg(test)]
mod tests;

/// How much of the most may have come together before: a limit that acts late jumps, so that no
/// slope leads to it.
const AMOUNTS: [f64; 5] = [0.0625, 0.125, 0.25, 0.5, 1.0];

/// Begins each motion with what leaves least: its drives had the same input before, none, or, of
/// goals, one where they stand; they had rested, or had been loaded.
pub(super) fn begin_motions(fit: &mut Fit, data: &FitProblem, hidden: &[HiddenUnknown]) {
    for (at, unknown) in (3 * data.joints()..).zip(hidden) {
        if !unknown.quantity.is_of_motion() {
            continue;
        }
        let mut values: Vec<Vec<f64>> = Vec::new();
        for motion in &data.motions {
            let plant = Plant::new(&fit.model, motion);
            values.push(trials(&plant, motion, unknown));
        }
        let most = values.iter().map(Vec::len).max().unwrap_or(0);
        for trial in 0..most {
            let value = |motion: usize| values[motion].get(trial).copied();
            begin_with(fit, data, (at, &value));
        }
    }
}

/// Begins the motions with these values of the unknown `at` this place that leave less with it.
fn begin_with(
    fit: &mut Fit,
    data: &FitProblem,
    (at, value): (usize, &dyn Fn(usize) -> Option<f64>),
) {
    let mut starts = fit.window_starts.clone();
    for (start, window) in starts.iter_mut().zip(&data.windows) {
        if let Some(value) = value(window.motion) {
            start.unknowns[at] = value;
        }
    }
    let left = residuals(&fit.model, data, &starts);
    fit.simulations += 1;
    for motion in 0..data.motions.len() {
        let windows: Vec<usize> = data.windows_of(motion).map(|(index, _)| index).collect();
        let square = |residuals: &[Vec<f64>]| -> f64 {
            let values = windows.iter().flat_map(|&index| &residuals[index]);
            values.map(|value| value * value).sum()
        };
        if square(&left.windows) < square(&fit.residuals.windows) {
            for &index in &windows {
                fit.window_starts[index] = starts[index].clone();
                fit.residuals.windows[index].clone_from(&left.windows[index]);
            }
        }
    }
}

/// Values of an unknown to begin with in a motion, beside the one that is expected.
fn trials(plant: &Plant, motion: &Motion, unknown: &HiddenUnknown) -> Vec<f64> {
    let joint = unknown.joint;
    match unknown.quantity {
        HiddenQuantity::Before { is_slow: true } => {
            let first = |values: &[f64]| values.first().copied();
            let span = plant.before_span(motion, joint);
            let Some(input) = motion.input[joint].as_deref().and_then(first) else {
                return Vec::new();
            };
            let standing = plant.is_told_angles(joint);
            let standing = standing
                .then(|| first(&motion.position_rad[joint]))
                .flatten();
            let told = [Some(0.0), standing].into_iter().flatten();
            let shares = told.map(|told| (told - input) / span);
            shares.filter(|share| share.abs() <= 1.0).collect()
        }
        HiddenQuantity::Amount { .. } => AMOUNTS.to_vec(),
        HiddenQuantity::Place { flank, .. } if flank > 0.0 => vec![-flank, flank],
        HiddenQuantity::Before { is_slow: false }
        | HiddenQuantity::Place { .. }
        | HiddenQuantity::Speed { .. }
        | HiddenQuantity::Share { .. }
        | HiddenQuantity::Rate => Vec::new(),
    }
}
