//! Fits of candidates whose law jumps from other starts: there false valleys are many.

use super::budget::{FAR_BEHIND, FINALISTS, FINISH, RESTART_LOOK, RESTARTS};
use super::evaluator::Evaluator;
use super::hypothesis::Hypothesis;
use super::strategy::Strategy;
use crate::fitting::{FitOptions, fit};
use rayon::prelude::*;

impl Evaluator<'_> {
    /// Whether one of many candidates leaves so much less than the base model that it is taken to
    /// be in no false valley. Of few each is fitted from other starts nevertheless.
    pub fn is_led(&self, sorted: &[Hypothesis]) -> bool {
        let is_ahead =
            |leader: &Hypothesis| FAR_BEHIND * leader.search_mean < self.base.search_mean;
        self.has_many_candidates() && sorted.first().is_some_and(is_ahead)
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
        let candidate = hypothesis.set[0];
        let starts = candidate.starts().into_par_iter();
        let looks = starts.map(|start| {
            let mut model = self.start.clone();
            model.effects.push(candidate.instance(&start));
            let options = FitOptions::iterations(RESTART_LOOK).rough();
            let found = fit(&model, &hypothesis.search.free, &self.search, None, options);
            Hypothesis::new(vec![candidate], found)
        });
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
