//! The search: every candidate alone, then pairs around the best, then larger sets while more is
//! left than noise excuses.
//!
//! A forward-greedy search stops where no single effect helps although two together would; so sets
//! grow from a beam of several, not from one, and lose again what they no longer need. Within a
//! size, successive halving spends the iterations: all get a look, many a second, few are fitted to
//! the end. What each further part of the search brings is measured by `cargo xtask ablation`.

use super::budget::{
    BEAM, EVALUATION_STEPS, FAR_BEHIND, FINALISTS, FINISH, LOOK, SECOND_LOOKS, VALUE_STEPS,
    larger_steps, singles_steps,
};
use super::evaluator::{Evaluator, every_change};
use super::explanation::Explanation;
use super::hypothesis::Hypothesis;
use super::progress::Stage;
use super::strategy::Strategy;
use super::verdict::FAR_OFF;
use crate::fitting::{FitOptions, InitialGuess};
use rayon::prelude::*;

mod partners;
mod plainest;
mod results;

pub(super) use results::SearchResults;
use results::put_among;

impl Evaluator<'_> {
    /// Looks for the smallest set that pays, if any does, and for a wrong value; keeps in `found`
    /// what it has, and goes on from there.
    pub fn search(&mut self, found: &mut SearchResults) {
        if found.sizes.is_empty() {
            let tolerates = self.tolerates(found.outcome().explanation(self));
            if tolerates && !self.at_noise_floor(&self.base) {
                (found.is_tolerated, found.at) = (true, None);
                return;
            }
            self.begin(found);
        }
        for size in 2..=self.most_effects {
            if found.sizes.len() < size {
                if self.is_done(found) || !self.go_to(size, found) {
                    break;
                }
            } else {
                self.begin_size(size, found);
            }
            if !self.is_done(found) {
                self.grow_further(found);
                self.prune(found);
            }
            // Where one more gains nothing two more may still, if there is much to gain.
            let best = found.best.as_ref();
            let now = best.map(|best| best.set.len());
            let excused = best.is_some_and(|best| best.deciding_mean() < FAR_OFF);
            if now == found.before && excused {
                break;
            }
        }
        found.best = found
            .best
            .take()
            .map(|best| self.smallest_within(best, &found.sizes));
        // The best so far stands where this is ended.
        if let Some(best) = found.best.clone() {
            found.best = Some(self.plainest(best));
        }
        found.at = None;
    }

    /// Tries every effect alone, then every value.
    fn begin(&mut self, found: &mut SearchResults) {
        found.at = Some(Stage::Alone);
        let expected = singles_steps(self.candidates.len());
        self.say(Stage::Alone, expected);
        let mut singles = self.singles();
        self.put_plainer(&mut singles);
        self.keep(found, |found| found.sizes.push(singles));
        found.best = self.smallest_that_pays(&found.sizes);
        self.search_values(found);
    }

    /// Says that a stage begins, of so many steps.
    fn say(&self, stage: Stage, expected: usize) {
        self.course.begin(stage, self.round(), expected);
    }

    /// Goes on to sets of another size, and says so.
    fn begin_size(&self, size: usize, found: &mut SearchResults) {
        let stage = Stage::of_size(size);
        let tries_all = self.tries_all && size == 2;
        let beside = tries_all.then_some(self.candidates.len());
        found.at = Some(stage);
        self.say(stage, larger_steps(beside));
    }

    /// Grows sets of another size; whether there are any.
    fn go_to(&mut self, size: usize, found: &mut SearchResults) -> bool {
        self.begin_size(size, found);
        found.before = found.best.as_ref().map(|best| best.set.len());
        let mut larger = self.grow(&found.sizes[size - 2]);
        self.put_plainer(&mut larger);
        if larger.is_empty() {
            return false;
        }
        self.keep(found, |found| found.sizes.push(larger));
        let horizon = self.horizon;
        self.settle_horizon(&mut found.sizes);
        if self.horizon != horizon {
            self.judge_values_again(found);
        }
        self.prune(found);
        true
    }

    /// Evaluates values again that were evaluated over another horizon.
    fn judge_values_again(&self, found: &mut SearchResults) {
        let values = found.values.iter_mut().chain(&mut found.values_refitted);
        let values = values.filter_map(|value| value.evaluation.take().map(|_| value));
        let values: Vec<&mut Hypothesis> = values.collect();
        values
            .into_par_iter()
            .for_each(|value| self.evaluate(value));
    }

    /// Tries the values of the model's file: hopeless is what single effects make so, and those
    /// that explain most.
    fn search_values(&self, found: &mut SearchResults) {
        found.at = Some(Stage::Values);
        self.say(Stage::Values, VALUE_STEPS);
        let least = found.best.as_ref().unwrap_or(&self.base).search_mean;
        let values = self.try_values(Some(least));
        self.keep(found, |found| found.values = values);
        let values = self.try_values_refitted(Some(least));
        self.keep(found, |found| found.values_refitted = values);
    }

    /// Whether there is nothing left to look for beside the best set, another value of the file, or
    /// the base model; nothing is where the user tolerates what is left.
    fn is_done(&self, found: &mut SearchResults) -> bool {
        let best = found.best.as_ref();
        let tried = found.outcome();
        let explanation = tried.explanation(self);
        let is_explained = self.is_value_that_explains(explanation)
            || match (best, self.tries_all) {
                (Some(best), true) => self.is_explained_by(best),
                (best, _) => self.at_noise_floor(best.unwrap_or(&self.base)),
            };
        found.is_tolerated = !is_explained && self.tolerates(explanation);
        is_explained || found.is_tolerated
    }

    /// Whether the user asks for no less error than the explanation leaves that was found.
    fn tolerates(&self, explanation: Explanation) -> bool {
        let left_rad = explanation.hypothesis().deciding_rms_rad();
        (self.tolerance_rad).is_some_and(|tolerance_rad| left_rad <= tolerance_rad)
    }

    /// Whether a set leaves nothing but noise, over the horizon that counts and in the windows it
    /// was searched on: these may be longer, and show what shorter ones do not.
    pub fn is_explained_by(&self, set: &Hypothesis) -> bool {
        self.at_noise_floor(set) && set.follows_windows()
    }

    /// The smallest set that pays: one more effect must bring something over the best of fewer.
    fn smallest_that_pays(&self, sizes: &[Vec<Hypothesis>]) -> Option<Hypothesis> {
        let mut best: Option<&Hypothesis> = None;
        for of_size in sizes {
            let reference = best.unwrap_or(&self.base);
            best = self.accepted(reference, of_size).or(best);
        }
        best.cloned()
    }

    /// Takes each effect out of the smallest set that pays, and out of the best of every size that
    /// leaves less than all smaller ones: what helped another out of a false valley is not missing
    /// itself. Then the smallest that pays is the best.
    fn prune(&self, found: &mut SearchResults) {
        loop {
            found.best = self.smallest_that_pays(&found.sizes);
            let whole = found
                .best
                .iter()
                .chain(leaders(&found.sizes))
                .find(|whole| {
                    let known = found.taken_apart.iter().any(|known| whole.adds(known));
                    whole.set.len() > 1 && !known
                });
            let takes_apart = self.does(Strategy::TakingApart);
            let Some(whole) = whole.filter(|_| takes_apart).cloned() else {
                return;
            };
            self.take_apart(&whole, &mut found.sizes[whole.set.len() - 2]);
            self.keep(found, |found| found.taken_apart.push(whole.set));
        }
    }

    /// Refits the set less each of its effects from the values it has, and puts what that improves
    /// on, or adds, among the sets of that size.
    fn take_apart(&self, whole: &Hypothesis, fewer: &mut Vec<Hypothesis>) {
        let rests = (0..whole.set.len()).into_par_iter().map(|leaving| {
            let mut rest = whole.without(leaving, &self.base, &self.search, FINISH);
            self.evaluate_found(&mut rest);
            self.course.step(EVALUATION_STEPS);
            rest
        });
        put_among(fewer, rests.collect());
    }

    /// Looks further for pairs where every candidate is to be tried.
    fn grow_further(&mut self, found: &mut SearchResults) {
        if let ([smaller, larger], true) = (&mut found.sizes[..], self.tries_all) {
            self.try_all_beside(smaller, larger);
            self.take_evaluated();
        }
    }

    /// Tries every candidate on top of the sets that lead, one in the windows of the search and one
    /// where it counts, by what it changes in their own predictions, and puts what it finds among
    /// the `larger` sets: what promises little beside a set that is not the whole may be the rest.
    fn try_all_beside(&self, smaller: &[Hypothesis], larger: &mut Vec<Hypothesis>) {
        let first = smaller.iter().min_by(|a, b| Hypothesis::by_error(a, b));
        let mut leading: Vec<&Hypothesis> = first.into_iter().chain(leader(smaller)).collect();
        leading.dedup_by(|a, b| a.adds(&b.set));
        let found = leading.into_iter().flat_map(|set| {
            let mut beside = self.candidates.clone();
            beside.retain(|candidate| self.is_new(set, *candidate, &[]));
            self.first_look(set, &every_change(set, &beside, &self.search), 1)
        });
        let found = self.successive_halving(found.collect());
        put_among(larger, self.evaluated(found));
    }

    fn singles(&mut self) -> Vec<Hypothesis> {
        let starts = if self.small() { 6 } else { 2 };
        let hypotheses = self.first_look(&self.base, &self.changes, starts);
        let mut hypotheses = self.successive_halving(hypotheses);
        let is_followed = hypotheses.iter().any(Hypothesis::follows_windows);
        if !is_followed && !self.is_led(&hypotheses) {
            self.restart_bent(&mut hypotheses);
            self.restart_jumping(&mut hypotheses);
            hypotheses.sort_by(Hypothesis::by_error);
        }
        self.choose_horizon(&hypotheses);
        self.evaluated(hypotheses)
    }

    /// A short fit of one more effect.
    fn look(&self, from: &Hypothesis, guess: &InitialGuess) -> Hypothesis {
        let options = FitOptions::iterations(LOOK).rough();
        from.with(guess.candidate, &guess.values, &self.search, options)
    }

    /// Sorts hypotheses by training error and fits the best to the end: many get a second look, few
    /// go on.
    pub(super) fn successive_halving(&self, mut hypotheses: Vec<Hypothesis>) -> Vec<Hypothesis> {
        let rounds = [
            (SECOND_LOOKS, FitOptions::iterations(LOOK).rough()),
            (FINALISTS, FitOptions::iterations(FINISH)),
        ];
        for (survivors, options) in rounds {
            hypotheses.sort_by(Hypothesis::by_error);
            let survivors = survivors.min(self.promising(&hypotheses, None));
            let best = hypotheses[..survivors].par_iter_mut();
            best.for_each(|hypothesis| {
                hypothesis.resume(&self.search, options);
                self.course.step(1);
            });
        }
        hypotheses.sort_by(Hypothesis::by_error);
        hypotheses
    }

    /// Evaluates the finalists.
    fn evaluated(&self, mut hypotheses: Vec<Hypothesis>) -> Vec<Hypothesis> {
        let count = self.promising(&hypotheses, None).min(FINALISTS);
        self.evaluate_all(&mut hypotheses[..count], None, || {
            self.course.step(EVALUATION_STEPS)
        });
        hypotheses
    }

    /// Larger sets: partners for each set of the beam, chosen by what they would gain.
    fn grow(&self, smaller: &[Hypothesis]) -> Vec<Hypothesis> {
        let mut tried: Vec<Hypothesis> = Vec::new();
        for from in beam(smaller) {
            let partners = self.partners(from, &tried);
            let found = partners.par_iter().map(|guess| {
                self.course.step(1);
                self.look(from, guess)
            });
            let found: Vec<Hypothesis> = found.collect();
            tried.extend(found);
        }
        self.evaluated(self.successive_halving(tried))
    }
}

/// The sets that larger ones grow from: the best of the short windows, unless they are far behind
/// the first.
fn beam(sorted: &[Hypothesis]) -> impl Iterator<Item = &Hypothesis> {
    let far = FAR_BEHIND * sorted.first().map_or(0.0, |first| first.search_mean);
    let near = sorted.iter().take_while(move |h| h.search_mean <= far);
    near.take(BEAM)
}

/// The one that leaves least where it counts.
fn leader(of_size: &[Hypothesis]) -> Option<&Hypothesis> {
    let by_error =
        |a: &&Hypothesis, b: &&Hypothesis| a.deciding_mean().total_cmp(&b.deciding_mean());
    of_size.iter().min_by(by_error)
}

/// The best of every size, the largest first, that leaves less than all of fewer effects do.
fn leaders(sizes: &[Vec<Hypothesis>]) -> impl Iterator<Item = &Hypothesis> {
    let mut least = f64::INFINITY;
    let leaders = sizes.iter().filter_map(move |of_size| {
        let leader = leader(of_size)?;
        let leads = leader.deciding_mean() < least;
        least = least.min(leader.deciding_mean());
        leads.then_some(leader)
    });
    leaders.collect::<Vec<_>>().into_iter().rev()
}

#[cfg(test)]
mod bent_tests;
#[cfg(test)]
mod drive_lag_tests;
#[cfg(test)]
mod ended_tests;
#[cfg(test)]
mod larger_tests;
#[cfg(test)]
mod stated_tests;
#[cfg(test)]
pub(super) mod tests;
#[cfg(test)]
mod value_tests;
#[cfg(test)]
mod whirling_tests;
