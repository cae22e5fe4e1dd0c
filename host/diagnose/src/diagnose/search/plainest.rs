//! Plainer laws in place of those whose values the motions do not determine.

use super::super::budget::{FINISH, LOOK};
use super::super::evaluator::Evaluator;
use super::super::hypothesis::Hypothesis;
use super::super::strategy::Strategy;
use crate::fitting::{
    Candidate, FitOptions, FitProblem, ProjectedResidual, changes_like, intervals,
};
use rayon::prelude::*;

impl Evaluator<'_> {
    /// The set with each law whose values these motions do not determine replaced by a plainer one
    /// of its kind that does as well: a spring so soft that it pulls alike everywhere is a constant
    /// force.
    pub(super) fn plainest(&self, mut whole: Hypothesis) -> Hypothesis {
        if self.does(Strategy::PlainestLaw) {
            while let Some(plainer) = self.plainer_law(&whole) {
                whole = plainer;
            }
        }
        whole
    }

    /// The best set with one plainer law that does as well.
    fn plainer_law(&self, whole: &Hypothesis) -> Option<Hypothesis> {
        let vague = vague_effects(whole, &self.training);
        let mut found: Vec<Hypothesis> = vague
            .into_par_iter()
            .flat_map_iter(|leaving| self.with_plainer(whole, leaving))
            .collect();
        found.par_iter_mut().for_each(|set| {
            set.resume(&self.search, FitOptions::iterations(FINISH));
            self.evaluate_found(set);
        });
        found.retain(|set| {
            self.improves(&self.base, set) && !self.clearly_worse(set, whole, &self.base)
        });
        found.into_iter().min_by(Hypothesis::by_error)
    }

    /// A short look at the set with one effect replaced by each plainer one that acts there.
    fn with_plainer(&self, whole: &Hypothesis, leaving: usize) -> Vec<Hypothesis> {
        let out = whole.set[leaving];
        let rest = whole.without(leaving, &self.base, &self.search, LOOK);
        let firsts = self.changes.iter().filter_map(|changes| changes.first());
        let plainer = firsts.filter(|change| {
            is_plainer(change.candidate, out) && self.is_new(&rest, change.candidate, &[])
        });
        let residual = ProjectedResidual::new(&rest.search);
        let looked = plainer.filter_map(|like| {
            let changes = changes_like(&rest.search, like, &self.search);
            let guess = residual.guesses(&changes).into_iter().next()?;
            Some(self.look(&rest, &guess))
        });
        looked.collect()
    }
}

/// Whether a candidate acts where another does, with fewer values.
fn is_plainer(candidate: Candidate, than: Candidate) -> bool {
    let site = |candidate: Candidate| candidate.effect.info().site;
    candidate.joint == than.joint
        && site(candidate) == site(than)
        && candidate.parameters().len() < than.parameters().len()
}

/// The places in a set of effects of several values of which one is not determined: its interval
/// holds where the effect vanishes, or reaches from bound to bound.
fn vague_effects(whole: &Hypothesis, training: &FitProblem) -> Vec<usize> {
    let Some((intervals, _)) = intervals(whole.fit(), training) else {
        return Vec::new();
    };
    let mut first = intervals.len() - whole.added_values();
    let is_vague = |effect: &Candidate| {
        let parameters = effect.parameters();
        let own = &intervals[first..first + parameters.len()];
        first += parameters.len();
        let mut values = parameters.iter().zip(own);
        let is_vague = values.any(|(parameter, interval)| {
            let holds = |value: f64| interval.low <= value && value <= interval.high;
            let (low, high) = parameter.bounds;
            parameter.off.is_some_and(holds) || holds(low) && holds(high)
        });
        is_vague && parameters.len() > 1
    };
    let vague: Vec<bool> = whole.set.iter().map(is_vague).collect();
    (0..vague.len()).filter(|place| vague[*place]).collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::{evaluator, fitted};
    use super::Strategy;

    /// The arm hangs a constant torque off; a soft spring about a far angle does the same.
    #[test]
    fn a_spring_that_pulls_alike_everywhere_is_a_constant_torque() {
        let mut evaluator = evaluator(1, &["torque_offset"]);
        let mut spring = fitted(&evaluator, &["cable_spring"], [&[0.001, 60.0]]);
        evaluator.evaluate(&mut spring);
        let plainest = evaluator.plainest(spring.clone());
        assert_eq!(plainest.names(), ["torque_offset@1"]);
        evaluator.skipped = vec![Strategy::PlainestLaw];
        assert_eq!(evaluator.plainest(spring).names(), ["cable_spring@1"]);
    }

    /// What a spring that is there does no constant torque does.
    #[test]
    fn a_spring_that_is_there_stays() {
        let evaluator = evaluator(1, &["cable_spring"]);
        let mut spring = fitted(&evaluator, &["cable_spring"], [&[0.1, 0.2]]);
        evaluator.evaluate(&mut spring);
        assert_eq!(evaluator.plainest(spring).names(), ["cable_spring@1"]);
    }
}
