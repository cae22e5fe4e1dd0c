//! The search: every candidate alone, then pairs and swaps around the best, then larger sets while they pay.
//!
//! A forward-greedy search stops where no single effect helps although two together would; so sets grow from
//! several leads, not one, and members of the best set are swapped.

use super::bench::{Bench, FINISH};
use super::candidate::Candidate;
use super::conclusion::conclude;
use super::consistency::own_values_share;
use super::findings::Diagnosis;
use super::opening::{Change, Lead, Opening, changes_like};
use super::options::DiagnoseOptions;
use super::progress::{ALONE, LARGER, Progress, REMAINS};
use super::trial::Trial;
use super::verdict::Case;
use crate::log::Motion;
use crate::model::Model;
use rayon::prelude::*;

/// Iterations of a first look at a candidate.
const LOOK: usize = 4;
/// An opening that promises less than this share of what the candidate's best one does is not tried.
const WORTH: f64 = 0.05;
/// Finalists of each size.
const FINALISTS: usize = 6;
/// Trials that get a second look.
const SECOND_LOOKS: usize = 3 * FINALISTS;
/// Sets from which larger ones grow.
const LEADS: usize = 5;
/// Partners tried for each lead.
const PARTNERS: usize = 5;

/// Steps of progress are short fits. To judge a trial takes as long as so many:
const JUDGE_STEPS: usize = 2;
/// The base model and the shams, likewise.
const BASE_STEPS: usize = 10;
/// The finals of one size.
const FINALS_STEPS: usize = SECOND_LOOKS + FINALISTS * (1 + JUDGE_STEPS);
/// What remains.
const REMAINDER_STEPS: usize = 10;

/// Steps until sets of `size` are done.
fn steps_up_to(size: usize, candidates: usize) -> usize {
    let larger = LEADS * PARTNERS + 2 * FINALS_STEPS;
    BASE_STEPS + candidates + FINALS_STEPS + (size - 1) * larger
}

/// Steps of a diagnosis with so many candidates, when it does not end early.
pub(super) fn planned_steps(candidates: usize, most_effects: usize) -> usize {
    steps_up_to(most_effects.max(1), candidates) + REMAINDER_STEPS
}

/// Searches for the effects a model is missing.
///
/// `training` motions are fitted; `held_out` motions decide. Without held-out motions the training motions
/// decide, and the diagnosis says so.
pub fn diagnose(
    model: &Model,
    training: Vec<Motion>,
    held_out: Vec<Motion>,
    options: &DiagnoseOptions,
    progress: &(dyn Fn(Progress) + Sync),
) -> Diagnosis {
    let mut bench = Bench::new(model, training, held_out, options, progress);
    let (best, trials) = bench.search();
    let all = steps_up_to(bench.most_effects.max(1), bench.candidates.len());
    bench.steps.begin(REMAINS, all);
    let chosen = best.as_ref().unwrap_or(&bench.base);
    let case = Case {
        bench: &bench,
        remainder: bench.remainder(chosen),
        own_values_share: own_values_share(chosen, &bench.training),
        trials,
        best,
        seed: options.seed,
    };
    let diagnosis = conclude(&case);
    bench.steps.step(REMAINDER_STEPS);
    diagnosis
}

fn by_error(a: &Trial, b: &Trial) -> std::cmp::Ordering {
    a.search_mean.total_cmp(&b.search_mean)
}

impl Bench<'_> {
    /// The smallest set that pays, if any does, and every set that was tried.
    fn search(&mut self) -> (Option<Trial>, Vec<Trial>) {
        self.steps.begin(ALONE, BASE_STEPS);
        let mut sizes = vec![self.singles()];
        let mut best = self.accepted(&self.base, &sizes[0]).cloned();
        for size in 2..=self.most_effects {
            // Where nothing but noise is left, there is nothing for more effects to explain.
            if self.at_floor(best.as_ref().unwrap_or(&self.base)) {
                break;
            }
            self.steps.begin(
                size.min(LARGER),
                steps_up_to(size - 1, self.candidates.len()),
            );
            let larger = self.grow(&sizes[size - 2]);
            if larger.is_empty() {
                break;
            }
            let reference = best.as_ref().unwrap_or(&self.base);
            let better = self.accepted(reference, &larger).cloned();
            sizes.push(larger);
            match better {
                Some(better) => best = Some(better),
                // Nothing gained by one more: two more may still, but only from a start without any.
                None if best.is_some() || size > 2 => break,
                None => {}
            }
        }
        (best, sizes.into_iter().flatten().collect())
    }

    fn singles(&mut self) -> Vec<Trial> {
        let starts = if self.small() { 6 } else { 2 };
        let trials = self.first_look(&self.base, &self.changes, starts);
        let mut trials = self.heats(trials);
        if !trials.iter().any(Trial::follows_windows) {
            self.look_elsewhere(&mut trials);
            trials.sort_by(by_error);
        }
        if let Some(best) = trials.first_mut() {
            self.shorten(best);
        }
        self.judged(trials)
    }

    /// Short fits of candidates on top of a trial, each from its best openings, at most `starts`; the better one
    /// counts. `changes` are those of each candidate.
    pub fn first_look(&self, from: &Trial, changes: &[Vec<Change>], starts: usize) -> Vec<Trial> {
        let lead = Lead::new(&from.search);
        changes
            .par_iter()
            .filter_map(|changes| {
                let mut found = lead.openings(changes);
                let best = found.first().map_or(0.0, |o| o.gain);
                found.truncate(starts);
                if !self.small() {
                    found.retain(|o| o.gain >= WORTH * best);
                }
                self.steps.step(1);
                self.best_of(from, &found)
            })
            .collect()
    }

    fn best_of(&self, from: &Trial, openings: &[Opening]) -> Option<Trial> {
        let looks = openings
            .iter()
            .map(|o| from.with(o.candidate, &o.values, &self.search, LOOK));
        let restarts = openings
            .first()
            .filter(|_| self.small())
            .map(|o| self.restarted(from, o))
            .into_iter()
            .flatten();
        looks
            .chain(restarts)
            .min_by(|a, b| a.search_mean.total_cmp(&b.search_mean))
    }

    /// Sorts trials by training error, takes the best to the end and judges them.
    fn finals(&self, trials: Vec<Trial>) -> Vec<Trial> {
        let trials = self.heats(trials);
        self.judged(trials)
    }

    /// Sorts trials by training error and takes the best to the end: many get a second look, few go on.
    fn heats(&self, mut trials: Vec<Trial>) -> Vec<Trial> {
        trials.sort_by(by_error);
        let seconds = SECOND_LOOKS.min(trials.len());
        trials[..seconds].par_iter_mut().for_each(|trial| {
            trial.look_again(&self.search, LOOK);
            self.steps.step(1);
        });
        trials.sort_by(by_error);
        let finalists = FINALISTS.min(trials.len());
        trials[..finalists].par_iter_mut().for_each(|trial| {
            trial.finish(&self.search, FINISH);
            self.steps.step(1);
        });
        trials.sort_by(by_error);
        trials
    }

    /// Judges the finalists.
    fn judged(&self, mut trials: Vec<Trial>) -> Vec<Trial> {
        let finalists = FINALISTS.min(trials.len());
        trials[..finalists].par_iter_mut().for_each(|trial| {
            self.judge(trial);
            self.steps.step(JUDGE_STEPS);
        });
        trials
    }

    /// Larger sets: partners for each lead, chosen by what they would gain, then swaps in the best.
    fn grow(&self, leads: &[Trial]) -> Vec<Trial> {
        let mut tried: Vec<Trial> = Vec::new();
        for lead in leads.iter().take(LEADS) {
            let wanted = self.partners(lead, &tried);
            let found: Vec<Trial> = wanted
                .par_iter()
                .map(|o| {
                    self.steps.step(1);
                    lead.with(o.candidate, &o.values, &self.search, LOOK)
                })
                .collect();
            tried.extend(found);
        }
        let finals = self.finals(tried);
        self.swapped(finals)
    }

    /// The most promising openings on top of a trial that make a set not yet tried.
    ///
    /// Which candidates promise most is told by what they change in the base model's prediction; only those are
    /// simulated on top of the trial.
    fn partners(&self, from: &Trial, tried: &[Trial]) -> Vec<Opening> {
        let lead = Lead::new(&from.search);
        let mut promising: Vec<(&Change, f64)> = self
            .changes
            .par_iter()
            .filter(|changes| {
                changes.first().is_some_and(|c| {
                    let mut set = from.set.clone();
                    set.push(c.candidate);
                    !from.set.contains(&c.candidate) && !tried.iter().any(|t| t.adds(&set))
                })
            })
            .filter_map(|changes| {
                let gains = changes.iter().map(|c| (c, lead.opening(c).gain));
                gains.max_by(|a, b| a.1.total_cmp(&b.1))
            })
            .collect();
        promising.sort_by(|a, b| b.1.total_cmp(&a.1));
        promising.truncate(2 * PARTNERS);
        let mut openings: Vec<Opening> = promising
            .par_iter()
            .filter_map(|(like, _)| {
                let changes = changes_like(&from.search, like, &self.search);
                lead.openings(&changes).into_iter().next()
            })
            .collect();
        openings.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        openings.truncate(PARTNERS);
        openings
    }

    /// Tries to replace each older member of the best set: what led may no longer be needed.
    fn swapped(&self, mut trials: Vec<Trial>) -> Vec<Trial> {
        let Some(best) = trials.first().cloned() else {
            return trials;
        };
        for leaving in 0..best.set.len().saturating_sub(1) {
            let kept: Vec<Candidate> = (0..best.set.len())
                .filter(|&i| i != leaving)
                .map(|i| best.set[i])
                .collect();
            let mut rest = best.without(leaving, &self.base);
            rest.refit(&self.search, LOOK);
            let wanted: Vec<Opening> = self
                .partners(&rest, &trials)
                .into_iter()
                .filter(|o| !kept.contains(&o.candidate))
                .take(2)
                .collect();
            let found: Vec<Trial> = wanted
                .par_iter()
                .map(|o| rest.with(o.candidate, &o.values, &self.search, LOOK))
                .collect();
            trials.extend(found);
        }
        self.finals(trials)
    }
}
