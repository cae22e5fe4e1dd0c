//! Order selection: the structure with the fewest coefficients that predicts new data as well as
//! the best.

use super::estimate::{Estimate, Unfitted, estimate};
use super::record::Record;
use super::score::{FitScore, prediction_errors, score};
use super::structure::Structure;
use rayon::prelude::*;

/// A structure that was tried.
#[derive(Debug, Clone)]
pub struct TriedStructure {
    /// What was tried.
    pub structure: Structure,
    /// What came of it.
    pub outcome: Result<FittedModel, Unfitted>,
}

/// A fitted structure with its score.
#[derive(Debug, Clone)]
pub struct FittedModel {
    /// The model.
    pub estimate: Estimate,
    /// On the data it was fitted to.
    pub training: FitScore,
    /// On the data held out.
    pub validation: FitScore,
}

/// Fits every structure to `training` and scores it on `validation`. `done` is called after each.
pub fn try_all(
    structures: &[Structure],
    training: &[Record],
    validation: &[Record],
    done: &(dyn Fn() + Sync),
) -> Vec<TriedStructure> {
    structures
        .par_iter()
        .map(|structure| {
            let outcome = estimate(structure, training).map(|estimate| FittedModel {
                training: score(&estimate.model, training),
                validation: score(&estimate.model, validation),
                estimate,
            });
            done();
            TriedStructure {
                structure: *structure,
                outcome,
            }
        })
        .collect()
}

/// The trial to keep: of those whose squared one-step errors on `validation` are not above the best
/// one's by more than twice the standard error of the difference, the one with the fewest
/// coefficients; among equals the best. A model whose validation error is no number is never kept.
pub fn select(trials: &[TriedStructure], validation: &[Record]) -> Option<usize> {
    let fitted: Vec<(usize, &FittedModel)> = trials
        .iter()
        .enumerate()
        .filter_map(|(index, trial)| Some((index, trial.outcome.as_ref().ok()?)))
        .filter(|(_, fitted)| fitted.validation.error_rms.is_finite())
        .collect();
    let error = |fitted: &FittedModel| fitted.validation.error_rms;
    let (_, best) = fitted
        .iter()
        .min_by(|a, b| error(a.1).total_cmp(&error(b.1)))?;
    let squares = |fitted: &FittedModel| -> Vec<f64> {
        let errors = prediction_errors(&fitted.estimate.model, validation);
        errors.into_iter().flatten().map(|e| e * e).collect()
    };
    let least = squares(best);
    let as_good = |fitted: &FittedModel| {
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
            let count = |fitted: &FittedModel| fitted.estimate.structure.count();
            count(a).cmp(&count(b)).then(error(a).total_cmp(&error(b)))
        })
        .map(|(index, _)| *index)
}
