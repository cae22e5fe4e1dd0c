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
use super::verdict::MOST_RAISED;
use crate::fitting::{FitOptions, FitProblem, fit, fit_start_states};
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

/// Largest factor by which an explanation raises the error of motions held out in turn; 1 where it
/// raises none.
pub(super) fn most_raised(folds: &[Fold]) -> f64 {
    let raised = folds.iter().map(|fold| fold.after_rad / fold.before_rad);
    raised.fold(1.0, f64::max)
}

/// Largest error that an explanation leaves of motions held out in turn, rad; 0 where none are.
pub(super) fn most_left_rad(folds: &[Fold]) -> f64 {
    let left = folds.iter().map(|fold| fold.after_rad);
    left.fold(0.0, f64::max)
}

/// That an explanation gains nothing on some of the motions held out in turn.
pub(super) fn warning(folds: &[Fold]) -> Option<String> {
    let lost = folds.iter().filter(|fold| !fold.gains).count();
    let raised = most_raised(folds);
    let much = if raised > MOST_RAISED {
        format!(", and raises the error up to {raised:.1} times")
    } else {
        String::new()
    };
    (lost > 0).then(|| {
        format!(
            "with other motions held out the explanation gains nothing in {lost} of {} cases{much}",
            folds.len()
        )
    })
}

fn names(data: &FitProblem) -> Vec<String> {
    data.motions
        .iter()
        .map(|motion| motion.name.clone())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fold(before_rad: f64, after_rad: f64) -> Fold {
        Fold {
            held_out: Vec::new(),
            before_rad,
            after_rad,
            gains: after_rad < before_rad,
        }
    }

    #[test]
    fn the_fold_that_is_raised_most_counts_and_is_told() {
        let good = [fold(0.1, 0.01), fold(0.1, 0.02)];
        assert_eq!(most_raised(&good), 1.0);
        assert_eq!([most_left_rad(&good), most_left_rad(&[])], [0.02, 0.0]);
        assert_eq!(warning(&good), None);
        let mixed = [fold(0.1, 0.01), fold(0.02, 0.025), fold(0.02, 0.024)];
        assert_eq!(most_raised(&mixed), 0.025 / 0.02);
        let told = warning(&mixed).unwrap();
        assert!(told.ends_with("gains nothing in 2 of 3 cases"), "{told}");
        let spoiled = [fold(0.1, 0.01), fold(0.02, 0.06)];
        let told = warning(&spoiled).unwrap();
        assert!(
            told.ends_with("1 of 2 cases, and raises the error up to 3.0 times"),
            "{told}"
        );
    }
}
