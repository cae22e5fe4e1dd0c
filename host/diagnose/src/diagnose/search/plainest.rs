//! Plainer laws in place of those whose values the motions do not determine.

use super::super::budget::{FINISH, LOOK};
use super::super::evaluator::Evaluator;
use super::super::hypothesis::Hypothesis;
use super::super::strategy::Strategy;
use super::leader;
use super::results::put_among;
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

    /// Puts beside the leader of a size, where a law of it rests on a bound, the sets with a
    /// plainer one in its place that begin with its values: what is there may be what that law
    /// comes to on its bound, and no short fit find it from elsewhere.
    pub(super) fn put_plainer(&self, of_size: &mut Vec<Hypothesis>) {
        let Some(whole) = leader(of_size).filter(|_| self.does(Strategy::PlainestLaw)) else {
            return;
        };
        let on_bound = whole.effects_on_bound().into_par_iter();
        let mut found: Vec<Hypothesis> = on_bound
            .flat_map_iter(|leaving| self.with_its_values(whole, leaving))
            .collect();
        self.finish_found(&mut found);
        put_among(of_size, found);
    }

    /// The set with one effect replaced by each that needs no other values than some of its own.
    fn with_its_values(&self, whole: &Hypothesis, leaving: usize) -> Vec<Hypothesis> {
        let out = whole.set[leaving];
        let values = whole.added_effect(leaving).values.clone();
        let rest = whole.without(leaving, &self.base, &self.search, 0);
        let plainer = self.candidates.iter().filter_map(|candidate| {
            let is_one = candidate.joint == out.joint && self.is_new(&rest, *candidate, &[]);
            let values = values_of(*candidate, out, &values).filter(|_| is_one)?;
            Some(rest.with(*candidate, &values, &self.search, FitOptions::iterations(0)))
        });
        plainer.collect()
    }

    /// Fits sets to the end, and evaluates them.
    fn finish_found(&self, sets: &mut [Hypothesis]) {
        sets.par_iter_mut().for_each(|set| {
            set.resume(&self.search, FitOptions::iterations(FINISH));
            self.evaluate_found(set);
        });
    }

    /// The best set with one plainer law that does as well.
    fn plainer_law(&self, whole: &Hypothesis) -> Option<Hypothesis> {
        let vague = vague_effects(whole, &self.training);
        let mut found: Vec<Hypothesis> = vague
            .into_par_iter()
            .flat_map_iter(|leaving| self.with_plainer(whole, leaving))
            .collect();
        self.finish_found(&mut found);
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

/// Values of a plainer effect among another's, by their keys; `None` where it needs others, or as
/// many.
fn values_of(plainer: Candidate, than: Candidate, values: &[f64]) -> Option<Vec<f64>> {
    let known = than.parameters();
    let own = plainer.parameters().iter().map(|own| {
        let place = known
            .iter()
            .position(|parameter| parameter.key == own.key)?;
        Some(values[place])
    });
    let own = own.collect::<Option<Vec<f64>>>()?;
    (!own.is_empty() && own.len() < known.len()).then_some(own)
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
