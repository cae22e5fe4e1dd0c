//! The place of the one run of the robot: its phase, who watches it, how it is stopped.

use super::access::RobotAccess;
use super::samples::{LiveChart, LiveSamples};
use crate::error::{Error, Result};
use crate::link::record::EmergencyOff;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tokio::sync::{broadcast, watch};

/// A page that has said nothing for so long is gone. It answers twice a second.
const GONE: Duration = Duration::from_secs(2);
/// Messages that a page may be behind before it misses some: 10 s.
const BEHIND: usize = 200;

/// How far a run has come.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[serde(tag = "phase", rename_all = "snake_case")]
pub enum LivePhase {
    /// Nothing was begun.
    #[default]
    Idle,
    /// Something is prepared; torque is off.
    Preparing {
        /// What.
        what: String,
    },
    /// It goes on when this is agreed to.
    Asking {
        /// The question.
        question: String,
    },
    /// Samples come.
    Running {
        /// `recording`, `torque in 2 s`, `balancing`.
        what: String,
        /// What the samples' values are.
        charts: Vec<LiveChart>,
    },
    /// It has ended; torque is off.
    Ended {
        /// How.
        said: String,
        /// The log that the session got.
        log: Option<String>,
    },
    /// It has failed; torque is off as far as the line allows.
    Failed {
        /// What was found.
        error: String,
        /// What to do about it.
        remedy: String,
    },
}

#[derive(Default)]
struct RunControl {
    running: bool,
    viewer: u64,
    stop: bool,
    at_once: bool,
    answer: Option<bool>,
    emergency_off: Option<EmergencyOff>,
    last_viewer: u64,
    viewers: BTreeMap<u64, Instant>,
}

/// The robot of a lab.
pub struct LiveRobot {
    /// How it is reached.
    pub access: RobotAccess,
    phase: watch::Sender<LivePhase>,
    samples: broadcast::Sender<Arc<LiveSamples>>,
    control: Mutex<RunControl>,
    changed: Condvar,
}

impl std::fmt::Debug for LiveRobot {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("LiveRobot").field(&self.access).finish()
    }
}

impl LiveRobot {
    /// The robot, at rest.
    pub fn new(access: RobotAccess) -> Self {
        LiveRobot {
            access,
            phase: watch::Sender::new(LivePhase::Idle),
            samples: broadcast::Sender::new(BEHIND),
            control: Mutex::default(),
            changed: Condvar::new(),
        }
    }

    /// The phase, now and as it changes.
    pub fn phase(&self) -> watch::Receiver<LivePhase> {
        self.phase.subscribe()
    }

    /// Tells pages the phase.
    pub fn tell(&self, phase: LivePhase) {
        self.phase.send_replace(phase);
    }

    /// Where samples are sent.
    pub fn samples(&self) -> &broadcast::Sender<Arc<LiveSamples>> {
        &self.samples
    }

    fn lock(&self) -> MutexGuard<'_, RunControl> {
        self.control.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The page of this number is there still.
    pub fn is_here(&self, viewer: u64) {
        if let Some(seen) = self.lock().viewers.get_mut(&viewer) {
            *seen = Instant::now();
        }
    }

    /// Takes the place for a run that the page of this number began; false where another run has
    /// it, or there is no such page.
    pub fn take(&self, viewer: u64) -> bool {
        let mut control = self.lock();
        let free = !control.running && control.viewers.contains_key(&viewer);
        if free {
            control.running = true;
            control.viewer = viewer;
            (control.stop, control.at_once, control.answer) = (false, false, None);
        }
        free
    }

    /// Gives the place back.
    pub fn leave(&self) {
        let mut control = self.lock();
        control.running = false;
        control.emergency_off = None;
        self.changed.notify_all();
    }

    /// What switches torque off from another thread while this run goes on.
    pub fn keep_emergency_off(&self, off: Option<EmergencyOff>) {
        self.lock().emergency_off = off;
    }

    /// Answers the question that is asked; only the page that began may.
    pub fn answer(&self, viewer: u64, yes: bool) -> bool {
        let mut control = self.lock();
        let may = control.running && control.viewer == viewer;
        if may {
            control.answer = Some(yes);
            self.changed.notify_all();
        }
        may
    }

    /// Stops the run: softly at first, at once when asked again.
    pub fn stop(&self) {
        let mut control = self.lock();
        if control.stop {
            control.at_once = true;
            if let Some(off) = control.emergency_off.take() {
                off();
            }
        }
        control.stop = true;
        self.changed.notify_all();
    }

    /// Stops the run, and waits until its robot has no torque; at once where that takes longer than
    /// `patience`.
    pub fn stop_for_good(&self, patience: Duration) {
        if !self.lock().running {
            return;
        }
        for _ in 0..2 {
            self.stop();
            let waits = self
                .changed
                .wait_timeout_while(self.lock(), patience, |c| c.running);
            if !waits.unwrap_or_else(PoisonError::into_inner).1.timed_out() {
                return;
            }
        }
    }

    /// Whether the run goes on: it was not stopped, and the page that began it is there.
    ///
    /// # Errors
    /// It was stopped at once.
    pub fn goes_on(&self) -> Result<bool> {
        let control = self.lock();
        if control.at_once {
            Err(Error::usage("stopped at once", "torque is off"))
        } else {
            Ok(!control.stop && control.is_watched())
        }
    }

    /// Asks the page that began; whether it agrees. A page that goes away, or a press on stop, says
    /// no.
    pub fn asks(&self, question: String) -> bool {
        self.lock().answer = None;
        self.tell(LivePhase::Asking { question });
        let mut control = self.lock();
        loop {
            if control.stop || !control.is_watched() {
                return false;
            }
            if let Some(answer) = control.answer.take() {
                return answer;
            }
            let soon = Duration::from_millis(200);
            let waited = self.changed.wait_timeout(control, soon);
            control = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

impl RunControl {
    fn is_watched(&self) -> bool {
        let seen = self.viewers.get(&self.viewer);
        seen.is_some_and(|seen| seen.elapsed() < GONE)
    }
}

/// A page that watches; it is gone when this is.
#[derive(Debug)]
pub struct Viewer {
    robot: Arc<LiveRobot>,
    /// Its number.
    pub number: u64,
}

impl Viewer {
    /// One more page.
    pub fn new(robot: Arc<LiveRobot>) -> Viewer {
        let number = {
            let mut control = robot.lock();
            control.last_viewer += 1;
            let number = control.last_viewer;
            control.viewers.insert(number, Instant::now());
            number
        };
        Viewer { robot, number }
    }
}

impl Drop for Viewer {
    fn drop(&mut self) {
        self.robot.lock().viewers.remove(&self.number);
        self.robot.changed.notify_all();
    }
}
