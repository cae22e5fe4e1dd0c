//! Bringing data: logs, examples, models, columns.

use super::arrays::Arrays;
use super::{act, blocking, said_shortly, session};
use crate::lab::pages::data as pages;
use crate::lab::reply::{Answer, LabError, data as reply, page};
use crate::lab::server::LabState;
use crate::lab::session::{EXAMPLES, LabSession, MOST_BYTES, SavedSession, SavedStep};
use crate::log::RawLog;
use crate::log::init::Draft;
use crate::model::edit::{ColumnChoice, set_log_columns};
use crate::model::new_model::{ModelPlan, new_model_toml};
use axum::Json;
use axum::body::{Body, to_bytes};
use axum::extract::{Path, Query, State};
use axum::http::{HeaderMap, header};
use serde::Deserialize;
use serde_json::json;
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
        let found = session.findings(&session.saved())?;
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
    let file = blocking(move || {
        let added = session.add_log(&upload.name, &bytes);
        added.map_err(|error| said_shortly(&session, error))
    })
    .await?;
    Ok(reply(
        &json!({ "go": format!("/s/{number}/data"), "file": file }),
    ))
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
pub(super) struct ModelText {
    toml: String,
}

/// Takes a model's text: as the first step, or as the next one.
pub(super) async fn model(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(text): Json<ModelText>,
) -> Answer {
    act(lab, number, "data", move |session, saved| {
        match saved.steps.is_empty() {
            true => session.begin_model("as given", &text.toml)?,
            false => session.push_step(by_hand("edited by hand", text.toml))?,
        }
        Ok(())
    })
    .await
}

/// Makes a model from a form.
pub(super) async fn new_model(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(plan): Json<ModelPlan>,
) -> Answer {
    act(lab, number, "data", move |session, saved| {
        let toml = match with_columns(session, saved, &plan) {
            Some(toml) => toml,
            None => new_model_toml(&plan)?,
        };
        Ok(session.begin_model("made from the form", &toml)?)
    })
    .await
}

/// The model of a form with the columns of the first log, where its names and values say which is
/// what.
fn with_columns(session: &LabSession, saved: &SavedSession, plan: &ModelPlan) -> Option<String> {
    let log = saved.logs.first()?;
    let raw = RawLog::read(&session.log_path(&log.file)).ok()?;
    let mut drives = plan.links.iter().map(|link| link.drive.as_str());
    let driven = drives.find(|drive| *drive != "passive");
    let draft = Draft::of(&raw, &log.file, driven).ok()?;
    let head = "# Written from a form, with the columns that a log seems to have: pick others \
                where they are wrong.\n\n";
    draft.toml_of(plan, head).ok()
}

/// Picks columns, units, signs and zeros for the model in force.
pub(super) async fn columns(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(choice): Json<ColumnChoice>,
) -> Answer {
    act(lab, number, "data", move |session, saved| {
        let step = saved.step().ok_or(LabError::NotFound("model"))?;
        let toml = set_log_columns(&step.toml, std::path::Path::new("model.toml"), &choice)?;
        Ok(session.push_step(by_hand("columns picked", toml))?)
    })
    .await
}

fn by_hand(title: &str, toml: String) -> SavedStep {
    SavedStep {
        title: title.into(),
        toml,
        command: None,
        note: String::new(),
    }
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
            Some(time) => arrays.push("time", raw.columns[time].iter().copied()),
            None => arrays.push("time", (0..rows).map(|row| row as f64)),
        }
        for (index, column) in raw.columns.iter().enumerate() {
            arrays.push(format!("column_{index}"), column.iter().copied());
        }
        let time_name = time.map_or("row", |time| raw.names[time].as_str());
        Ok(arrays.reply(&json!({ "names": raw.names, "time": time, "time_name": time_name })))
    })
    .await
}
