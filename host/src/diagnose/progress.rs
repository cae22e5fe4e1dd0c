//! How far a diagnosis has come, in steps of about the same length.

use crate::fitting::Progress;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What is done, one after the other.
const STAGES: [&str; 5] = [
    "the model as it is",
    "every effect alone",
    "pairs and swaps",
    "larger sets",
    "residual structure",
];
/// The stage of sets of one effect; the stage of pairs is 2.
pub(super) const ALONE: usize = 1;
/// The stage of three effects and more.
pub(super) const LARGER: usize = 3;
/// The stage of the residual structure.
pub(super) const STRUCTURE: usize = 4;

/// Counts the fits of a diagnosis, which run side by side, and tells who listens.
pub(super) struct StepCounter<'a> {
    heard: &'a (dyn Fn(Progress) + Sync),
    done: AtomicUsize,
    stage: AtomicUsize,
    again: bool,
    total: usize,
}

impl<'a> StepCounter<'a> {
    /// None done yet of `total`, in the first search or again.
    pub fn new(total: usize, again: bool, heard: &'a (dyn Fn(Progress) + Sync)) -> Self {
        let steps = StepCounter {
            heard,
            done: AtomicUsize::new(0),
            stage: AtomicUsize::new(0),
            again,
            total,
        };
        steps.step(0);
        steps
    }

    /// `count` more steps are done.
    pub fn step(&self, count: usize) {
        let done = self.done.fetch_add(count, Ordering::Relaxed) + count;
        let stage = self.stage.load(Ordering::Relaxed);
        let what = STAGES[stage.min(STAGES.len() - 1)];
        (self.heard)(Progress {
            done: done.min(self.total),
            total: self.total,
            what: match self.again {
                true => format!("second search: {what}").into(),
                false => what.into(),
            },
        });
    }

    /// A stage begins, with `done` steps done or found to be needless.
    pub fn begin(&self, stage: usize, done: usize) {
        self.stage.store(stage, Ordering::Relaxed);
        self.done.store(done, Ordering::Relaxed);
        self.step(0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn steps_never_pass_the_total() {
        let told = Mutex::new(Vec::new());
        let heard = |progress: Progress| {
            let what = progress.what.to_string();
            told.lock().unwrap().push((progress.done, what));
        };
        let steps = StepCounter::new(4, false, &heard);
        steps.step(3);
        steps.step(3);
        steps.begin(STRUCTURE, 4);
        let told = told.lock().unwrap();
        let told: Vec<(usize, &str)> = told.iter().map(|(done, what)| (*done, &**what)).collect();
        let [model, structure] = [STAGES[0], STAGES[STRUCTURE]];
        assert_eq!(told, [(0, model), (3, model), (4, model), (4, structure)]);
    }
}
