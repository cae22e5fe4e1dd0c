//! Which of several structures: the plainest that foretells new data as well as the best.

use super::estimate::{Estimate, Unfitted, estimate};
use super::record::Record;
use super::score::{Score, prediction_errors, score};
use super::structure::Structure;
use rayon::prelude::*;

/// A structure that was tried.
#[derive(Debug, Clone)]
pub struct Trial {
    /// What was tried.
    pub structure: Structure,
    /// What came of it.
    pub outcome: Result<Fitted, Unfitted>,
}

/// A fitted structure with its score.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// The model.
    pub estimate: Estimate,
    /// On the data it was fitted to.
    pub training: Score,
    /// On the data held out.
    pub validation: Score,
}

/// Fits every structure to `training` and scores it on `validation`. `done` is called after each.
pub fn try_all(
    structures: &[Structure],
    training: &[Record],
    validation: &[Record],
    done: &(dyn Fn() + Sync),
) -> Vec<Trial> {
    structures
        .par_iter()
        .map(|structure| {
            let outcome = estimate(structure, training).map(|estimate| Fitted {
                training: score(&estimate.model, training),
                validation: score(&estimate.model, validation),
                estimate,
            });
            done();
            Trial {
                structure: *structure,
                outcome,
            }
        })
        .collect()
}

/// The trial to keep: of those whose squared one-step errors on `validation` are not above the best one's by more
/// than twice the standard error of the difference, the one with the fewest coefficients; among equals the best.
/// A model whose validation error is no number is never kept.
pub fn select(trials: &[Trial], validation: &[Record]) -> Option<usize> {
    let fitted: Vec<(usize, &Fitted)> = trials
        .iter()
        .enumerate()
        .filter_map(|(index, trial)| Some((index, trial.outcome.as_ref().ok()?)))
        .filter(|(_, fitted)| fitted.validation.error_rms.is_finite())
        .collect();
    let error = |fitted: &Fitted| fitted.validation.error_rms;
    let (_, best) = fitted
        .iter()
        .min_by(|a, b| error(a.1).total_cmp(&error(b.1)))?;
    let squares = |fitted: &Fitted| -> Vec<f64> {
        let errors = prediction_errors(&fitted.estimate.model, validation);
        errors.into_iter().flatten().map(|e| e * e).collect()
    };
    let least = squares(best);
    let as_good = |fitted: &Fitted| {
        let differences: Vec<f64> = squares(fitted)
            .iter()
            .zip(&least)
            .map(|(own, least)| own - least)
            .collect();
        let count = differences.len().max(2) as f64;
        let mean = differences.iter().sum::<f64>() / count;
        let spread: f64 = differences.iter().map(|d| (d - mean).powi(2)).sum();
        mean <= 2.0 * (spread / (count * (count - 1.0))).sqrt()
    };
    fitted
        .iter()
        .filter(|(_, fitted)| as_good(fitted))
        .min_by(|(_, a), (_, b)| {
            let count = |fitted: &Fitted| fitted.estimate.structure.count();
            count(a).cmp(&count(b)).then(error(a).total_cmp(&error(b)))
        })
        .map(|(index, _)| *index)
}
