//! Whether an explanation holds whichever motions are held out.
//!
//! Those that happen to be held out may miss what the others show. So every motion, or every fifth,
//! is held out once: the model is refitted to the rest, without the explanation and with it, and
//! both predict what was held out (cross-validation: Stone 1974, JRSS B 36, 111).

use super::block_errors::{BlockErrors, gain, paired};
use super::budget::EVALUATE;
use super::evaluator::Evaluator;
use super::findings::Fold;
use super::hypothesis::Hypothesis;
use crate::fitting::{FitData, FitOptions, fit, fit_start_states};
use rayon::prelude::*;

/// Most folds.
const FOLDS: usize = 5;

/// What an explanation gains over the model without it, fold by fold; none with fewer than three
/// motions.
pub(super) fn folds(evaluator: &Evaluator, before: &Hypothesis, after: &Hypothesis) -> Vec<Fold> {
    let all = match &evaluator.held_out {
        Some(held_out) => evaluator.training.joined(held_out),
        None => evaluator.training.clone(),
    };
    let motions = all.motions.len();
    if motions < 3 {
        return Vec::new();
    }
    let count = motions.min(FOLDS);
    let fold = |fold: usize| {
        let held = |motion: usize| motion % count == fold;
        let (rest, held_out) = (all.part(|m| !held(m)), all.part(held));
        let predicted = |hypothesis: &Hypothesis| {
            let from = hypothesis.fit();
            let options = FitOptions::iterations(EVALUATE).rough();
            let refitted = fit(&from.model, &from.free, &rest, None, options);
            BlockErrors::of(
                &fit_start_states(&refitted.model, &held_out).residuals,
                &held_out,
            )
        };
        let [before, after] = [before, after].map(predicted);
        Fold {
            held_out: names(&held_out),
            before_rad: before.rms_rad(),
            after_rad: after.rms_rad(),
            gains: gain(&paired(&before, &after)) > 0.0,
        }
    };
    (0..count).into_par_iter().map(fold).collect()
}

fn names(data: &FitData) -> Vec<String> {
    data.motions
        .iter()
        .map(|motion| motion.name.clone())
        .collect()
}
