//! Work on a thread of its own, so that Python goes on: progress is told, Ctrl-C ends it.

use crate::errors::failed;
use handstand::fitting::{Abandoned, Progress, StopSwitch};
use pyo3::prelude::*;
use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// How long the interpreter waits before it looks for Ctrl-C.
const LOOK: Duration = Duration::from_millis(50);

/// Tells how far the work is, and ends it where that was asked.
pub struct WorkReport {
    steps: Sender<Progress>,
    stop: StopSwitch,
}

impl WorkReport {
    /// Tells. Where the work is to stop it does not return: it unwinds to the end of its thread.
    pub fn tell(&self, progress: Progress) {
        if self.stop.is_abandoned() {
            resume_unwind(Box::new(Abandoned));
        }
        // Who no longer listens has stopped the work.
        let _ = self.steps.send(progress);
    }

    /// What ends work that looks at it.
    pub fn stop_switch(&self) -> &StopSwitch {
        &self.stop
    }
}

/// Runs `work` without the interpreter's lock. `progress(what, done, total)` is called from this
/// thread. After Ctrl-C the work ends where it next tells how far it is, or looks at the switch.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&WorkReport) -> T + Send + 'static,
) -> PyResult<T> {
    let (steps, told) = channel();
    let stop = StopSwitch::default();
    let report = WorkReport {
        steps,
        stop: stop.clone(),
    };
    let thread = std::thread::spawn(move || {
        let report = report;
        work(&report)
    });
    let watched = watch(py, progress, told);
    if watched.is_err() {
        stop.abandon();
    }
    watched?;
    match py.detach(|| thread.join()) {
        Ok(result) => Ok(result),
        Err(_) => Err(failed(
            "the work ended in a fault of the program; what it printed says where",
        )),
    }
}

/// Until the work is done: tells its steps, and looks for Ctrl-C.
fn watch(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    told: Receiver<Progress>,
) -> PyResult<()> {
    // Only one thread may hold the receiving end: it moves in and out of the waiting.
    let mut told = told;
    loop {
        let (next, back) = py.detach(move || {
            let next = told.recv_timeout(LOOK);
            // Of several steps the last one says all.
            let last = told.try_iter().last();
            (next.map(|step| last.unwrap_or(step)), told)
        });
        told = back;
        match (next, progress) {
            (Ok(step), Some(progress)) => {
                progress.call1((step.what, step.done, step.total))?;
            }
            (Err(RecvTimeoutError::Disconnected), _) => return Ok(()),
            _ => {}
        }
        py.check_signals()?;
    }
}
