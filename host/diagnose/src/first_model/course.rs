//! How far the estimate of a first model has come, and what ends it.

use crate::fitting::Progress;
use crate::fitting::{Halt, StopSwitch};
use std::sync::{Mutex, PoisonError};

/// What is done, one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Stage {
    /// Zeros and signs are told apart on short windows.
    Screening,
    /// The best is fitted, from several starts.
    Fitting,
    /// What the log determines is told from what it does not.
    Settling,
}

const TOTAL: usize = 100;

impl Stage {
    /// Hundredths of the whole that are done before it, and with it.
    fn share(self) -> (usize, usize) {
        match self {
            Stage::Screening => (0, 40),
            Stage::Fitting => (40, 80),
            Stage::Settling => (80, TOTAL),
        }
    }

    /// For people.
    fn name(self) -> &'static str {
        match self {
            Stage::Screening => "zeros, signs and rough values",
            Stage::Fitting => "friction, masses and drives",
            Stage::Settling => "what the log determines",
        }
    }
}

/// The course of an estimate: its steps, which are told to who listens, and its end.
pub(super) struct Course<'a> {
    pub halt: Halt,
    /// The stage, and how many of its steps are done.
    steps: Mutex<(Stage, usize)>,
    heard: &'a (dyn Fn(Progress) + Sync),
}

impl<'a> Course<'a> {
    /// One that begins now.
    pub fn new(stop: &StopSwitch, heard: &'a (dyn Fn(Progress) + Sync)) -> Self {
        let course = Course {
            halt: Halt::by(stop),
            steps: Mutex::new((Stage::Screening, 0)),
            heard,
        };
        course.begin(Stage::Screening);
        course
    }

    /// A stage begins.
    pub fn begin(&self, stage: Stage) {
        let mut steps = self.steps.lock().unwrap_or_else(PoisonError::into_inner);
        *steps = (stage, 0);
        self.tell(stage, stage.share().0);
    }

    /// One more of `count` steps of a stage is done.
    pub fn step(&self, stage: Stage, count: usize) {
        let mut steps = self.steps.lock().unwrap_or_else(PoisonError::into_inner);
        let before = if steps.0 == stage { steps.1 } else { 0 };
        *steps = (stage, before + 1);
        let (from, to) = stage.share();
        // Under the lock: what is heard never falls, whichever thread tells it.
        self.tell(
            stage,
            from + (to - from) * (before + 1).min(count) / count.max(1),
        );
    }

    fn tell(&self, stage: Stage, done: usize) {
        (self.heard)(Progress {
            done,
            total: TOTAL,
            what: stage.name().into(),
            best: None,
            left_s: None,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_never_falls_and_an_abandoned_estimate_ends_at_its_next_run() {
        let told = Mutex::new(Vec::new());
        let heard = |progress: Progress| told.lock().unwrap().push(progress.done);
        let stop = StopSwitch::default();
        let course = Course::new(&stop, &heard);
        (0..5).for_each(|_| course.step(Stage::Screening, 5));
        (0..2).for_each(|_| course.step(Stage::Fitting, 2));
        course.begin(Stage::Settling);
        course.halt.begin_run();
        let told = told.lock().unwrap().clone();
        assert_eq!(told, [0, 8, 16, 24, 32, 40, 60, 80, 80]);
        stop.abandon();
        let unwound = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            course.halt.begin_run();
        }));
        assert!(unwound.unwrap_err().is::<crate::fitting::Abandoned>());
    }
}
