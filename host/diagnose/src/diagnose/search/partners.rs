//! Partners of a set: which candidates promise most on top of it.

use super::super::budget::{PARTNERS, SIMULATED};
use super::super::evaluator::Evaluator;
use super::super::hypothesis::Hypothesis;
use crate::fitting::{Candidate, InitialGuess, PredictionChange, ProjectedResidual, changes_like};
use rayon::prelude::*;

impl Evaluator<'_> {
    /// The most promising guesses on top of a hypothesis that make a set not yet tried.
    ///
    /// They are chosen by what they change in the prediction with the set: without it a model may
    /// move so differently that they change another motion. Of many candidates only those are
    /// simulated on top of it that promise something in the base model's prediction.
    pub(super) fn partners(&self, from: &Hypothesis, tried: &[Hypothesis]) -> Vec<InitialGuess> {
        let residual = ProjectedResidual::new(&from.search);
        let is_new = |changes: &&Vec<PredictionChange>| {
            let change = changes.first();
            change.is_some_and(|change| self.is_new(from, change.candidate, tried))
        };
        let new = self.changes.par_iter().filter(is_new);
        let gains = new.filter_map(|changes| {
            let gains = changes.iter().map(|c| (c, residual.guess(c).gain));
            gains.max_by(|a, b| a.1.total_cmp(&b.1))
        });
        let mut promising: Vec<(&PredictionChange, f64)> = gains.collect();
        promising.sort_by(|a, b| b.1.total_cmp(&a.1));
        promising.truncate(SIMULATED);
        let simulated = promising.par_iter().filter_map(|(like, _)| {
            let changes = changes_like(&from.search, like, &self.search);
            residual.guesses(&changes).into_iter().next()
        });
        let mut guesses: Vec<InitialGuess> = simulated.collect();
        guesses.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        guesses.truncate(PARTNERS);
        guesses
    }

    /// Whether a candidate makes a set on top of a hypothesis that was not tried yet.
    pub(super) fn is_new(
        &self,
        from: &Hypothesis,
        candidate: Candidate,
        tried: &[Hypothesis],
    ) -> bool {
        let set = from.set_with(candidate);
        let mut kept = from.set.iter();
        kept.all(|kept| !kept.overlaps(candidate, &self.start))
            && !tried.iter().any(|t| t.adds(&set))
    }
}
