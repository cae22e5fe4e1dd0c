//! Rounds: an arm with a hidden effect, in a session of its own.

use super::shown_model::ShownModel;
use super::{act, blocking, session};
use crate::pages::challenge as pages;
use crate::reply::{Answer, LabError, data as reply, page};
use crate::server::LabState;
use axum::Json;
use axum::extract::{Path, State};
use serde::Deserialize;
use serde_json::json;
use std::sync::Arc;

/// The page.
pub(super) async fn show(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || Ok(page(pages::page(&session, &lab.store)))).await
}

#[derive(Debug, Deserialize)]
pub(super) struct RoundAsked {
    /// Seed; a random one without.
    seed: Option<u64>,
}

/// Begins a round in a new session.
pub(super) async fn begin(
    State(lab): State<Arc<LabState>>,
    Path(_): Path<u32>,
    Json(asked): Json<RoundAsked>,
) -> Answer {
    let new = blocking(move || {
        let begin = |session: &crate::session::LabSession| session.begin_round(asked.seed);
        lab.store.add(begin).map_err(LabError::from)
    });
    let number = new.await?.number;
    Ok(reply(&json!({ "go": format!("/s/{number}/compare") })))
}

/// Hands in the model in force.
pub(super) async fn hand_in(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
) -> Answer {
    act(lab, number, "challenge", move |session, saved| {
        shown.check(saved)?;
        Ok(session.hand_in()?)
    })
    .await
}
