//! The robot at a port: what it does as events, and what it is told.

use super::session;
use crate::live::{self, LiveRobot, LiveTask, Viewer};
use crate::reply::{Answer, LabError, data as reply};
use crate::server::LabState;
use axum::Json;
use axum::extract::{Path, State};
use axum::response::sse::{Event, Sse};
use axum::response::{IntoResponse as _, Response};
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;
use tokio_stream::wrappers::{BroadcastStream, IntervalStream, WatchStream};
use tokio_stream::{Stream, StreamExt as _};

/// A page answers each of these: one that does not is gone.
const TICK: Duration = Duration::from_millis(500);

fn robot(lab: &LabState, number: u32) -> Result<Arc<LiveRobot>, LabError> {
    session(lab, number)?;
    lab.robot.clone().ok_or(LabError::NotFound("robot"))
}

/// Phases and samples, as events; while they are heard the page counts as one that watches.
pub(super) async fn events(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
) -> Result<Response, LabError> {
    let robot = robot(&lab, number)?;
    let viewer = Viewer::new(robot.clone());
    let hello = json!({ "viewer": viewer.number });
    let phases = WatchStream::new(robot.phase()).map(|phase| event("phase", &phase));
    // What a page is too slow for it does not get.
    let samples = BroadcastStream::new(robot.samples().subscribe())
        .filter_map(|samples| Some(event("samples", &*samples.ok()?)));
    let ticks = IntervalStream::new(tokio::time::interval(TICK)).map(|_| event("tick", &()));
    let all = tokio_stream::once(event("hello", &hello))
        .chain(phases.merge(samples).merge(ticks))
        .map(move |event| {
            // Moved in here, the page's place ends with the connection.
            let _ = &viewer;
            event
        });
    Ok(stream(all))
}

fn stream(events: impl Stream<Item = Result<Event, Infallible>> + Send + 'static) -> Response {
    Sse::new(events).into_response()
}

fn event(name: &str, value: &impl Serialize) -> Result<Event, Infallible> {
    let text = serde_json::to_string(value).unwrap_or_default();
    Ok(Event::default().event(name).data(text))
}

#[derive(Debug, Deserialize)]
pub(super) struct RunRequest {
    /// Number of the page that asks, as the first event says it.
    viewer: u64,
    task: LiveTask,
}

/// Begins a run; the page that asks has to stay.
pub(super) async fn begin(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(asked): Json<RunRequest>,
) -> Answer {
    let robot = robot(&lab, number)?;
    let session = session(&lab, number)?;
    if live::begin(&robot, session, asked.viewer, asked.task)? {
        Ok(reply(&json!({ "begun": true })))
    } else {
        Err(LabError::Conflict(
            "the robot is busy, or this page no longer hears of it: reload the page".into(),
        ))
    }
}

#[derive(Debug, Deserialize)]
pub(super) struct ConsentReply {
    viewer: u64,
    yes: bool,
}

/// Answers what was asked.
pub(super) async fn answer(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(said): Json<ConsentReply>,
) -> Answer {
    if robot(&lab, number)?.answer(said.viewer, said.yes) {
        Ok(reply(&json!({ "answered": said.yes })))
    } else {
        Err(LabError::Conflict(
            "only the page that began may answer".into(),
        ))
    }
}

#[derive(Debug, Deserialize)]
pub(super) struct Heartbeat {
    viewer: u64,
}

/// The page is there.
pub(super) async fn here(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(page): Json<Heartbeat>,
) -> Answer {
    robot(&lab, number)?.is_here(page.viewer);
    Ok(reply(&json!({})))
}

/// Lets the robot down; switches torque off at once when pressed again. Any page may.
pub(super) async fn stop(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let robot = robot(&lab, number)?;
    tokio::task::spawn_blocking(move || robot.stop());
    Ok(reply(&json!({ "stopping": true })))
}
