//! How far the estimate of a first model has come, told from several threads.

use super::super::progress::Progress;
use super::values::STARTS;
use std::sync::{Mutex, PoisonError};

/// A fit to the end takes as long as so many short ones that tell a start's promise.
const FIT: usize = 6;

/// What was done of all there is to do, in short fits.
pub(super) struct Steps<'a> {
    done: Mutex<Done>,
    tell: &'a (dyn Fn(Progress) + Sync),
}

struct Done {
    steps: usize,
    total: usize,
}

impl<'a> Steps<'a> {
    /// A short fit from each start for so many meanings of the log, a fit of the best, and one more.
    pub fn new(meanings: usize, tell: &'a (dyn Fn(Progress) + Sync)) -> Self {
        let steps = Steps {
            done: Mutex::new(Done {
                steps: 0,
                total: meanings * STARTS + 2 * FIT,
            }),
            tell,
        };
        steps.go_on(0, 0, "starts of a first model");
        steps
    }

    /// One more start was looked at.
    pub fn screened(&self) {
        self.go_on(1, 0, "starts of a first model");
    }

    /// So many fits follow; one of them was foreseen.
    pub fn fits(&self, count: usize) {
        self.go_on(0, count.saturating_sub(1) * FIT, "first model");
    }

    /// One of them is done.
    pub fn fitted(&self) {
        self.go_on(FIT, 0, "first model");
    }

    /// Only what the log determines is left to be told.
    pub fn settling(&self) {
        self.go_on(0, 0, "what the log determines");
    }

    fn go_on(&self, steps: usize, more: usize, what: &'static str) {
        // Told under the lock, so that what is heard never falls.
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.steps += steps;
        done.total += more;
        (self.tell)(Progress {
            done: done.steps,
            total: done.total,
            what: what.into(),
            best: None,
            left_s: None,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_never_falls_nor_goes_beyond_its_end() {
        let heard = Mutex::new(Vec::new());
        let tell = |progress: Progress| heard.lock().unwrap().push((progress.done, progress.total));
        let steps = Steps::new(3, &tell);
        (0..3 * STARTS).for_each(|_| steps.screened());
        steps.fits(2);
        (0..2).for_each(|_| steps.fitted());
        steps.settling();
        let heard = heard.into_inner().unwrap();
        assert!(heard.windows(2).all(|pair| pair[1].0 >= pair[0].0));
        let (done, total) = heard[heard.len() - 1];
        // Settling is one fit.
        assert_eq!(done + FIT, total);
        assert_eq!(heard[0], (0, 3 * STARTS + 2 * FIT));
    }
}
