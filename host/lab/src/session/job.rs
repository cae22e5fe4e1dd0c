//! Long work of a session: one at a time, watched and stopped from any page.

use super::names::{effect_name, listed, value_name};
use crate::error::Error;
use crate::fitting::{Abandoned, BestSoFar, Progress, StopSwitch};
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
        /// The best so far, of a diagnosis that has one.
        best: Option<JobBest>,
        /// At most so long it goes on, s, where that is known.
        left_s: Option<f64>,
        /// How it was told to end, where it was.
        ending: Option<Ending>,
    },
    /// It came to its end.
    Done {
        /// The page that shows what was made, where it is another one.
        page: Option<&'static str>,
    },
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

/// The best explanation that a diagnosis has found so far, as pages show it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JobBest {
    /// "Coulomb friction at joint 1 and transport delay".
    pub name: String,
    /// Error of the model as given, rad.
    pub before_rad: f64,
    /// Error with it, rad.
    pub error_rad: f64,
    /// What noise and resolution leave, rad.
    pub floor_rad: f64,
}

impl From<&BestSoFar> for JobBest {
    fn from(best: &BestSoFar) -> Self {
        // Values of the model stand there by their address: `link1.com_m`.
        let name = |address: &String| {
            if address.contains('.') {
                format!("another {}", value_name(address))
            } else {
                effect_name(address)
            }
        };
        JobBest {
            name: match best.names.as_slice() {
                [] => "the model as it is".into(),
                names => listed(names.iter().map(name).collect()),
            },
            before_rad: best.before_rad,
            error_rad: best.error_rad,
            floor_rad: best.floor_rad,
        }
    }
}

/// How running work was told to end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// What was found is enough: it is judged.
    Accepted,
    /// Nothing of it is wanted.
    Stopped,
}

impl JobState {
    /// Work that begins.
    fn begun(what: &str) -> JobState {
        JobState::Running {
            what: what.to_string(),
            done: 0,
            total: 0,
            best: None,
            left_s: None,
            ending: None,
        }
    }

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
    /// Tells what begins.
    pub fn tell(&self, what: &str) {
        self.put(JobState::begun(what));
    }

    /// Tells what a fit or a diagnosis does.
    pub fn hear(&self, progress: Progress) {
        self.put(JobState::Running {
            what: progress.what.to_string(),
            done: progress.done,
            total: progress.total,
            best: progress.best.as_ref().map(JobBest::from),
            left_s: progress.left_s,
            ending: self.stop.is_accepted().then_some(Ending::Accepted),
        });
    }

    /// Where the work is to stop it does not return: it unwinds, past searches that hold nothing
    /// which outlives them, to [`JobSlot::run`].
    fn put(&self, state: JobState) {
        if self.stop.is_abandoned() {
            std::panic::resume_unwind(Box::new(Abandoned));
        }
        self.state.send_replace(state);
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

    /// Tells the work how to end. Pages see at once that it was told.
    pub fn end(&self, how: Ending) {
        let stop = self.stop.lock().unwrap_or_else(PoisonError::into_inner);
        match how {
            Ending::Accepted => stop.accept(),
            Ending::Stopped => stop.abandon(),
        }
        self.state.send_if_modified(|state| match state {
            JobState::Running { ending, .. } => {
                *ending = Some(how);
                true
            }
            _ => false,
        });
    }

    /// Takes the place for work that [`JobSlot::run`] does; `None` while other work runs.
    pub fn begin(&self, what: &str) -> Option<JobReport> {
        let mut stop = self.stop.lock().unwrap_or_else(PoisonError::into_inner);
        let begun = self.state.send_if_modified(|state| {
            let free = !state.is_running();
            if free {
                *state = JobState::begun(what);
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

    /// Does the work on threads of its own, so that pages are answered meanwhile; it may say which
    /// page shows what it made.
    pub fn run(
        &self,
        report: &JobReport,
        work: impl FnOnce(&JobReport) -> Result<Option<&'static str>, Error> + Send,
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
            Ok(Ok(page)) => JobState::Done { page },
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
    use crate::model::MeasuredSignal;

    #[test]
    fn work_is_told_of_stopped_and_begun_again() {
        let slot = JobSlot::default();
        let report = slot.begin("first").unwrap();
        assert!(slot.begin("second").is_none(), "one at a time");
        slot.run(&report, |report| {
            report.tell("a");
            slot.end(Ending::Stopped);
            let JobState::Running { ending, .. } = slot.state() else {
                panic!("{:?}", slot.state());
            };
            assert_eq!(ending, Some(Ending::Stopped), "pages see it at once");
            report.tell("b");
            unreachable!("it was stopped");
        });
        assert_eq!(slot.state(), JobState::Stopped);
        let report = slot.begin("again").unwrap();
        slot.run(&report, |report| {
            report.tell("c");
            Err(Error::usage("no", "mend it"))
        });
        let JobState::Failed { error, remedy } = slot.state() else {
            panic!("{:?}", slot.state());
        };
        assert_eq!([error, remedy], ["no", "mend it"]);
    }

    #[test]
    fn the_best_so_far_is_told_in_words_and_taken() {
        let slot = JobSlot::default();
        let report = slot.begin("diagnosis").unwrap();
        let best = |names: &[&str]| BestSoFar {
            names: names.iter().map(|name| name.to_string()).collect(),
            before_rad: 0.04,
            error_rad: 0.002,
            floor_rad: 0.001,
            quantity: MeasuredSignal::Angle,
        };
        let hear = |names: &[&str]| {
            report.hear(Progress {
                done: 3,
                total: 10,
                what: "sets of two effects".into(),
                best: Some(best(names)),
                left_s: Some(12.0),
            });
            match slot.state() {
                JobState::Running { best, ending, .. } => (best.unwrap().name, ending),
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(hear(&[]), ("the model as it is".into(), None));
        let (name, _) = hear(&["coulomb@1", "link1.com_m"]);
        let words = "Coulomb friction at joint 1 and another centre of mass of link 1";
        assert_eq!(name, words);
        slot.end(Ending::Accepted);
        assert_eq!(hear(&["delay"]).1, Some(Ending::Accepted));
        slot.run(&report, |_| Ok(Some("compare")));
        assert_eq!(
            slot.state(),
            JobState::Done {
                page: Some("compare")
            }
        );
    }
}
