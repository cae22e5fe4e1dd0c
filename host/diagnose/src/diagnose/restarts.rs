//! Fits of candidates from other starts, where false valleys are many: laws that jump, and files of
//! which free values stand in for what is missing.

use super::budget::{FAR_BEHIND, FINALISTS, FINISH, LOOK, RESTART_LOOK, RESTARTS};
use super::evaluator::Evaluator;
use super::hypothesis::Hypothesis;
use super::strategy::Strategy;
use crate::fitting::{Fit, FitOptions, fit};
use rayon::prelude::*;

/// A free value so many standard uncertainties from the file's is bent.
const BENT: f64 = 2.0;

impl Evaluator<'_> {
    /// Whether one of many candidates leaves so much less than the base model that it is taken to
    /// be in no false valley. Of few each is fitted from other starts nevertheless.
    pub fn is_led(&self, sorted: &[Hypothesis]) -> bool {
        let is_ahead =
            |leader: &Hypothesis| FAR_BEHIND * leader.search_mean < self.base.search_mean;
        self.has_many_candidates() && sorted.first().is_some_and(is_ahead)
    }

    /// Whether refitting moved a free value of the model farther than what is known of it lets one
    /// expect: it may stand in for what is missing.
    pub(super) fn is_bent(&self) -> bool {
        let Fit { free, model, .. } = &self.base.search;
        let mut free = free.iter();
        free.any(|path| {
            let value = path.get(model);
            value.is_some_and(|value| self.start.deviation(*path, value) > BENT)
        })
    }

    /// Where a free value is bent, a look at every candidate from the values of the file; those
    /// that leave less than from the refitted ones go on, and take their place.
    pub fn restart_bent(&self, hypotheses: &mut Vec<Hypothesis>) {
        let is_affordable = !self.has_many_candidates();
        if !is_affordable || !self.does(Strategy::Restarts) || !self.is_bent() {
            return;
        }
        let looks = hypotheses.par_iter().filter_map(|known| {
            let look = self.look_from_file(known)?;
            (look.search_mean < known.search_mean).then_some(look)
        });
        let looks: Vec<Hypothesis> = looks.collect();
        for found in self.successive_halving(looks) {
            let known = hypotheses.iter_mut().find(|known| known.adds(&found.set));
            if let Some(known) = known {
                known.improve(vec![found]);
            }
        }
        hypotheses.sort_by(Hypothesis::by_error);
    }

    /// A short fit of one effect from the values of the file, and from the start values that leave
    /// least there.
    fn look_from_file(&self, known: &Hypothesis) -> Option<Hypothesis> {
        let starts = known.set[0].starts().into_par_iter();
        let firsts =
            starts.map(|start| self.fitted_from_file(known, &start, FitOptions::iterations(0)));
        let mut best = firsts.min_by(Hypothesis::by_error)?;
        best.resume(&self.search, FitOptions::iterations(LOOK).rough());
        Some(best)
    }

    /// A fit of one effect from a start of it and the values of the file.
    fn fitted_from_file(
        &self,
        known: &Hypothesis,
        start: &[f64],
        options: FitOptions,
    ) -> Hypothesis {
        let candidate = known.set[0];
        let mut model = self.start.clone();
        model.effects.push(candidate.instance(start));
        let found = fit(&model, &known.search.free, &self.search, None, options);
        Hypothesis::new(vec![candidate], found)
    }

    /// Fits the best candidates whose law jumps from the values the model came with, and from each
    /// of the effect's start values: what is missing has bent the base values, and a fit from them
    /// may end in a false valley.
    pub fn restart_jumping(&self, sorted: &mut [Hypothesis]) {
        let does = self.does(Strategy::Restarts);
        let jumping = sorted.iter_mut().filter(|h| does && self.jumps_alone(h));
        let jumping: Vec<&mut Hypothesis> = jumping.take(FINALISTS).collect();
        (jumping.into_par_iter()).for_each(|hypothesis| self.restart(hypothesis));
    }

    /// A fit of the candidate from each of its start values gets a look; the best go on to the end,
    /// and take its place if one is better.
    fn restart(&self, hypothesis: &mut Hypothesis) {
        let starts = hypothesis.set[0].starts().into_par_iter();
        let options = FitOptions::iterations(RESTART_LOOK).rough();
        let looks = starts.map(|start| self.fitted_from_file(hypothesis, &start, options));
        let mut looks: Vec<Hypothesis> = looks.collect();
        looks.sort_by(Hypothesis::by_error);
        looks.truncate(RESTARTS);
        let finish = FitOptions::iterations(FINISH - RESTART_LOOK);
        (looks.par_iter_mut()).for_each(|look| look.resume(&self.search, finish));
        hypothesis.improve(looks);
    }

    /// Whether this is one effect alone, whose law jumps.
    fn jumps_alone(&self, hypothesis: &Hypothesis) -> bool {
        matches!(hypothesis.set[..], [effect] if effect.jumps(&self.start))
    }
}
