//! A first look at every candidate on top of a hypothesis.
//!
//! Those whose change of the prediction promises something, of few candidates all, get a glance, a
//! fit as far as derivatives known before lead; the best third, but the best few only where the
//! rest is hopeless beside the first, gets a look, for which derivatives are taken again.

use super::budget::{FINALISTS, FIRST_LOOK_STEPS, LOOK, MANY, SECOND_LOOKS};
use super::evaluator::{Evaluator, Reach};
use super::hypothesis::Hypothesis;
use super::strategy::Strategy;
use crate::fitting::{FitOptions, InitialGuess, PredictionChange, ProjectedResidual};
use crate::model::ParameterPath;
use rayon::prelude::*;

/// A guess that promises less than this share of what the candidate's best one does is not tried.
const WORTH: f64 = 0.05;

/// Of many candidates, those beyond the first few dozen that promise less than this share of what
/// the best one does are taken as their guess is, without a glance.
const ALWAYS_GLANCED: usize = 60;
const WORTH_A_GLANCE: f64 = 0.005;

/// More of one effect cannot leave more: where a glance ends this far above the squared error of
/// what it began from, its derivatives led astray, as where free values take the effect's place
/// until it is large, and it gets a look whatever it left.
const MISLED: f64 = 1.02;

/// A guess and the fit from it.
type Glance = (InitialGuess, Hypothesis);

/// The squared error up to which a candidate belongs to the best third, or to the best few.
pub(super) fn best_third(mut of_candidates: Vec<f64>) -> f64 {
    of_candidates.sort_by(f64::total_cmp);
    let looks = SECOND_LOOKS.max(of_candidates.len() / 3);
    of_candidates
        .get(looks - 1)
        .copied()
        .unwrap_or(f64::INFINITY)
}

/// The squared error up to which a candidate belongs to the best few.
fn best_few(mut of_candidates: Vec<f64>) -> f64 {
    of_candidates.sort_by(f64::total_cmp);
    let last = of_candidates[..of_candidates.len().min(FINALISTS)].last();
    last.copied().unwrap_or(f64::INFINITY)
}

/// What a candidate must promise for a glance, of what each promises: nothing where all are tried.
fn least_promise(mut promises: Vec<f64>, spares_none: bool) -> f64 {
    if spares_none || promises.len() <= MANY {
        return 0.0;
    }
    promises.sort_by(|a, b| b.total_cmp(a));
    (WORTH_A_GLANCE * promises[0]).min(promises[ALWAYS_GLANCED - 1])
}

/// The candidates' guesses that are worth a glance, and the others.
fn worth_a_glance(all: Vec<Vec<InitialGuess>>, spares_none: bool) -> [Vec<Vec<InitialGuess>>; 2] {
    let promise = |guesses: &[InitialGuess]| guesses.first().map_or(0.0, |guess| guess.gain);
    let promises = all.iter().map(|guesses| promise(guesses));
    let least = least_promise(promises.collect(), spares_none);
    let (worth, rest) = all
        .into_iter()
        .partition(|guesses| promise(guesses) >= least);
    [worth, rest]
}

impl Evaluator<'_> {
    /// Short fits of candidates on top of a hypothesis, each from its best initial guesses, at most
    /// `starts`; the better one counts. `changes` are those of each candidate.
    pub fn first_look(
        &self,
        from: &Hypothesis,
        changes: &[Vec<PredictionChange>],
        starts: usize,
    ) -> Vec<Hypothesis> {
        let residual = ProjectedResidual::new(&from.search);
        let guesses = changes.par_iter();
        let guesses = guesses.map(|changes| self.guesses(&residual, changes, starts));
        let guesses: Vec<Vec<InitialGuess>> = guesses.collect();
        let spares_none = self.reach == Reach::Everything || !from.set.is_empty();
        let [worth, rest] = worth_a_glance(guesses, spares_none);
        let glances = worth.into_par_iter().map(|guesses| {
            let glances = guesses.into_iter().map(|guess| {
                let glance = self.glance(from, &guess);
                (guess, glance)
            });
            let glances = glances.collect();
            self.course.step(1);
            glances
        });
        let glances: Vec<Vec<Glance>> = glances.collect();
        let unpromising = rest.par_iter().filter_map(|guesses| {
            self.course.step(FIRST_LOOK_STEPS);
            let guess = guesses.first()?;
            Some(self.unfitted(from, guess))
        });
        let unpromising: Vec<Hypothesis> = unpromising.collect();
        let limit = self.worth_a_look(&glances);
        let looks = glances.into_par_iter();
        let mut looks: Vec<Hypothesis> = looks
            .filter_map(|glances| self.best_of(from, glances, limit))
            .collect();
        looks.extend(unpromising);
        looks
    }

    /// The best guesses of a candidate.
    fn guesses(
        &self,
        residual: &ProjectedResidual,
        changes: &[PredictionChange],
        starts: usize,
    ) -> Vec<InitialGuess> {
        let mut guesses = residual.guesses(changes);
        let best = guesses.first().map_or(0.0, |guess| guess.gain);
        guesses.truncate(starts);
        if !self.small() {
            guesses.retain(|guess| guess.gain >= WORTH * best);
        }
        guesses
    }

    /// The largest squared error after a glance that deserves a look: the best third of the
    /// candidates, unless they are hopeless beside the first; the best few even so, since a glance
    /// does not say what a fit would leave whose values have far to go.
    fn worth_a_look(&self, glances: &[Vec<Glance>]) -> f64 {
        let means = |glances: &Vec<Glance>| {
            let means = glances.iter().map(|(_, glance)| glance.search_mean);
            means.min_by(f64::total_cmp)
        };
        let best: Vec<f64> = glances.iter().filter_map(means).collect();
        let all = glances.iter().flatten().map(|(_, glance)| glance);
        let hopeless = self.limit(all, None);
        if self.small() {
            hopeless
        } else {
            best_third(best.clone()).min(hopeless).max(best_few(best))
        }
    }

    /// The best of a candidate's fits: those not hopeless after a glance go on.
    fn best_of(
        &self,
        from: &Hypothesis,
        mut glances: Vec<Glance>,
        limit: f64,
    ) -> Option<Hypothesis> {
        for (_, hypothesis) in &mut glances {
            let is_misled = hypothesis.search_mean > MISLED * from.search_mean
                && self.does(Strategy::MisledGlances);
            if hypothesis.search_mean <= limit || is_misled {
                hypothesis.resume(&self.search, FitOptions::iterations(LOOK).rough());
            }
        }
        let has_starts = self.small() && self.does(Strategy::RandomStarts);
        let first = glances.first().filter(|_| has_starts);
        let restarts = first.map(|(guess, _)| self.random_starts(from, guess));
        self.course.step(1);
        let looks = glances.into_iter().map(|(_, hypothesis)| hypothesis);
        looks
            .chain(restarts.into_iter().flatten())
            .min_by(Hypothesis::by_error)
    }

    /// One more effect as it is guessed to be.
    fn unfitted(&self, from: &Hypothesis, guess: &InitialGuess) -> Hypothesis {
        let mut model = from.search.model.clone();
        model.effects.push(guess.candidate.instance(&guess.values));
        let paths: Vec<ParameterPath> = guess.candidate.paths().collect();
        let search = from.search.at_start(&model, &paths, &self.search);
        Hypothesis::new(from.set_with(guess.candidate), search)
    }

    /// A fit of one more effect as far as the derivatives known before lead.
    fn glance(&self, from: &Hypothesis, guess: &InitialGuess) -> Hypothesis {
        let options = FitOptions::iterations(LOOK).glance();
        from.with(guess.candidate, &guess.values, &self.search, options)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_many_candidates_those_that_promise_nothing_get_no_glance() {
        let many: Vec<f64> = (0..200).map(|k| 1000.0 * 0.9_f64.powi(k)).collect();
        let least = least_promise(many.clone(), false);
        let glanced = many.iter().filter(|promise| **promise >= least).count();
        assert_eq!(glanced, ALWAYS_GLANCED);
        let near = vec![1.0; 200];
        assert!(least_promise(near, false) <= 1.0);
        assert_eq!(least_promise(many.clone(), true), 0.0);
        let few = many[..MANY].to_vec();
        assert_eq!(least_promise(few, false), 0.0);
    }

    #[test]
    fn a_third_of_many_candidates_gets_a_look_and_all_of_a_few() {
        let many = (0..90).rev().map(f64::from).collect();
        assert_eq!(best_third(many), 29.0);
        let some = (0..20).map(f64::from).collect();
        assert_eq!(best_third(some), (SECOND_LOOKS - 1) as f64);
        assert_eq!(best_third(vec![3.0, 1.0]), f64::INFINITY);
    }
}
