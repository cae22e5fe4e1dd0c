//! The robot that moves as the log says, the model's prediction over it.

use super::{blocking, session};
use crate::pages::robot as pages;
use crate::reply::{Answer, page};
use crate::server::LabState;
use axum::extract::{Path, State};
use std::sync::Arc;

/// The page.
pub(super) async fn show(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    let robot = lab.robot.clone();
    blocking(move || Ok(page(pages::page(&session, robot.as_deref())?))).await
}

/// The document in its frame.
pub(super) async fn stage(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || Ok(page(pages::stage_page(&session)?))).await
}
