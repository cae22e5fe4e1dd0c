//! Partners of a set: which candidates promise most on top of it, and in place of its members.

use super::super::budget::{FINISH, LOOK, PARTNERS};
use super::super::evaluator::Evaluator;
use super::super::hypothesis::Hypothesis;
use super::super::strategy::Strategy;
use crate::fitting::{Candidate, InitialGuess, PredictionChange, ProjectedResidual, changes_like};
use rayon::prelude::*;

impl Evaluator<'_> {
    /// The most promising guesses on top of a hypothesis that make a set not yet tried.
    ///
    /// Which candidates promise most shows in what they change in the base model's prediction; only
    /// those are simulated on top of the hypothesis.
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
        promising.truncate(2 * PARTNERS);
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

    /// The set with each of its effects replaced by plainer ones of its kind, where a value rests
    /// on a bound: there a law is often another's, as Stribeck friction at the lowest speed is
    /// Coulomb friction.
    fn plainer(&self, whole: &Hypothesis, tried: &[Hypothesis]) -> Vec<Hypothesis> {
        if !whole.rests_on_bound() || !self.does(Strategy::PlainerPartners) {
            return Vec::new();
        }
        let leaving = (0..whole.set.len()).into_par_iter();
        let found = leaving.flat_map_iter(|leaving| self.with_plainer(whole, leaving, tried));
        found.collect()
    }

    /// The set with an effect that it has at every joint taken for the same at all of them,
    /// refitted from the values it has: alike joints need no values of their own.
    pub(super) fn merged(&self, whole: &Hypothesis) -> Vec<Hypothesis> {
        let at_all = self.candidates.iter().filter(|all| all.joint.is_none());
        let at_all = at_all.filter(|_| self.does(Strategy::Merging));
        let merged = at_all.filter_map(|all| {
            let at = |joint| Candidate {
                joint: Some(joint),
                ..*all
            };
            let joints = (0..self.start.link_count()).map(at);
            let each: Vec<Candidate> = joints.filter(|at| all.overlaps(*at, &self.start)).collect();
            let is_had = each.iter().all(|at| whole.set.contains(at));
            (each.len() > 1 && is_had)
                .then(|| whole.merging(&each, *all, &self.base, &self.search, FINISH))
        });
        let mut merged: Vec<Hypothesis> = merged.collect();
        for hypothesis in &mut merged {
            self.evaluate_found(hypothesis);
        }
        merged
    }

    /// Tries to replace each older member of the best set, which may no longer be needed, and any
    /// that a plainer one may stand for.
    pub(super) fn swapped(&self, mut hypotheses: Vec<Hypothesis>) -> Vec<Hypothesis> {
        let Some(best) = hypotheses.first().cloned() else {
            return hypotheses;
        };
        let older = best.set.len().saturating_sub(1);
        for leaving in (0..older).filter(|_| self.does(Strategy::Swaps)) {
            let rest = best.without(leaving, &self.base, &self.search, LOOK);
            let mut partners = self.partners(&rest, &hypotheses);
            partners.truncate(2);
            let found = partners.par_iter().map(|guess| self.look(&rest, guess));
            let found: Vec<Hypothesis> = found.collect();
            hypotheses.extend(found);
        }
        let plainer = self.plainer(&best, &hypotheses);
        hypotheses.extend(plainer);
        self.evaluated(self.successive_halving(hypotheses))
    }
}
