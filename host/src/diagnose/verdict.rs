//! What may be claimed.

use super::bench::Bench;
use super::findings::{Remainder, Verdict};
use super::trial::Trial;

/// Everything the verdict rests on.
pub(super) struct Case<'a> {
    pub bench: &'a Bench<'a>,
    /// Every set that was tried.
    pub trials: Vec<Trial>,
    /// The smallest set that pays.
    pub best: Option<Trial>,
    pub remainder: Option<Remainder>,
    /// Share of what is left that goes when every motion has values of its own.
    pub own_values_share: Option<f64>,
    pub seed: u64,
}

/// Share of what is left that a free form must surely gain before the explanation counts as incomplete.
const UNEXPLAINED_LOW: f64 = 0.2;
/// The same for the estimate itself.
const UNEXPLAINED_SHARE: f64 = 0.35;
/// An explanation that leaves more than this share of the squared error above the noise is not the whole of it.
const MOST_LEFT: f64 = 0.125;
/// Where more than this share of what is left goes as every motion gets values of its own, they are no constants.
const MOST_INCONSTANT: f64 = 0.5;
/// Mean squared weighted error from which the noise no longer excuses it.
const FAR_OFF: f64 = 2.0;

impl Case<'_> {
    pub fn chosen(&self) -> &Trial {
        self.best.as_ref().unwrap_or(&self.bench.base)
    }

    /// Sets with no more values that the data do not tell from the best.
    pub fn rivals(&self) -> Vec<&Trial> {
        let Some(best) = &self.best else {
            return Vec::new();
        };
        self.trials
            .iter()
            .filter(|t| !t.adds(&best.set) && t.added_values() <= best.added_values())
            .filter(|t| self.bench.pays(&self.bench.base, t))
            .filter(|t| !self.bench.clearly_worse(t, best, &self.bench.base))
            .collect()
    }

    /// Whether what remains is more than may be passed over.
    fn incomplete(&self) -> bool {
        let chosen = self.chosen();
        if self.bench.at_floor(chosen) || self.bench.held_out.is_none() {
            return false;
        }
        // Far above the noise, structure needs less proof.
        let surely = if self.is_far_off(chosen) {
            0.0
        } else {
            UNEXPLAINED_LOW
        };
        let structured = self
            .remainder
            .as_ref()
            .is_some_and(|r| r.explainable_low > surely && r.explainable_share > UNEXPLAINED_SHARE);
        structured || self.leaves_much() || self.inconstant()
    }

    /// Whether the best explanation needs other values in every motion.
    pub fn inconstant(&self) -> bool {
        let share = self.own_values_share.unwrap_or(0.0);
        self.best.is_some() && share > MOST_INCONSTANT
    }

    /// Whether the best explanation leaves a good part of the squared error above the noise, or the base model, with
    /// no explanation found, is far off.
    fn leaves_much(&self) -> bool {
        let left = self.chosen().deciding_mean();
        let before = self.bench.base.deciding_mean();
        if self.best.is_some() {
            left > FAR_OFF && left - 1.0 > MOST_LEFT * (before - 1.0)
        } else {
            self.is_far_off(self.chosen())
        }
    }

    /// Whether a trial leaves a multiple of the noise that no noise explains.
    fn is_far_off(&self, trial: &Trial) -> bool {
        trial.deciding_mean().sqrt() > FAR_OFF * FAR_OFF
    }

    /// Whether chance alone gains a fair part of what the best set gains, counted in factors of the error.
    pub fn sham_ranks(&self) -> bool {
        let base = &self.bench.base;
        let gain = |t: &Trial| (base.deciding_mean() / t.deciding_mean()).ln();
        self.bench
            .shams
            .iter()
            .any(|sham| self.bench.pays(base, sham) && gain(sham) > 0.5 * gain(self.chosen()))
    }

    pub fn verdict(&self, rivals: &[&Trial]) -> Verdict {
        match &self.best {
            _ if self.incomplete() => Verdict::Unexplained,
            None => Verdict::Nominal,
            Some(_) if self.sham_ranks() => Verdict::Unexplained,
            Some(_) if !rivals.is_empty() => Verdict::Ambiguous,
            Some(_) => Verdict::Named,
        }
    }
}
