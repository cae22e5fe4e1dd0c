//! The error budget of an explanation: how much of the error each of its parts removes, alone and
//! beyond all others.
//!
//! Parts that stand in for each other remove much alone and little beyond the others; parts that
//! only help together do the reverse. So the shares need not add up.

use super::block_errors::{BlockErrors, PairedSums, bootstrap, paired};
use super::budget::LOOK;
use super::evaluator::Evaluator;
use super::explanation::{Explanation, VerdictEvidence};
use super::findings::{BudgetShare, BudgetedPart, FREE_VALUES};
use super::hypothesis::Hypothesis;
use crate::fitting::{Candidate, FitOptions, fit};
use crate::model::ParameterPath;
use rayon::prelude::*;

/// What of the explanation is taken alone, and out of it.
enum Part {
    /// The n-th effect.
    Effect(usize),
    /// The wrong values.
    Values,
    /// The values that the file frees, refitted.
    Free,
}

/// The parts of the chosen explanation with their shares; none where the model as given explains
/// the motions.
pub(super) fn error_budget(evidence: &VerdictEvidence) -> Vec<BudgetedPart> {
    let (evaluator, chosen) = (evidence.evaluator, evidence.chosen());
    let frees = !evaluator.base.search.free.is_empty();
    let effects = (0..chosen.set.len()).map(Part::Effect);
    let parts: Vec<Part> = match evidence.explanation {
        Explanation::Given(_) => Vec::new(),
        Explanation::Value(_) => vec![Part::Values],
        Explanation::Refit(_) => vec![Part::Free],
        Explanation::ValueAndRefit(_) => vec![Part::Values, Part::Free],
        Explanation::Effects(_) => effects.chain(frees.then_some(Part::Free)).collect(),
    };
    let only = parts.len() == 1;
    let shares = parts.par_iter().filter_map(|part| {
        let given = evaluator.given.deciding()?;
        let all = chosen.deciding()?;
        let (alone, without) = if only {
            (all.clone(), given.clone())
        } else {
            (
                alone(evidence, part).deciding()?.clone(),
                without(evaluator, chosen, part).deciding()?.clone(),
            )
        };
        let share = |left: &BlockErrors, removed_from: &BlockErrors| BudgetShare {
            error_rad: left.rms_rad(),
            ..share(&removed_from.less(left), given, evidence.seed)
        };
        Some(BudgetedPart {
            part: name(chosen, part),
            alone: share(&alone, given),
            beyond_others: BudgetShare {
                error_rad: without.rms_rad(),
                ..share(all, &without)
            },
        })
    });
    shares.collect()
}

fn name(chosen: &Hypothesis, part: &Part) -> String {
    match part {
        Part::Effect(index) => chosen.set[*index].to_string(),
        Part::Values => {
            let paths = chosen.values.iter().map(ToString::to_string);
            paths.collect::<Vec<String>>().join(" + ")
        }
        Part::Free => FREE_VALUES.to_string(),
    }
}

/// The model as given with one part alone; an effect with the free values refitted, as it was
/// tried.
fn alone(evidence: &VerdictEvidence, part: &Part) -> Hypothesis {
    let (evaluator, chosen) = (evidence.evaluator, evidence.chosen());
    let mut hypothesis = match part {
        Part::Free => evaluator.base.clone(),
        Part::Effect(index) => {
            let effect = chosen.set[*index];
            let tried = evidence.tried.hypotheses.iter();
            let mut known = tried.filter(|h| h.adds(&[effect]) && h.evaluation.is_some());
            known.next().cloned().unwrap_or_else(|| {
                let instance = chosen.search.model.effects.iter().find(|e| effect.is(e));
                let values = instance.map_or(&[][..], |instance| &instance.values);
                let options = FitOptions::iterations(LOOK).rough();
                evaluator
                    .base
                    .with(effect, values, &evaluator.search, options)
            })
        }
        Part::Values => {
            let tried = evidence.tried.values.iter();
            let mut known = tried.filter(|h| h.values == chosen.values);
            known.next().cloned().unwrap_or_else(|| {
                let options = FitOptions::iterations(LOOK);
                let found = fit(
                    &evaluator.start,
                    &chosen.values,
                    &evaluator.search,
                    None,
                    options,
                );
                Hypothesis {
                    values: chosen.values.clone(),
                    ..Hypothesis::new(Vec::new(), found)
                }
            })
        }
    };
    evaluator.evaluate(&mut hypothesis);
    hypothesis
}

/// The explanation without one part, the others refitted.
fn without(evaluator: &Evaluator, chosen: &Hypothesis, part: &Part) -> Hypothesis {
    let mut hypothesis = match part {
        Part::Effect(_) if chosen.set.len() == 1 => evaluator.base.clone(),
        Part::Effect(index) => chosen.without(*index, &evaluator.base, &evaluator.search, LOOK),
        Part::Values => evaluator.base.clone(),
        Part::Free => {
            let mut model = evaluator.start.clone();
            let added = chosen.search.model.effects.iter();
            let added = added.filter(|e| chosen.set.contains(&Candidate::from(*e)));
            model.effects.extend(added.cloned());
            let mut free: Vec<ParameterPath> = chosen.values.clone();
            free.extend(
                chosen
                    .set
                    .iter()
                    .flat_map(|c| c.paths().collect::<Vec<_>>()),
            );
            let options = FitOptions::iterations(LOOK);
            let found = fit(&model, &free, &evaluator.search, None, options);
            Hypothesis {
                values: chosen.values.clone(),
                ..Hypothesis::new(chosen.set.clone(), found)
            }
        }
    };
    evaluator.evaluate(&mut hypothesis);
    hypothesis
}

/// Sum of the removed squares over that of the model as given, and its 95 % interval.
fn share(removed: &BlockErrors, given: &BlockErrors, seed: u64) -> BudgetShare {
    let ratio = |motions: &[PairedSums]| {
        let sum = |part: fn(&PairedSums) -> f64| motions.iter().map(part).sum::<f64>();
        sum(|m| m.before) / sum(|m| m.after).max(1e-300)
    };
    let [low, high] = bootstrap(removed, given, seed, ratio);
    BudgetShare {
        error_rad: f64::NAN,
        share: ratio(&paired(removed, given)),
        low,
        high,
    }
}
