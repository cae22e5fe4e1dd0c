//! How far a diagnosis has come, over all that it does, and what ends it.

use super::judging::Judging;
use super::options::DiagnoseOptions;
use crate::fitting::{BestSoFar, Halt, Progress, StopSwitch};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// What is done, one after the other; the search again, in other windows, where it explained
/// nothing in windows that the model loses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Stage {
    Base,
    Alone,
    Values,
    Pairs,
    Larger,
    Judging,
}

impl Stage {
    /// Those of one search.
    pub const SEARCH: [Stage; 5] = [
        Stage::Base,
        Stage::Alone,
        Stage::Values,
        Stage::Pairs,
        Stage::Larger,
    ];

    /// The stage of sets of so many effects.
    pub fn of_size(size: usize) -> Stage {
        match size {
            0 | 1 => Stage::Alone,
            2 => Stage::Pairs,
            _ => Stage::Larger,
        }
    }

    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Base => "the model as it is",
            Stage::Alone => "every effect alone",
            Stage::Values => "values of the model file",
            Stage::Pairs => "sets of two effects",
            Stage::Larger => "sets of three effects",
            Stage::Judging => "judging",
        }
    }

    /// All that is tried in it, for people.
    pub fn all_of_it(self) -> &'static str {
        match self {
            Stage::Base => "the model as it is",
            Stage::Alone => "the single effects",
            Stage::Values => "the values of the model file",
            Stage::Pairs => "the sets of two effects",
            Stage::Larger => "the sets of three effects",
            Stage::Judging => "the judging",
        }
    }

    /// Share of a diagnosis that explains nothing, in thousandths of its searches and the judging:
    /// measured on arms whose law is outside the library.
    fn weight(self, round: Round) -> usize {
        match (self, round) {
            (Stage::Base, Round::First | Round::Only) => 20,
            (Stage::Alone, Round::First) => 120,
            (Stage::Values, Round::First) => 20,
            (Stage::Pairs, Round::First) => 65,
            (Stage::Larger, Round::First) => 95,
            (Stage::Base, Round::Second) => 15,
            (Stage::Alone, Round::Second) => 140,
            (Stage::Values, Round::Second) => 20,
            (Stage::Pairs, Round::Second) => 210,
            (Stage::Larger, Round::Second) => 255,
            (Stage::Alone, Round::Only) => 200,
            (Stage::Values, Round::Only) => 25,
            (Stage::Pairs, Round::Only) => 235,
            (Stage::Larger, Round::Only) => 480,
            (Stage::Judging, _) => 40,
        }
    }
}

/// Which search a stage belongs to.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Round {
    /// One that another may follow, in other windows.
    #[default]
    First,
    /// That other one.
    Second,
    /// One that none follows.
    Only,
}

/// Steps of progress in all.
const TOTAL: usize = 1000;
/// Steps that must be done before they say how long the others take, and how long they must have
/// taken.
const TELLING: f64 = 20.0;
const TELLING_S: f64 = 2.0;
/// Evaluations that the judging takes as long as.
const JUDGING_EVALUATIONS: f64 = 25.0;
/// The least and the most of the time that is kept for it, as shares of the whole.
const KEPT: (f64, f64) = (0.03, 0.35);
/// Seconds of the limit that are left to say what was found.
const SAYING_S: f64 = 0.3;
/// Time for the judging where a search without limit is ended, s, and its share of the time before.
const JUDGING_S: f64 = 10.0;
const JUDGING_SHARE: f64 = 0.1;

/// The course of a diagnosis: its steps, which are told to who listens, and its end.
#[derive(Clone)]
pub(super) struct Course<'a> {
    pub halt: Halt,
    stop: StopSwitch,
    within: Option<Duration>,
    steps: Arc<Mutex<Steps>>,
    heard: &'a (dyn Fn(Progress) + Sync),
}

#[derive(Default)]
struct Steps {
    round: Round,
    stage: Option<Stage>,
    /// Weights of the stages that are done or needless, and of those that were done.
    passed: f64,
    spent: f64,
    /// Steps of the stage, and those that are expected.
    done: usize,
    expected: usize,
    /// The most that was told.
    told: usize,
    best: Option<BestSoFar>,
    /// Runs of evaluations, and how many there were.
    evaluated: (usize, usize),
}

impl<'a> Course<'a> {
    /// One that begins now.
    pub fn new(options: &DiagnoseOptions, heard: &'a (dyn Fn(Progress) + Sync)) -> Self {
        Course::halted_by(Halt::by(&options.stop), options, heard)
    }

    /// One that this ends.
    pub fn halted_by(
        halt: Halt,
        options: &DiagnoseOptions,
        heard: &'a (dyn Fn(Progress) + Sync),
    ) -> Self {
        Course {
            halt,
            stop: options.stop.clone(),
            within: options.within_s.map(Duration::from_secs_f64),
            steps: Arc::default(),
            heard,
        }
    }

    fn steps(&self) -> MutexGuard<'_, Steps> {
        self.steps.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A stage of a search begins, of so many steps if it does not end early; all before it are
    /// done, or needless.
    pub fn begin(&self, stage: Stage, round: Round, expected: usize) {
        let mut steps = self.steps();
        steps.pass(stage, round);
        steps.expected = expected;
        drop(steps);
        self.step(0);
    }

    /// `count` more steps of the stage are done.
    pub fn step(&self, count: usize) {
        let elapsed_s = self.halt.elapsed().as_secs_f64();
        let mut steps = self.steps();
        steps.done += count;
        let within_s = self.within.map(|within| within.as_secs_f64());
        let progress = steps.progress(elapsed_s, within_s);
        // Under the lock: what is heard never falls, whichever thread tells it.
        (self.heard)(progress);
        drop(steps);
    }

    /// An evaluation is done, that took so many runs: the judging will take as long as several.
    pub fn evaluated(&self, runs: usize) {
        let mut steps = self.steps();
        steps.evaluated.0 += runs;
        steps.evaluated.1 += 1;
        drop(steps);
        self.keep_time();
    }

    /// The search may take the time that is not kept for the judging, and ends where what was found
    /// is accepted.
    pub fn keep_time(&self) {
        let end = self.within.map(|within| {
            let (runs, count) = self.steps().evaluated;
            let each = runs as f64 / count.max(1) as f64;
            let rate = self.halt.runs() as f64 / self.halt.elapsed().as_secs_f64().max(1e-3);
            let kept = Duration::from_secs_f64(JUDGING_EVALUATIONS * each / rate.max(1.0));
            let (least, most) = (within.mul_f64(KEPT.0), within.mul_f64(KEPT.1));
            within.saturating_sub(kept.clamp(least, most))
        });
        self.halt.ends_at(end, true);
    }

    /// Whether what was found is enough.
    pub fn is_accepted(&self) -> bool {
        self.stop.is_accepted()
    }

    /// A best so far. What is shown leaves less than what was shown before.
    pub fn found(&self, best: BestSoFar) {
        let mut steps = self.steps();
        if steps
            .best
            .as_ref()
            .is_none_or(|b| best.error_rad < b.error_rad)
        {
            steps.best = Some(best);
        }
    }

    /// Nothing is the best so far.
    pub fn forget(&self) {
        self.steps().best = None;
    }

    /// The judging begins: when it has to be done, where the search was ended or has a limit.
    pub fn judging(&self, was_ended: bool) -> Judging {
        let elapsed = self.halt.elapsed();
        let within = self
            .within
            .map(|within| within.saturating_sub(Duration::from_secs_f64(SAYING_S)));
        let waits = was_ended && (self.within.is_none() || self.is_accepted());
        let waiting = waits
            .then(|| elapsed + Duration::from_secs_f64(JUDGING_S) + elapsed.mul_f64(JUDGING_SHARE));
        let end = within.into_iter().chain(waiting).min();
        Judging::until(end, &self.halt)
    }
}

impl Steps {
    /// Passes the stages before this one.
    fn pass(&mut self, stage: Stage, round: Round) {
        self.spent += self.in_stage();
        let searched = |until: Stage, round: Round| -> usize {
            let before = Stage::SEARCH.into_iter().filter(|stage| *stage < until);
            before.map(|stage| stage.weight(round)).sum()
        };
        self.round = round;
        let passed = match (stage, round) {
            (Stage::Judging, _) => TOTAL - stage.weight(round),
            (_, Round::Second) => searched(Stage::Judging, Round::First) + searched(stage, round),
            _ => searched(stage, round),
        };
        self.passed = self.passed.max(passed as f64);
        (self.stage, self.done) = (Some(stage), 0);
    }

    /// What of the stage's weight is done.
    fn in_stage(&self) -> f64 {
        let weight = self.stage.map_or(0, |stage| stage.weight(self.round));
        let share = self.done as f64 / self.expected.max(1) as f64;
        weight as f64 * share.min(1.0)
    }

    fn progress(&mut self, elapsed_s: f64, within_s: Option<f64>) -> Progress {
        let done = self.passed + self.in_stage();
        let spent = self.spent + self.in_stage();
        let by_time = within_s.map_or(0.0, |within| TOTAL as f64 * elapsed_s / within);
        self.told = self.told.max(done.max(by_time) as usize).min(TOTAL);
        let left = (spent >= TELLING && elapsed_s >= TELLING_S)
            .then(|| elapsed_s / spent * (TOTAL as f64 - done).max(0.0));
        let limit = within_s.map(|within| (within - elapsed_s).max(0.0));
        let what = self.stage.map_or("", Stage::name);
        Progress {
            done: self.told,
            total: TOTAL,
            what: if self.round == Round::Second && self.stage != Some(Stage::Judging) {
                format!("second search: {what}").into()
            } else {
                what.into()
            },
            best: self.best.clone(),
            left_s: left.into_iter().chain(limit).reduce(f64::min),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Told steps and what is done, of stages that run over, end early, or are done again.
    fn told(options: &DiagnoseOptions) -> Vec<(usize, String)> {
        let told = Mutex::new(Vec::new());
        let heard = |progress: Progress| {
            assert_eq!(progress.total, TOTAL);
            let what = progress.what.to_string();
            told.lock().unwrap().push((progress.done, what));
        };
        let course = Course::new(options, &heard);
        course.begin(Stage::Base, Round::First, 2);
        course.step(2);
        course.begin(Stage::Alone, Round::First, 10);
        course.step(5);
        // More than was expected, and then fewer.
        course.step(20);
        course.begin(Stage::Pairs, Round::First, 10);
        course.step(1);
        course.begin(Stage::Pairs, Round::Second, 1);
        course.step(1);
        course.begin(Stage::Larger, Round::Second, 4);
        course.step(4);
        course.begin(Stage::Judging, Round::Second, 1);
        course.step(1);
        told.into_inner().unwrap()
    }

    #[test]
    fn progress_never_falls_and_ends_with_the_judging_alone() {
        for within_s in [None, Some(1e-3), Some(1e3)] {
            let options = DiagnoseOptions {
                within_s,
                ..DiagnoseOptions::default()
            };
            let told = told(&options);
            assert!(
                told.windows(2).all(|pair| pair[0].0 <= pair[1].0),
                "{told:?}"
            );
            assert_eq!(told.last().unwrap().0, TOTAL);
            let before = &told[told.len() - 3];
            assert_eq!(before.1, "second search: sets of three effects");
            if within_s != Some(1e-3) {
                assert_eq!(
                    before.0,
                    TOTAL - Stage::Judging.weight(Round::Second),
                    "{told:?}"
                );
            }
        }
    }

    #[test]
    fn the_weights_of_all_stages_are_the_whole() {
        let search = |round: Round| -> usize {
            let stages = Stage::SEARCH.map(|stage| stage.weight(round));
            stages.iter().sum()
        };
        let rest = TOTAL - Stage::Judging.weight(Round::First);
        assert_eq!(search(Round::First) + search(Round::Second), rest);
        assert_eq!(search(Round::Only), rest);
    }
}
