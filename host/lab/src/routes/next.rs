//! The next experiment, as `handstand next` proposes it, as work in the background.

use super::learn::begin;
use super::shown_model::ShownModel;
use crate::reply::Answer;
use crate::server::LabState;
use crate::session::LabSession;
use axum::extract::{Path, State};
use std::sync::Arc;

/// Begins to look for it.
pub(super) async fn propose(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
) -> Answer {
    begin(&lab, number, &shown, "next experiment", LabSession::propose)
}
