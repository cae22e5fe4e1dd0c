//! What may be claimed.

use super::evaluator::Evaluator;
use super::findings::{ResidualStructure, Verdict};
use super::hypothesis::Hypothesis;

/// Everything the verdict rests on.
pub(super) struct Evidence<'a> {
    pub evaluator: &'a Evaluator<'a>,
    /// Every set that was tried.
    pub hypotheses: Vec<Hypothesis>,
    /// The smallest set that improves.
    pub best: Option<Hypothesis>,
    pub residual_structure: Option<ResidualStructure>,
    /// Share of what is left that goes when every motion has values of its own.
    pub per_motion_reduction: Option<f64>,
    pub seed: u64,
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
/// Mean squared weighted error from which the noise no longer excuses it.
const FAR_OFF: f64 = 2.0;

impl Evidence<'_> {
    pub fn chosen(&self) -> &Hypothesis {
        self.best.as_ref().unwrap_or(&self.evaluator.base)
    }

    /// Sets with no more values that the data do not tell from the best.
    pub fn rivals(&self) -> Vec<&Hypothesis> {
        let Some(best) = &self.best else {
            return Vec::new();
        };
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
        if self.evaluator.at_noise_floor(chosen) || self.evaluator.held_out.is_none() {
            return false;
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
        self.best.is_some() && share > MOST_VARYING
    }

    /// Whether the best explanation leaves a good part of the squared error above the noise, or the
    /// base model, with no explanation found, is far off.
    fn leaves_much(&self) -> bool {
        let left = self.chosen().deciding_mean();
        let before = self.evaluator.base.deciding_mean();
        if self.best.is_some() {
            left > FAR_OFF && left - 1.0 > MOST_LEFT * (before - 1.0)
        } else {
            self.is_far_off(self.chosen())
        }
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
        match &self.best {
            _ if self.incomplete() => Verdict::Unexplained,
            None => Verdict::Nominal,
            Some(_) if self.placebo_ranks() => Verdict::Unexplained,
            Some(_) if !rivals.is_empty() => Verdict::Ambiguous,
            Some(_) => Verdict::Named,
        }
    }
}
