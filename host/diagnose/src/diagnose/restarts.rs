//! Fits of candidates from other starts, where false valleys are many: few samples, or a law that
//! jumps.

use super::budget::{FAR_BEHIND, FINALISTS, FINISH, RESTART_LOOK, RESTARTS, START_ITERATIONS};
use super::evaluator::Evaluator;
use super::hypothesis::Hypothesis;
use super::multistart::{Valleys, scattered};
use super::strategy::Strategy;
use crate::fitting::{Candidate, Fit, FitOptions, InitialGuess, fit, fit_through_stages};
use crate::model::{Model, ParameterPath};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

impl Evaluator<'_> {
    /// Fits from random values around the model's own and the guess's.
    pub fn random_starts(&self, from: &Hypothesis, guess: &InitialGuess) -> Vec<Hypothesis> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let mut start = self.start.clone();
        for candidate in &from.set {
            let known = from.search.model.effects.iter();
            let same = known.filter(|&effect| Candidate::from(effect) == *candidate);
            start.effects.extend(same.cloned());
        }
        start.effects.push(guess.candidate.instance(&guess.values));
        let mut free = from.search.free.clone();
        free.extend(guess.candidate.paths());
        let mut valleys = Valleys::of_samples(self.search.samples());
        let mut fits = Vec::new();
        while !valleys.are_found() {
            let model = scattered(&start, &free, &mut random);
            let options = FitOptions::iterations(START_ITERATIONS);
            let found = fit(&model, &free, &self.search, None, options);
            let found = Hypothesis::new(from.set_with(guess.candidate), found);
            valleys.note(found.search_mean);
            fits.push(found);
        }
        fits
    }

    /// Whether one of many candidates leaves so much less than the base model that it is taken to
    /// be in no false valley. Of few each is fitted from other starts nevertheless.
    pub fn is_led(&self, sorted: &[Hypothesis]) -> bool {
        let is_ahead =
            |leader: &Hypothesis| FAR_BEHIND * leader.search_mean < self.base.search_mean;
        self.has_many_candidates() && sorted.first().is_some_and(is_ahead)
    }

    /// Fits candidates whose law jumps from the values the model came with, and from each of the
    /// effect's start values: what is missing has bent the base values, and a fit that starts from
    /// them may end in a false valley. Of many candidates the best few, since every joint has laws
    /// that jump.
    pub fn restart_jumping(&self, sorted: &mut [Hypothesis]) {
        let most = if self.has_many_candidates() {
            FINALISTS
        } else {
            usize::MAX
        };
        let does = self.does(Strategy::Restarts);
        let jumping = sorted.iter_mut().filter(|h| does && self.jumps_alone(h));
        let jumping: Vec<&mut Hypothesis> = jumping.take(most).collect();
        jumping.into_par_iter().for_each(|hypothesis| {
            self.restart(hypothesis, |model, free, options| {
                fit(model, free, &self.search, None, options)
            });
        });
    }

    /// The same for the one that leads, from shorter windows to longer ones: where even the windows
    /// of the search have false valleys.
    pub fn restage_leader(&self, sorted: &mut [Hypothesis]) {
        let does = self.does(Strategy::RestagedLeader);
        let leader = sorted.first_mut().filter(|_| does);
        if let Some(leader) = leader.filter(|h| self.jumps_alone(h)) {
            self.restart(leader, |model, free, options| {
                fit_through_stages(model, free, &self.search, options)
            });
        }
    }

    /// A fit of the candidate from each of its start values gets a look; the best go on to the end,
    /// and take its place if one is better.
    fn restart(
        &self,
        hypothesis: &mut Hypothesis,
        fitted: impl Fn(&Model, &[ParameterPath], FitOptions) -> Fit + Sync,
    ) {
        let candidate = hypothesis.set[0];
        let starts = candidate.starts().into_par_iter();
        let looks = starts.map(|start| {
            let mut model = self.start.clone();
            model.effects.push(candidate.instance(&start));
            let options = FitOptions::iterations(RESTART_LOOK).rough();
            let found = fitted(&model, &hypothesis.search.free, options);
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
