//! The simplest explanation that the evidence allows, and its rivals.

use super::block_errors::BlockErrors;
use super::evaluator::Evaluator;
use super::findings::{Fold, ResidualStructure, SearchEnded, Verdict};
use super::hypothesis::Hypothesis;
use super::measured_value::values_behind;
use super::stability::{most_left_rad, most_raised};
use super::verdict::{Kind, Signs};

/// Standard uncertainties beyond which a file is not believed to be wrong if something nearer to it
/// does as well: a mass or a distance of 2.7 times, a moment of inertia of 55 times what it says.
const INCREDIBLE: f64 = 20.0;

/// Every explanation that was tried.
#[derive(Default)]
pub(super) struct SearchOutcome {
    /// Sets of effects.
    pub hypotheses: Vec<Hypothesis>,
    /// Every single value of the given model, refitted.
    pub values: Vec<Hypothesis>,
    /// The same along with the free values, for values that are not free.
    pub values_refitted: Vec<Hypothesis>,
    /// The smallest set that improves.
    pub best: Option<Hypothesis>,
}

/// Everything the verdict rests on.
pub(super) struct VerdictEvidence<'a> {
    pub evaluator: &'a Evaluator<'a>,
    pub tried: &'a SearchOutcome,
    /// The simplest explanation that is not clearly worse than the best.
    pub explanation: Explanation<'a>,
    /// Those whose predictions no noise lets these motions tell from it.
    pub equivalents: Vec<Hypothesis>,
    /// Placebo regressors that gain anything, evaluated, where effects are the explanation.
    pub placebos: Vec<Hypothesis>,
    pub residual_structure: Option<ResidualStructure>,
    /// Share of what is left that goes when every motion has values of its own.
    pub per_motion_reduction: Option<f64>,
    /// The explanation with other motions held out.
    pub folds: Vec<Fold>,
    pub seed: u64,
    /// How the search ended.
    pub ended: SearchEnded,
    /// What was not examined, in words.
    pub left_out: Vec<String>,
    /// Motions that alone show what is explained, where none is left to prove it.
    pub shows_alone: Vec<String>,
}

/// What explains the measurement, the simplest that does.
#[derive(Clone, Copy)]
pub(super) enum Explanation<'a> {
    /// The model as given.
    Given(&'a Hypothesis),
    /// One other value in the model file.
    Value(&'a Hypothesis),
    /// Other values for all that are free.
    Refit(&'a Hypothesis),
    /// Other values for all that are free, and for one that is not.
    ValueAndRefit(&'a Hypothesis),
    /// Missing effects.
    Effects(&'a Hypothesis),
}

impl<'a> Explanation<'a> {
    pub fn hypothesis(self) -> &'a Hypothesis {
        match self {
            Explanation::Given(h) | Explanation::Value(h) => h,
            Explanation::Refit(h) | Explanation::ValueAndRefit(h) => h,
            Explanation::Effects(h) => h,
        }
    }

    /// What it changes, for people.
    pub fn name(self) -> String {
        match self {
            Explanation::Given(_) => "the model as given".to_string(),
            Explanation::Refit(_) => "the refitted model".to_string(),
            _ => self.hypothesis().names().join(" + "),
        }
    }
}

impl SearchOutcome {
    /// The simplest explanation that is not clearly worse than the best.
    pub fn explanation<'a>(&'a self, evaluator: &'a Evaluator<'a>) -> Explanation<'a> {
        let (given, base) = (&evaluator.given, &evaluator.base);
        let champion = match &self.best {
            Some(best) => Explanation::Effects(best),
            None if evaluator.improves(given, base) => Explanation::Refit(base),
            None => Explanation::Given(given),
        };
        let best = champion.hypothesis();
        let refitted = evaluator
            .accepted(base, &self.values_refitted)
            .filter(|value| !evaluator.clearly_worse(value, best, base));
        let leaves_less = |value: &&Hypothesis| value.deciding_mean() < best.deciding_mean();
        let least = refitted.filter(leaves_less).unwrap_or(best);
        match evaluator.accepted(given, &self.values) {
            Some(value) if !evaluator.clearly_worse(value, least, given) => {
                Explanation::Value(value)
            }
            _ => refitted.map_or(champion, Explanation::ValueAndRefit),
        }
    }
}

impl<'a> VerdictEvidence<'a> {
    pub fn chosen(&self) -> &'a Hypothesis {
        self.explanation.hypothesis()
    }

    /// Explanations no less simple than the chosen one that the data do not tell from it.
    /// The simplest come first.
    pub fn rivals(&self) -> Vec<&Hypothesis> {
        let mut rivals = self.as_good();
        let chosen = self.chosen();
        for other in self.equivalents.iter().filter(|h| !h.extends(chosen)) {
            let is_same = |h: &&Hypothesis| h.values == other.values && h.adds(&other.set);
            if !rivals.iter().any(is_same) {
                rivals.push(other);
            }
        }
        rivals.sort_by(|a, b| Hypothesis::by_simplicity(a, b));
        rivals
    }

    /// Whether rivals leave the verdict open. The values that the file frees are what its owner
    /// does not know: where they explain all, an effect that would too is only mentioned.
    fn is_open(&self, rivals: &[&Hypothesis]) -> bool {
        let (start, free) = (&self.evaluator.start, &self.evaluator.base.search.free);
        let is_unknown = |path| free.contains(path) && start.uncertain(*path).is_none();
        let is_freed = match self.explanation {
            Explanation::Refit(_) => true,
            Explanation::Value(value) => value.values.iter().all(is_unknown),
            _ => false,
        };
        let open = |rivals: &[&Hypothesis]| {
            let mut open = rivals.iter().filter(|rival| !self.says_the_same(rival));
            open.any(|rival| self.is_believable(rival))
        };
        if is_freed {
            open(&self.as_good())
        } else {
            open(rivals)
        }
    }

    /// Whether the file may be as wrong as a rival says it is; where the explanation asks for as
    /// much, every rival may.
    fn is_believable(&self, rival: &Hypothesis) -> bool {
        let [own, other] = [self.chosen(), rival].map(|h| h.deviation(&self.evaluator.start));
        other <= INCREDIBLE || own > INCREDIBLE
    }

    /// Whether a rival is the explanation in other words in any experiment: a scale, and the value
    /// of the file that it scales.
    pub fn says_the_same(&self, rival: &Hypothesis) -> bool {
        let model = &self.evaluator.start;
        let is_behind = |value: &Hypothesis, effect: &Hypothesis| {
            let [candidate] = &effect.set[..] else {
                return false;
            };
            value.set.is_empty()
                && effect.values.is_empty()
                && !value.values.is_empty()
                && value.values == values_behind(candidate, model)
        };
        is_behind(self.chosen(), rival) || is_behind(rival, self.chosen())
    }

    /// Explanations that are significantly no worse.
    fn as_good(&self) -> Vec<&'a Hypothesis> {
        match self.explanation {
            Explanation::Given(_) | Explanation::Refit(_) => Vec::new(),
            Explanation::Value(value) => self.rivals_of_value(value),
            Explanation::ValueAndRefit(value) => {
                let base = &self.evaluator.base;
                self.rivals_among(
                    value,
                    base,
                    self.tried.values_refitted.iter().chain(self.singles()),
                )
            }
            Explanation::Effects(best) => self.rivals_of_set(best),
        }
    }

    /// Other values, and single effects unless the value is one that would be refitted anyway.
    fn rivals_of_value(&self, value: &Hypothesis) -> Vec<&'a Hypothesis> {
        let (evaluator, given) = (self.evaluator, &self.evaluator.given);
        let refit_explains = !evaluator.clearly_worse(&evaluator.base, value, given);
        let effects = self.singles().filter(|_| !refit_explains);
        self.rivals_among(value, given, self.tried.values.iter().chain(effects))
    }

    fn singles(&self) -> impl Iterator<Item = &'a Hypothesis> + use<'a> {
        self.tried.hypotheses.iter().filter(|h| h.set.len() == 1)
    }

    fn rivals_among(
        &self,
        value: &Hypothesis,
        reference: &Hypothesis,
        others: impl Iterator<Item = &'a Hypothesis>,
    ) -> Vec<&'a Hypothesis> {
        others
            .filter(|h| h.values != value.values)
            .filter(|h| self.evaluator.improves(reference, h))
            .filter(|h| !self.evaluator.clearly_worse(h, value, reference))
            .collect()
    }

    /// Sets with no more values.
    fn rivals_of_set(&self, best: &Hypothesis) -> Vec<&'a Hypothesis> {
        let (evaluator, base) = (self.evaluator, &self.evaluator.base);
        let others = self.tried.hypotheses.iter().filter(|h| !h.adds(&best.set));
        others
            .filter(|h| h.added_values() <= best.added_values())
            .filter(|h| evaluator.improves(base, h))
            .filter(|h| !evaluator.clearly_worse(h, best, base))
            .collect()
    }

    /// Whether the best explanation needs other values in every motion.
    pub fn values_vary(&self) -> bool {
        self.signs(false).values_vary()
    }

    /// Whether chance alone gains a fair part of what the best set gains, counted in factors of the
    /// error.
    pub fn placebo_ranks(&self) -> bool {
        let base = &self.evaluator.base;
        let gain = |t: &Hypothesis| (base.deciding_mean() / t.deciding_mean()).ln();
        self.placebos.iter().any(|placebo| {
            self.evaluator.improves(base, placebo) && gain(placebo) > 0.5 * gain(self.chosen())
        })
    }

    pub fn verdict(&self, rivals: &[&Hypothesis]) -> Verdict {
        self.signs(self.is_open(rivals)).verdict()
    }

    /// What the explanation improves on: the model as given, or the refitted one.
    pub fn reference(&self) -> &'a Hypothesis {
        match self.explanation {
            Explanation::Given(given) => given,
            Explanation::Value(_) | Explanation::Refit(_) => &self.evaluator.given,
            Explanation::ValueAndRefit(_) | Explanation::Effects(_) => &self.evaluator.base,
        }
    }

    fn signs(&self, rivals: bool) -> Signs {
        let (evaluator, explanation) = (self.evaluator, self.explanation);
        let chosen = explanation.hypothesis();
        let structure = self.residual_structure.as_ref();
        let tolerance = evaluator.tolerance_rad.unwrap_or(0.0);
        let kind = match explanation {
            Explanation::Given(_) => Kind::Given,
            Explanation::Effects(_) => Kind::Effects,
            _ => Kind::Values,
        };
        Signs {
            kind,
            before: self.reference().deciding_mean(),
            left: chosen.deciding_mean(),
            worst_motion: chosen.evaluation.as_ref().map_or(f64::INFINITY, |e| {
                let motions = [Some(&e.training), e.held_out.as_ref()]
                    .into_iter()
                    .flatten();
                motions.map(BlockErrors::worst_motion).fold(0.0, f64::max)
            }),
            at_noise_floor: evaluator.at_noise_floor(chosen),
            held_out: evaluator.held_out.is_some(),
            tolerated: chosen.deciding_rms_rad() <= tolerance,
            free_form_share: structure.map_or(0.0, |s| s.explainable_share),
            free_form_low: structure.map_or(0.0, |s| s.explainable_low),
            per_motion_reduction: self.per_motion_reduction.unwrap_or(0.0),
            worst_fold: most_raised(&self.folds),
            worst_fold_floors: most_left_rad(&self.folds) / evaluator.training.floor(),
            is_examined: self.left_out.is_empty(),
            is_provable: self.shows_alone.is_empty(),
            spans_bounds: kind == Kind::Effects && chosen.spans_bounds(&evaluator.training),
            placebo_ranks: kind == Kind::Effects && self.placebo_ranks(),
            rivals,
        }
    }
}

#[cfg(test)]
mod tests;
