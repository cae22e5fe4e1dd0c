//! Requests, one file per page; work that computes runs beside the server's own threads.

mod arrays;
mod challenge;
mod compare;
mod data;
mod download;
mod enter;
mod gains;
mod learn;
mod live;
mod new_model;
mod next;
mod robot;
mod shown_model;
mod what_if;

use super::assets::asset;
use super::reply::{Answer, LabError, data as reply};
use super::server::LabState;
use super::session::{LabSession, SavedSession};
use crate::error::Error;
use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::routing::{get, post};
use serde_json::json;
use std::sync::Arc;

/// Most bytes of a request that is no log.
const MOST_FORM_BYTES: usize = 1 << 20;

/// Every address.
pub(super) fn all() -> Router<Arc<LabState>> {
    Router::new()
        .route("/enter", get(enter::enter))
        .route("/", get(enter::home))
        .route("/sessions", get(enter::sessions).post(enter::begin))
        .route("/sessions/delete", post(enter::delete))
        .route("/assets/{name}", get(asset))
        .route("/s/{number}/name", post(enter::name))
        .route("/s/{number}/data", get(data::show))
        .route("/s/{number}/findings", get(data::findings))
        .route("/s/{number}/upload", post(data::upload))
        .route("/s/{number}/example", post(data::example))
        .route("/s/{number}/log", post(data::log))
        .route("/s/{number}/divide", post(data::divide))
        .route("/s/{number}/model", post(data::model))
        .route("/s/{number}/new-model", post(new_model::make))
        .route("/s/{number}/model-from-log", post(new_model::make_from_log))
        .route("/s/{number}/columns", post(data::columns))
        .route("/s/{number}/raw", get(data::raw))
        .route("/s/{number}/compare", get(compare::show))
        .route("/s/{number}/error", get(compare::error))
        .route("/s/{number}/horizons", get(compare::horizons))
        .route("/s/{number}/curves", get(compare::curves))
        .route("/s/{number}/scatter", get(compare::scatter))
        .route("/s/{number}/horizon", post(compare::horizon))
        .route("/s/{number}/learn", get(learn::show))
        .route("/s/{number}/diagnose", post(learn::diagnose))
        .route("/s/{number}/discover", post(learn::discover))
        .route("/s/{number}/add", post(learn::add))
        .route("/s/{number}/fit", post(learn::fit))
        .route("/s/{number}/next", post(next::propose))
        .route("/s/{number}/whole", get(learn::whole))
        .route("/s/{number}/stop", post(learn::stop))
        .route("/s/{number}/accept", post(learn::accept))
        .route("/s/{number}/progress", get(learn::progress))
        .route("/s/{number}/step", post(learn::step))
        .route("/s/{number}/note", post(learn::note))
        .route("/s/{number}/download/{what}", get(download::download))
        .route("/s/{number}/what-if", get(what_if::show).post(what_if::run))
        .route("/s/{number}/keep", post(what_if::keep))
        .route("/s/{number}/robot", get(robot::show))
        .route("/s/{number}/stage", get(robot::stage))
        .route("/s/{number}/live", get(live::events))
        .route("/s/{number}/live/begin", post(live::begin))
        .route("/s/{number}/live/answer", post(live::answer))
        .route("/s/{number}/live/here", post(live::here))
        .route("/s/{number}/live/stop", post(live::stop))
        .route("/s/{number}/gains", get(gains::show).post(gains::design))
        .route("/s/{number}/verified", post(gains::verified))
        .route("/s/{number}/gains-file/{what}", get(gains::file))
        .route("/s/{number}/challenge", get(challenge::show))
        .route("/s/{number}/round", post(challenge::begin))
        .route("/s/{number}/hand-in", post(challenge::hand_in))
        .fallback(nowhere)
        .layer(DefaultBodyLimit::max(MOST_FORM_BYTES))
}

/// What no address leads to.
async fn nowhere() -> LabError {
    LabError::NotFound("page")
}

/// A session by its number; from now on it is somebody's.
fn session(lab: &LabState, number: u32) -> Result<Arc<LabSession>, LabError> {
    let session = lab.store.get(number);
    session
        .inspect(|_| lab.store.take(number))
        .ok_or(LabError::NotFound("session"))
}

/// Runs what computes or reads files beside the threads that answer.
async fn blocking<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, LabError> + Send + 'static,
) -> Result<T, LabError> {
    match tokio::task::spawn_blocking(work).await {
        Ok(done) => done,
        Err(_) => Err(LabError::Library(Error::device(
            "this is a bug in the program, not in your files",
            "please report it",
        ))),
    }
}

/// Does something to a session, then says where to go on.
async fn act(
    lab: Arc<LabState>,
    number: u32,
    page: &'static str,
    action: impl FnOnce(&LabSession, &SavedSession) -> Result<(), LabError> + Send + 'static,
) -> Answer {
    act_and_go(lab, number, move |session, saved| {
        action(session, saved)?;
        Ok(page)
    })
    .await
}

/// Does something to a session that says on which page to go on.
async fn act_and_go(
    lab: Arc<LabState>,
    number: u32,
    action: impl FnOnce(&LabSession, &SavedSession) -> Result<&'static str, LabError> + Send + 'static,
) -> Answer {
    let session = session(&lab, number)?;
    let page = blocking(move || {
        let saved = session.saved();
        action(&session, &saved).map_err(|error| match error {
            LabError::Library(inner) => said_shortly(&session, inner),
            other => other,
        })
    })
    .await?;
    Ok(reply(&json!({ "go": format!("/s/{number}/{page}") })))
}

/// An error without the session's folder in its words.
fn said_shortly(session: &LabSession, error: Error) -> LabError {
    let words = session.shortened(&error.to_string());
    let remedy = error.remedy().unwrap_or_default().into_owned();
    LabError::Library(Error::usage(words, remedy))
}
