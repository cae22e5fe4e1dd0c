//! What may be claimed.

use super::evaluator::Evaluator;
use super::findings::{ResidualStructure, Verdict};
use super::hypothesis::Hypothesis;

/// Everything the verdict rests on.
pub(super) struct Evidence<'a> {
    pub evaluator: &'a Evaluator<'a>,
    /// Every set that was tried.
    pub hypotheses: Vec<Hypothesis>,
    /// Every single value of the given model that was refitted.
    pub values: Vec<Hypothesis>,
    /// The same along with the free values, for values that are not free.
    pub values_refitted: Vec<Hypothesis>,
    /// The smallest set that improves.
    pub best: Option<Hypothesis>,
    pub residual_structure: Option<ResidualStructure>,
    /// Share of what is left that goes when every motion has values of its own.
    pub per_motion_reduction: Option<f64>,
    pub seed: u64,
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

/// Share of what is left that a free form must significantly gain before the explanation counts as
/// incomplete.
const UNEXPLAINED_LOW: f64 = 0.2;
/// The same for the estimate itself.
const UNEXPLAINED_SHARE: f64 = 0.35;
/// An explanation that leaves more than this share of the squared error above the noise is not the
/// whole of it.
const MOST_LEFT: f64 = 0.125;
/// Where more than this share of what is left goes as every motion gets values of its own, they are
/// no constants.
const MOST_VARYING: f64 = 0.5;
/// A model that leaves more than so many floors is not nominal.
const MOST_NOMINAL: f64 = 1.5;
/// Mean squared weighted error from which the noise no longer excuses it.
const FAR_OFF: f64 = 2.0;

impl Evidence<'_> {
    /// The simplest explanation that is not clearly worse than the best.
    pub fn explanation(&self) -> Explanation<'_> {
        let (evaluator, given) = (self.evaluator, &self.evaluator.given);
        let base = &evaluator.base;
        let champion = match &self.best {
            Some(best) => Explanation::Effects(best),
            None if evaluator.improves(given, base) => Explanation::Refit(base),
            None => Explanation::Given(given),
        };
        let best = champion.hypothesis();
        if let Some(value) = evaluator.accepted(given, &self.values)
            && !evaluator.clearly_worse(value, best, given)
        {
            return Explanation::Value(value);
        }
        match evaluator.accepted(base, &self.values_refitted) {
            Some(value) if !evaluator.clearly_worse(value, best, base) => {
                Explanation::ValueAndRefit(value)
            }
            _ => champion,
        }
    }

    pub fn chosen(&self) -> &Hypothesis {
        self.explanation().hypothesis()
    }

    /// Explanations no less simple than the chosen one that the data do not tell from it.
    pub fn rivals(&self) -> Vec<&Hypothesis> {
        match self.explanation() {
            Explanation::Given(_) | Explanation::Refit(_) => Vec::new(),
            Explanation::Value(value) => self.rivals_of_value(value),
            Explanation::ValueAndRefit(value) => {
                let base = &self.evaluator.base;
                self.rivals_among(
                    value,
                    base,
                    self.values_refitted.iter().chain(self.singles()),
                )
            }
            Explanation::Effects(best) => self.rivals_of_set(best),
        }
    }

    /// Other values, and single effects unless the value is one that would be refitted anyway.
    fn rivals_of_value(&self, value: &Hypothesis) -> Vec<&Hypothesis> {
        let (evaluator, given) = (self.evaluator, &self.evaluator.given);
        let refit_explains = !evaluator.clearly_worse(&evaluator.base, value, given);
        let effects = self.singles().filter(|_| !refit_explains);
        self.rivals_among(value, given, self.values.iter().chain(effects))
    }

    fn singles(&self) -> impl Iterator<Item = &Hypothesis> {
        self.hypotheses.iter().filter(|h| h.set.len() == 1)
    }

    fn rivals_among<'a>(
        &self,
        value: &Hypothesis,
        reference: &Hypothesis,
        others: impl Iterator<Item = &'a Hypothesis>,
    ) -> Vec<&'a Hypothesis> {
        others
            .filter(|h| h.value != value.value)
            .filter(|h| self.evaluator.improves(reference, h))
            .filter(|h| !self.evaluator.clearly_worse(h, value, reference))
            .collect()
    }

    /// Sets with no more values.
    fn rivals_of_set(&self, best: &Hypothesis) -> Vec<&Hypothesis> {
        let (evaluator, base) = (self.evaluator, &self.evaluator.base);
        let others = self.hypotheses.iter().filter(|h| !h.adds(&best.set));
        others
            .filter(|h| h.added_values() <= best.added_values())
            .filter(|h| evaluator.improves(base, h))
            .filter(|h| !evaluator.clearly_worse(h, best, base))
            .collect()
    }

    /// Whether what remains is more than may be passed over.
    fn incomplete(&self) -> bool {
        let chosen = self.chosen();
        if self.evaluator.at_noise_floor(chosen) {
            return false;
        }
        if self.evaluator.held_out.is_none() {
            let given = matches!(self.explanation(), Explanation::Given(_));
            return given && self.leaves_much();
        }
        // Far above the noise, structure needs less proof.
        let least = match self.is_far_off(chosen) {
            true => 0.0,
            false => UNEXPLAINED_LOW,
        };
        let structured = self
            .residual_structure
            .as_ref()
            .is_some_and(|r| r.explainable_low > least && r.explainable_share > UNEXPLAINED_SHARE);
        structured || self.leaves_much() || self.values_vary()
    }

    /// Whether the best explanation needs other values in every motion.
    pub fn values_vary(&self) -> bool {
        let share = self.per_motion_reduction.unwrap_or(0.0);
        !matches!(self.explanation(), Explanation::Given(_)) && share > MOST_VARYING
    }

    /// Whether the best explanation leaves a good part of the squared error above the noise, or the
    /// model as given, with no explanation found, more than noise.
    fn leaves_much(&self) -> bool {
        let left = self.chosen().deciding_mean();
        let before = match self.explanation() {
            Explanation::Effects(_) | Explanation::ValueAndRefit(_) => {
                self.evaluator.base.deciding_mean()
            }
            Explanation::Value(_) | Explanation::Refit(_) => self.evaluator.given.deciding_mean(),
            Explanation::Given(_) => return left.sqrt() > MOST_NOMINAL,
        };
        left > FAR_OFF && left - 1.0 > MOST_LEFT * (before - 1.0)
    }

    /// Whether a hypothesis leaves a multiple of the noise that no noise explains.
    fn is_far_off(&self, hypothesis: &Hypothesis) -> bool {
        hypothesis.deciding_mean().sqrt() > FAR_OFF * FAR_OFF
    }

    /// Whether chance alone gains a fair part of what the best set gains, counted in factors of the
    /// error.
    pub fn placebo_ranks(&self) -> bool {
        let base = &self.evaluator.base;
        let gain = |t: &Hypothesis| (base.deciding_mean() / t.deciding_mean()).ln();
        self.evaluator.placebos.iter().any(|placebo| {
            self.evaluator.improves(base, placebo) && gain(placebo) > 0.5 * gain(self.chosen())
        })
    }

    pub fn verdict(&self, rivals: &[&Hypothesis]) -> Verdict {
        let explanation = self.explanation();
        if matches!(explanation, Explanation::Given(_)) && self.is_tolerated() {
            return Verdict::Adequate;
        }
        if self.incomplete() {
            return Verdict::Unexplained;
        }
        match explanation {
            Explanation::Given(_) => Verdict::Nominal,
            Explanation::Refit(_) => Verdict::WrongValue,
            Explanation::Value(_) | Explanation::ValueAndRefit(_) if rivals.is_empty() => {
                Verdict::WrongValue
            }
            Explanation::Effects(_) if self.placebo_ranks() => Verdict::Unexplained,
            Explanation::Effects(_) if rivals.is_empty() => Verdict::Named,
            _ => Verdict::Ambiguous,
        }
    }

    /// Whether the model as given leaves more than noise, but no more than the user tolerates.
    fn is_tolerated(&self) -> bool {
        let given = &self.evaluator.given;
        let tolerance = self.evaluator.tolerance_rad;
        !self.evaluator.at_noise_floor(given)
            && tolerance.is_some_and(|tolerance| given.deciding_rms_rad() <= tolerance)
    }
}
