//! Bringing data: logs, examples, models, columns.

use super::arrays::Arrays;
use super::shown_model::ShownModel;
use super::{act, blocking, said_shortly, session};
use crate::error::{Error, Place};
use crate::log::RawLog;
use crate::model::edit::{ColumnChoice, set_log_columns};
use crate::pages::data as pages;
use crate::reply::{Answer, LabError, data as reply, page};
use crate::server::LabState;
use crate::session::{EXAMPLES, LabSession, LogPart, MOST_BYTES, SavedStep, SessionFile, is_model};
use axum::Json;
use axum::body::{Body, to_bytes};
use axum::extract::{Path, Query, State};
use axum::http::{HeaderMap, header};
use serde::Deserialize;
use serde_json::{Value, json};
use std::sync::Arc;

/// The page.
pub(super) async fn show(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || Ok(page(pages::page(&session)?))).await
}

/// What the check finds.
pub(super) async fn findings(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || {
        let found = session.findings(&session.view())?;
        Ok(page(pages::findings(&session, &found)))
    })
    .await
}

#[derive(Debug, Deserialize)]
pub(super) struct Upload {
    name: String,
}

/// Takes a log.
pub(super) async fn upload(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Query(upload): Query<Upload>,
    headers: HeaderMap,
    body: Body,
) -> Answer {
    let session = session(&lab, number)?;
    let too_large = || {
        let most = MOST_BYTES >> 20;
        LabError::TooLarge(format!(
            "a log may have up to {most} MiB; cut it, or use the command line"
        ))
    };
    let announced = headers.get(header::CONTENT_LENGTH);
    let announced = announced.and_then(|length| length.to_str().ok()?.parse::<u64>().ok());
    if announced.is_some_and(|length| length > MOST_BYTES as u64) {
        return Err(too_large());
    }
    let bytes = to_bytes(body, MOST_BYTES).await.map_err(|_| too_large())?;
    blocking(move || {
        let taken = take(&lab, &session, &upload.name, &bytes);
        taken.map_err(|error| said_shortly(&session, error))
    })
    .await
    .map(|taken| reply(&taken))
}

/// Takes a file for what it is: a session, a model, or else a log.
fn take(lab: &LabState, session: &LabSession, name: &str, bytes: &[u8]) -> Result<Value, Error> {
    let number = session.number;
    let path = std::path::Path::new(name);
    if SessionFile::is_meant(name, bytes) {
        let file = SessionFile::read(name, bytes)?;
        let new = lab.store.add(|session| session.fill_from(file))?;
        return Ok(json!({ "go": format!("/s/{}/data", new.number), "session": new.number }));
    }
    let mut go = json!({ "go": format!("/s/{number}/data") });
    if is_model(path) {
        let text = std::str::from_utf8(bytes).map_err(|_| {
            let place = Place::file(path);
            Error::data(place, "this is no text", "save it as UTF-8")
        })?;
        session.bring_model(path, text)?;
        go["model"] = json!(name);
    } else {
        go["file"] = json!(session.add_log(name, bytes)?);
    }
    Ok(go)
}

#[derive(Debug, Deserialize)]
pub(super) struct ChosenExample {
    example: String,
}

/// Brings an example.
pub(super) async fn example(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(chosen): Json<ChosenExample>,
) -> Answer {
    act(lab, number, "compare", move |session, _| {
        let mut examples = EXAMPLES.iter();
        let example = examples.find(|example| example.id == chosen.example);
        Ok(session.bring_example(example.ok_or(LabError::NotFound("example"))?)?)
    })
    .await
}

#[derive(Debug, Deserialize)]
pub(super) struct LogAction {
    file: String,
    action: LogVerb,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum LogVerb {
    HoldOut,
    Fit,
    Remove,
}

/// Changes what a log is for.
pub(super) async fn log(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(asked): Json<LogAction>,
) -> Answer {
    act(lab, number, "data", move |session, _| {
        match asked.action {
            LogVerb::HoldOut => session.hold_out(&asked.file, true),
            LogVerb::Fit => session.hold_out(&asked.file, false),
            LogVerb::Remove => session.remove_log(&asked.file),
        }?;
        Ok(())
    })
    .await
}

#[derive(Debug, Deserialize)]
pub(super) struct Division {
    file: String,
    parts: Vec<LogPart>,
}

/// Divides a file into parts: rows that are used, and what they are for.
pub(super) async fn divide(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(asked): Json<Division>,
) -> Answer {
    act(lab, number, "data", move |session, saved| {
        // Only files of the session have names here; nothing is looked up by path.
        let known = saved.logs.iter().any(|log| log.file == asked.file);
        if !known {
            return Err(LabError::NotFound("log"));
        }
        Ok(session.divide_log(&asked.file, &asked.parts)?)
    })
    .await
}

#[derive(Debug, Deserialize)]
pub(super) struct ModelText {
    toml: String,
}

/// Takes a model's text: as the first step, or as the next one.
pub(super) async fn model(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
    Json(text): Json<ModelText>,
) -> Answer {
    act(lab, number, "data", move |session, saved| {
        shown.check(saved)?;
        Ok(session.write_model(&text.toml)?)
    })
    .await
}

/// Picks columns, units, signs and zeros for the model in force.
pub(super) async fn columns(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
    Json(choice): Json<ColumnChoice>,
) -> Answer {
    act(lab, number, "data", move |session, saved| {
        shown.check(saved)?;
        let step = saved.step().ok_or(LabError::NotFound("model"))?;
        let toml = set_log_columns(&step.toml, &session.model_path(saved.current), &choice)?;
        Ok(session.push_step(SavedStep::by_hand("columns picked", toml))?)
    })
    .await
}

#[derive(Debug, Deserialize)]
pub(super) struct RawAsked {
    file: String,
}

/// A log's columns as they stand in the file.
pub(super) async fn raw(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Query(asked): Query<RawAsked>,
) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || {
        // Only files of the session have names here; nothing is looked up by path.
        let saved = session.saved();
        let log = saved.logs.iter().find(|log| log.file == asked.file);
        let log = log.ok_or(LabError::NotFound("log"))?;
        let raw = RawLog::read(&session.log_path(&log.file))?;
        let rows = raw.columns.first().map_or(0, Vec::len);
        let time = raw.time();
        let mut arrays = Arrays::default();
        match time {
            // Four bytes tell no milliseconds of a time that counts from 1970.
            Some(time) => {
                let values = &raw.columns[time];
                let first = values.first().copied().filter(|first| first.abs() > 1e5);
                let begin = first.unwrap_or(0.0);
                arrays.push("time", values.iter().map(|value| value - begin));
            }
            None => arrays.push("time", (0..rows).map(|row| row as f64)),
        }
        for (index, column) in raw.columns.iter().enumerate() {
            arrays.push(format!("column_{index}"), column.iter().copied());
        }
        let time_name = time.map_or("row", |time| raw.names[time].as_str());
        let parts = saved.logs.iter().filter(|log| log.file == asked.file);
        let parts = parts.map(|log| json!({ "rows": log.rows, "held_out": log.held_out }));
        Ok(arrays.reply(&json!({
            "names": raw.names, "time": time, "time_name": time_name,
            "parts": parts.collect::<Vec<_>>(),
        })))
    })
    .await
}
