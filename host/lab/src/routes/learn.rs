//! Learning: the diagnosis and fits as work in the background, steps, notes.

use super::shown_model::ShownModel;
use super::{act, blocking, session};
use crate::error::Result;
use crate::pages::learn as pages;
use crate::reply::{Answer, LabError, data as reply, page};
use crate::server::LabState;
use crate::session::{ChosenBounds, Ending, JobReport, LabSession, aside, with_bounds};
use axum::Json;
use axum::extract::{Path, State};
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse as _, Response};
use serde::Deserialize;
use serde_json::json;
use std::convert::Infallible;
use std::sync::Arc;
use tokio_stream::StreamExt as _;
use tokio_stream::wrappers::WatchStream;

/// Longest note, characters.
const LONGEST_NOTE: usize = 4000;

/// The page.
pub(super) async fn show(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || Ok(page(pages::page(&session)?))).await
}

/// The errors of all steps over whole motions, which is how a model is used.
pub(super) async fn whole(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || Ok(page(aside(|| pages::whole(&session))))).await
}

/// Begins work that goes on after the answer, and shows on the same page.
pub(super) fn begin(
    lab: &LabState,
    number: u32,
    shown: &ShownModel,
    what: &str,
    work: impl FnOnce(&LabSession, &JobReport) -> Result<()> + Send + 'static,
) -> Answer {
    let work = |session: &LabSession, report: &JobReport| work(session, report).map(|()| None);
    begin_and_go(lab, number, shown, what, work)
}

/// Begins work that goes on after the answer, and says on which page it shows.
pub(super) fn begin_and_go(
    lab: &LabState,
    number: u32,
    shown: &ShownModel,
    what: &str,
    work: impl FnOnce(&LabSession, &JobReport) -> Result<Option<&'static str>> + Send + 'static,
) -> Answer {
    let session = session(lab, number)?;
    shown.check(&session.saved())?;
    let Some(report) = session.job.begin(what) else {
        return Err(LabError::Conflict(
            "something else is running: wait for its end, or stop it".into(),
        ));
    };
    tokio::task::spawn_blocking(move || {
        session.job.run(&report, |report| work(&session, report));
    });
    Ok(reply(&json!({ "begun": what })))
}

/// Begins a diagnosis.
pub(super) async fn diagnose(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
) -> Answer {
    begin(&lab, number, &shown, "diagnosis", LabSession::diagnose)
}

/// Begins to look for a law that the library lacks.
pub(super) async fn discover(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
) -> Answer {
    begin(
        &lab,
        number,
        &shown,
        "search for a law",
        LabSession::discover,
    )
}

#[derive(Debug, Deserialize)]
pub(super) struct EffectNames {
    /// Addresses between `+`.
    names: String,
    /// Bounds of values that are fitted.
    #[serde(default)]
    bounds: Vec<ChosenBounds>,
}

impl EffectNames {
    fn list(&self) -> Vec<String> {
        let names = self.names.split('+').map(str::trim);
        names
            .filter(|name| !name.is_empty())
            .map(String::from)
            .collect()
    }
}

/// Begins to add effects.
pub(super) async fn add(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
    Json(names): Json<EffectNames>,
) -> Answer {
    let list = names.list();
    begin(
        &lab,
        number,
        &shown,
        "fit of the effect",
        move |session, report| session.add_to_model(report, &list),
    )
}

/// Begins to fit values.
pub(super) async fn fit(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
    Json(names): Json<EffectNames>,
) -> Answer {
    let list = names.list();
    let saved = session(&lab, number)?.saved();
    // What is wrong with bounds is said beside them, before anything is fitted.
    if let (Some(step), false) = (saved.step(), names.bounds.is_empty()) {
        with_bounds(
            &step.toml,
            std::path::Path::new("model.toml"),
            &names.bounds,
        )?;
    }
    begin(
        &lab,
        number,
        &shown,
        "fit of the values",
        move |session, report| session.fit_values(report, &list, &names.bounds),
    )
}

/// Stops what runs: nothing of it is kept.
pub(super) async fn stop(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    session(&lab, number)?.job.end(Ending::Stopped);
    Ok(reply(&json!({ "stopping": true })))
}

/// Ends a diagnosis with its best so far, which is judged.
pub(super) async fn accept(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    session(&lab, number)?.job.end(Ending::Accepted);
    Ok(reply(&json!({ "accepted": true })))
}

/// Tells how far the work is, as events.
pub(super) async fn progress(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
) -> Result<Response, LabError> {
    let states = WatchStream::new(session(&lab, number)?.job.watch());
    let events = states.map(|state| {
        let text = serde_json::to_string(&state).unwrap_or_default();
        Ok::<_, Infallible>(Event::default().data(text))
    });
    Ok(Sse::new(events)
        .keep_alive(KeepAlive::default())
        .into_response())
}

#[derive(Debug, Deserialize)]
pub(super) struct StepChosen {
    step: usize,
}

/// Puts a step in force.
pub(super) async fn step(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
    Json(chosen): Json<StepChosen>,
) -> Answer {
    act(lab, number, "learn", move |session, saved| {
        shown.check(saved)?;
        Ok(session.go_to_step(chosen.step)?)
    })
    .await
}

#[derive(Debug, Deserialize)]
pub(super) struct Note {
    step: usize,
    note: String,
}

/// Writes a note to a step.
pub(super) async fn note(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(note): Json<Note>,
) -> Answer {
    act(lab, number, "learn", move |session, _| {
        let text: String = note.note.chars().take(LONGEST_NOTE).collect();
        Ok(session.note(note.step, &text)?)
    })
    .await
}
