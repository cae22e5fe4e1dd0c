//! Long work of a session: one at a time, watched and stopped from any page.

use crate::error::Error;
use crate::fitting::{Abandoned, Progress, StopSwitch};
use serde::Serialize;
use std::sync::{Mutex, PoisonError};
use tokio::sync::watch;

/// How far the work has come.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "state", rename_all = "snake_case")]
pub enum JobState {
    /// Nothing was begun.
    Idle,
    /// It runs.
    Running {
        /// What is done at the moment.
        what: String,
        /// Steps done.
        done: usize,
        /// Steps in all, unless it ends early; 0 while that is not known.
        total: usize,
    },
    /// It came to its end.
    Done,
    /// It was stopped.
    Stopped,
    /// It came to no result.
    Failed {
        /// What was found.
        error: String,
        /// What to do about it.
        remedy: String,
    },
}

impl JobState {
    /// Whether the work goes on.
    pub fn is_running(&self) -> bool {
        matches!(self, JobState::Running { .. })
    }
}

/// The place of a session's work.
#[derive(Debug)]
pub struct JobSlot {
    state: watch::Sender<JobState>,
    stop: Mutex<StopSwitch>,
}

impl Default for JobSlot {
    fn default() -> Self {
        JobSlot {
            state: watch::Sender::new(JobState::Idle),
            stop: Mutex::default(),
        }
    }
}

/// Tells how far the work is, and ends it where that was asked.
#[derive(Debug, Clone)]
pub struct JobReport {
    state: watch::Sender<JobState>,
    stop: StopSwitch,
}

impl JobReport {
    /// Tells. Where the work is to stop it does not return: it unwinds, past searches that hold
    /// nothing which outlives them, to [`JobSlot::run`].
    pub fn tell(&self, what: &str, done: usize, total: usize) {
        if self.stop.is_abandoned() {
            std::panic::resume_unwind(Box::new(Abandoned));
        }
        self.state.send_replace(JobState::Running {
            what: what.to_string(),
            done,
            total,
        });
    }

    /// Tells what a fit or a diagnosis does.
    pub fn hear(&self, progress: Progress) {
        let best = progress.best.as_ref();
        let best = best.map_or(String::new(), |best| format!(" (best so far {best})"));
        let what = format!("{}{best}", progress.what);
        self.tell(&what, progress.done, progress.total);
    }

    /// What ends work that looks at it.
    pub fn stop_switch(&self) -> &StopSwitch {
        &self.stop
    }
}

impl JobSlot {
    /// The state, now and as it changes.
    pub fn watch(&self) -> watch::Receiver<JobState> {
        self.state.subscribe()
    }

    /// The state now.
    pub fn state(&self) -> JobState {
        self.state.borrow().clone()
    }

    /// Asks the work to stop.
    pub fn stop(&self) {
        let stop = self.stop.lock().unwrap_or_else(PoisonError::into_inner);
        stop.abandon();
    }

    /// Takes the place for work that [`JobSlot::run`] does; `None` while other work runs.
    pub fn begin(&self, what: &str) -> Option<JobReport> {
        let mut stop = self.stop.lock().unwrap_or_else(PoisonError::into_inner);
        let begun = self.state.send_if_modified(|state| {
            let free = !state.is_running();
            if free {
                *state = JobState::Running {
                    what: what.to_string(),
                    done: 0,
                    total: 0,
                };
            }
            free
        });
        begun.then(|| {
            *stop = StopSwitch::default();
            JobReport {
                state: self.state.clone(),
                stop: stop.clone(),
            }
        })
    }

    /// Does the work on threads of its own, so that pages are answered meanwhile.
    pub fn run(
        &self,
        report: &JobReport,
        work: impl FnOnce(&JobReport) -> Result<(), Error> + Send,
    ) {
        let on_own_threads = || match rayon::ThreadPoolBuilder::new().build() {
            Ok(pool) => pool.install(|| work(report)),
            Err(why) => Err(Error::device(
                format!("no threads for the work: {why}"),
                "close other programs",
            )),
        };
        // Nothing is shared with the work but what it reports.
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(on_own_threads));
        let end = match outcome {
            Ok(Ok(())) => JobState::Done,
            Ok(Err(error)) => JobState::Failed {
                error: error.to_string(),
                remedy: error.remedy().unwrap_or_default().into_owned(),
            },
            Err(thrown) if thrown.is::<Abandoned>() => JobState::Stopped,
            Err(_) => JobState::Failed {
                error: "this is a bug in the program, not in your files".into(),
                remedy: "please report it".into(),
            },
        };
        self.state.send_replace(end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_told_of_stopped_and_begun_again() {
        let slot = JobSlot::default();
        let report = slot.begin("first").unwrap();
        assert!(slot.begin("second").is_none(), "one at a time");
        slot.run(&report, |report| {
            report.tell("a", 1, 2);
            slot.stop();
            report.tell("b", 2, 2);
            unreachable!("it was stopped");
        });
        assert_eq!(slot.state(), JobState::Stopped);
        let report = slot.begin("again").unwrap();
        slot.run(&report, |report| {
            report.tell("c", 1, 1);
            Err(Error::usage("no", "mend it"))
        });
        let JobState::Failed { error, remedy } = slot.state() else {
            panic!("{:?}", slot.state());
        };
        assert_eq!([error, remedy], ["no", "mend it"]);
    }
}
