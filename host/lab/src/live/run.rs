//! A run: begun by a page, in a thread of its own, ended by its time, by anyone who presses stop,
//! or when the page is gone.

use super::slot::{LivePhase, LiveRobot};
use super::{balance, record};
use crate::error::{Error, Result};
use crate::session::LabSession;
use serde::Deserialize;
use std::sync::Arc;

/// What a page asks for.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(tag = "what", rename_all = "snake_case")]
pub enum LiveTask {
    /// Record, and move nothing.
    Record {
        /// How long, s; until stopped without.
        seconds: Option<f64>,
    },
    /// Balance the robot with a plan for the model in force, or the one on the CM-5 without.
    Balance {
        /// How long, s; until stopped without.
        seconds: Option<f64>,
        /// From the agreement until torque comes on, s.
        countdown_s: f64,
        /// Torque limit, a share of full torque.
        torque: f64,
    },
}

impl LiveTask {
    /// # Errors
    /// A time or share that is none.
    fn check(self) -> Result<()> {
        let within = |what: &str, value: f64, low: f64, high: f64| {
            if (low..=high).contains(&value) {
                Ok(())
            } else {
                Err(Error::usage(
                    format!("{what} {value} does not fit"),
                    format!("give {low} to {high}"),
                ))
            }
        };
        let (LiveTask::Record { seconds } | LiveTask::Balance { seconds, .. }) = self;
        within("a time of", seconds.unwrap_or(1.0), 0.01, 1e6)?;
        match self {
            LiveTask::Record { .. } => Ok(()),
            LiveTask::Balance {
                countdown_s,
                torque,
                ..
            } => {
                within("a countdown of", countdown_s, 0.0, 60.0)?;
                within("a torque limit of", torque, 0.01, 1.0)
            }
        }
    }
}

/// Begins a run for the page `viewer`; its recording becomes a log of the session. False where
/// another run goes on, or there is no such page.
///
/// # Errors
/// A task that cannot be done.
pub fn begin(
    robot: &Arc<LiveRobot>,
    session: Arc<LabSession>,
    viewer: u64,
    task: LiveTask,
) -> Result<bool> {
    task.check()?;
    if !robot.take(viewer) {
        return Ok(false);
    }
    let robot = robot.clone();
    std::thread::spawn(move || {
        // Whatever happens within, the place is free again.
        let run = std::panic::AssertUnwindSafe(|| run(&robot, &session, task));
        let end = match std::panic::catch_unwind(run) {
            Ok(Ok((said, log))) => LivePhase::Ended { said, log },
            Ok(Err(error)) => LivePhase::Failed {
                error: session.shortened(&error.to_string()),
                remedy: error.remedy().unwrap_or_default().into_owned(),
            },
            Err(_) => LivePhase::Failed {
                error: "this is a bug in the program, not in your robot".into(),
                remedy: "please report it".into(),
            },
        };
        robot.tell(end);
        robot.leave();
    });
    Ok(true)
}

/// The run, and how it ended; the log that the session got.
fn run(
    robot: &LiveRobot,
    session: &LabSession,
    task: LiveTask,
) -> Result<(String, Option<String>)> {
    robot.tell(LivePhase::Preparing {
        what: format!("opening {}", robot.access.port),
    });
    let saved = session.saved();
    let model = session.model(&saved)?;
    let (link, attitude) = (robot.access.open)()?;
    let (name, file) = session.vacant_log("robot.csv")?;
    let said = match task {
        LiveTask::Record { seconds } => record::run(robot, link, model.as_ref(), seconds, &file),
        LiveTask::Balance {
            seconds,
            countdown_s,
            torque,
        } => {
            let how = balance::supervision(seconds, countdown_s, torque);
            balance::run(robot, (link, attitude), model.as_ref(), how, &file)
        }
    };
    // What was recorded before a failure is worth having.
    let log = file
        .exists()
        .then(|| session.take_log(&name).map(|()| name));
    Ok((said?, log.transpose()?))
}
