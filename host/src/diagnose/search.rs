//! The search: every candidate alone, then pairs and swaps around the best, then larger sets while
//! more is left than noise excuses.
//!
//! A forward-greedy search stops where no single effect helps although two together would; so sets
//! grow from a beam of several, not from one, and members of the best set are swapped. Within a
//! size, successive halving spends the iterations: all get a look, many a second, few are fitted to
//! the end.

use super::budget::{
    BASE_STEPS, BEAM, EVALUATION_STEPS, FINALISTS, FINISH, LOOK, SECOND_LOOKS, steps_up_to,
};
use super::evaluator::{Evaluator, Reach, every_change};
use super::hypothesis::Hypothesis;
use super::progress::{ALONE, LARGER};
use super::verdict::FAR_OFF;
use crate::fitting::{Candidate, FitOptions, InitialGuess};
use rayon::prelude::*;

mod partners;

impl Evaluator<'_> {
    /// The smallest set that pays, if any does, and every set that was tried.
    pub fn search(&mut self) -> (Option<Hypothesis>, Vec<Hypothesis>) {
        self.steps.begin(ALONE, BASE_STEPS);
        let mut sizes = vec![self.singles()];
        let mut taken_apart = Vec::new();
        let mut best = self.smallest_that_pays(&sizes);
        for size in 2..=self.most_effects {
            if self.is_done(best.as_ref()) {
                break;
            }
            let done = steps_up_to(size - 1, self.candidates.len());
            self.steps.begin(size.min(LARGER), done);
            let larger = self.grow(&sizes[size - 2]);
            if larger.is_empty() {
                break;
            }
            sizes.push(larger);
            self.settle_horizon(&mut sizes);
            let before = best.as_ref().map(|best| best.set.len());
            best = self.pruned(&mut sizes, &mut taken_apart);
            if !self.is_done(best.as_ref()) {
                self.grow_further(best.as_ref(), before, &mut sizes);
                best = self.pruned(&mut sizes, &mut taken_apart);
            }
            // Where one more gains nothing two more may still, if there is much to gain.
            let now = best.as_ref().map(|best| best.set.len());
            let excused = best.as_ref().is_some_and(|b| b.deciding_mean() < FAR_OFF);
            if now == before && excused {
                break;
            }
        }
        (best, sizes.into_iter().flatten().collect())
    }

    /// Whether there is nothing left to look for beside the best set, or the base model.
    fn is_done(&self, best: Option<&Hypothesis>) -> bool {
        match (best, self.reach) {
            (Some(best), Reach::Everything) => self.is_explained_by(best),
            (best, _) => self.at_noise_floor(best.unwrap_or(&self.base)),
        }
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

    /// The smallest set that pays once each effect was taken out of that set, and out of the best
    /// of every size that leaves less than all smaller ones: what helped another out of a false
    /// valley is not missing itself.
    fn pruned(
        &self,
        sizes: &mut [Vec<Hypothesis>],
        taken_apart: &mut Vec<Vec<Candidate>>,
    ) -> Option<Hypothesis> {
        loop {
            let best = self.smallest_that_pays(sizes);
            let whole = best.iter().chain(leaders(sizes)).find(|whole| {
                let known = taken_apart.iter().any(|known| whole.adds(known));
                whole.set.len() > 1 && !known
            });
            let Some(whole) = whole.cloned() else {
                return best;
            };
            self.take_apart(&whole, &mut sizes[whole.set.len() - 2]);
            taken_apart.push(whole.set);
        }
    }

    /// Refits the set less each of its effects from the values it has, and puts what that improves
    /// on, or adds, among the sets of that size.
    fn take_apart(&self, whole: &Hypothesis, fewer: &mut Vec<Hypothesis>) {
        let rests = (0..whole.set.len()).into_par_iter().map(|leaving| {
            let mut rest = whole.without(leaving, &self.base, &self.search, FINISH);
            self.evaluate(&mut rest);
            rest
        });
        put_among(fewer, rests.collect());
    }

    /// Looks further for sets of the largest size, where `best` leaves something to explain: every
    /// candidate, or, where sets of that size bring nothing over the `before` effects of the best
    /// smaller one, those that promise most beside it.
    fn grow_further(
        &mut self,
        best: Option<&Hypothesis>,
        before: Option<usize>,
        sizes: &mut [Vec<Hypothesis>],
    ) {
        let [.., smaller, larger] = sizes else {
            return;
        };
        if self.reach == Reach::Everything {
            self.try_all_beside(smaller, larger);
            return;
        }
        let Some(stuck) = best.filter(|best| Some(best.set.len()) == before) else {
            return;
        };
        // Where the smaller sets do not pay either, from the one that leaves least.
        let from_stuck = larger
            .first()
            .is_some_and(|l| stuck.set.len() + 1 == l.set.len());
        let from = if from_stuck {
            Some(stuck)
        } else {
            smaller.first()
        };
        if let Some(from) = from {
            self.grow_afresh(&from.clone(), larger);
        }
    }

    /// Looks for a partner of a set by what every candidate changes in that set's own prediction,
    /// and puts what it finds among the sets that are `larger` by one: where the base model is far
    /// off, its prediction says little of what is missing beside the set.
    fn grow_afresh(&mut self, set: &Hypothesis, larger: &mut Vec<Hypothesis>) {
        let afresh = every_change(set, &self.candidates, &self.search);
        let of_base = std::mem::replace(&mut self.changes, afresh);
        put_among(larger, self.grow(std::slice::from_ref(set)));
        self.changes = of_base;
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
        put_among(larger, self.swapped(self.evaluated(found)));
    }

    fn singles(&mut self) -> Vec<Hypothesis> {
        let starts = if self.small() { 6 } else { 2 };
        let hypotheses = self.first_look(&self.base, &self.changes, starts);
        let mut hypotheses = self.successive_halving(hypotheses);
        if !hypotheses.iter().any(Hypothesis::follows_windows) {
            self.restart_jumping(&mut hypotheses);
            hypotheses.sort_by(Hypothesis::by_error);
            self.restage_leader(&mut hypotheses);
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
    fn successive_halving(&self, mut hypotheses: Vec<Hypothesis>) -> Vec<Hypothesis> {
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
                self.steps.step(1);
            });
        }
        hypotheses.sort_by(Hypothesis::by_error);
        hypotheses
    }

    /// Evaluates the finalists.
    fn evaluated(&self, mut hypotheses: Vec<Hypothesis>) -> Vec<Hypothesis> {
        let count = self.promising(&hypotheses, None).min(FINALISTS);
        self.evaluate_all(&mut hypotheses[..count], None, || {
            self.steps.step(EVALUATION_STEPS)
        });
        hypotheses
    }

    /// Larger sets: partners for each set of the beam, chosen by what they would gain, then swaps
    /// in the best.
    fn grow(&self, smaller: &[Hypothesis]) -> Vec<Hypothesis> {
        let mut tried: Vec<Hypothesis> = Vec::new();
        for from in beam(smaller) {
            let partners = self.partners(from, &tried);
            let found = partners.par_iter().map(|guess| {
                self.steps.step(1);
                self.look(from, guess)
            });
            let found: Vec<Hypothesis> = found.collect();
            tried.extend(found);
        }
        let finals = self.evaluated(self.successive_halving(tried));
        self.swapped(finals)
    }
}

/// The sets that larger ones grow from: the best of the short windows, and the one that leaves
/// least where it counts, which may lie behind five of the first that are nearly the same.
fn beam(sorted: &[Hypothesis]) -> impl Iterator<Item = &Hypothesis> {
    let (first, behind) = sorted.split_at(BEAM.min(sorted.len()));
    let mean = Hypothesis::deciding_mean;
    let least = first.iter().map(mean).fold(f64::INFINITY, f64::min);
    let best_behind = behind.iter().min_by(|a, b| mean(a).total_cmp(&mean(b)));
    first
        .iter()
        .chain(best_behind.filter(|best| mean(best) < least))
}

/// Puts sets among those of their size that were tried, and in the place of the same ones that
/// leave more.
fn put_among(tried: &mut Vec<Hypothesis>, found: Vec<Hypothesis>) {
    for new in found {
        match tried.iter_mut().find(|known| known.adds(&new.set)) {
            Some(known) if known.deciding_mean() <= new.deciding_mean() => {}
            Some(known) => *known = new,
            None => tried.push(new),
        }
    }
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
pub(super) mod tests;
