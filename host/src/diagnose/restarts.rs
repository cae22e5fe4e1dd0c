//! Fits of candidates from other starts, where false valleys are many: few samples, or a law that
//! jumps.

use super::budget::{FINISH, START_ITERATIONS};
use super::evaluator::Evaluator;
use super::hypothesis::Hypothesis;
use super::initial_guess::InitialGuess;
use super::multistart::{Valleys, scattered};
use crate::fitting::{Candidate, FitOptions, fit, fit_staged};
use crate::model::Model;
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

    /// Fits candidates whose law jumps from the values the model came with, and from each of the
    /// effect's start values: what is missing has bent the base values, and a fit that starts from
    /// them may end in a false valley.
    pub fn restart_jumping(&self, hypotheses: &mut [Hypothesis]) {
        let alone = |h: &&mut Hypothesis| h.set.len() == 1 && h.set[0].jumps();
        let jumping: Vec<&mut Hypothesis> = hypotheses.iter_mut().filter(alone).collect();
        jumping.into_par_iter().for_each(|hypothesis| {
            let candidate = hypothesis.set[0];
            let found = candidate.starts().into_par_iter().map(|start| {
                let model = self.given_with(candidate, &start);
                let (free, options) = (&hypothesis.search.free, FitOptions::iterations(FINISH));
                let found = fit(&model, free, &self.search, None, options);
                Hypothesis::new(vec![candidate], found)
            });
            hypothesis.improve(found.collect());
        });
    }

    /// The same for the one that leads, from shorter windows to longer ones: where even the windows
    /// of the search have false valleys.
    pub fn restage_leader(&self, hypotheses: &mut [Hypothesis]) {
        let leader = hypotheses.first_mut();
        let Some(leader) = leader.filter(|h| h.set.len() == 1 && h.set[0].jumps()) else {
            return;
        };
        let candidate = leader.set[0];
        let found = candidate.starts().into_par_iter().map(|start| {
            let model = self.given_with(candidate, &start);
            let found = fit_staged(&model, &leader.search.free, &self.search);
            Hypothesis::new(vec![candidate], found)
        });
        let found = found.collect();
        leader.improve(found);
    }

    /// The model as it came, with an effect at these values.
    fn given_with(&self, candidate: Candidate, values: &[f64]) -> Model {
        let mut model = self.start.clone();
        model.effects.push(candidate.instance(values));
        model
    }
}
