//! What a person takes along: the model, the report, the session.

use super::{blocking, session};
use crate::lab::reply::{Answer, LabError, download as file};
use crate::lab::server::LabState;
use crate::lab::session::{LabSession, SavedSession};
use crate::log::Split;
use crate::report::{HashedModel, Report, ReportProvenance, html};
use axum::extract::{Path, State};
use std::sync::Arc;

/// A file by what it is.
pub(super) async fn download(
    State(lab): State<Arc<LabState>>,
    Path((number, what)): Path<(u32, String)>,
) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || {
        let saved = session.saved();
        match what.as_str() {
            "model.toml" => {
                let step = saved.step().ok_or(LabError::NotFound("model"))?;
                Ok(file("application/toml", "model.toml", step.toml.clone()))
            }
            "report.html" => {
                let page = report(&session, &saved)?;
                Ok(file("text/html; charset=utf-8", "report.html", page))
            }
            "session.json" => {
                let text = serde_json::to_string_pretty(&saved).unwrap_or_default();
                Ok(file("application/json", "session.json", text))
            }
            _ => Err(LabError::NotFound("file")),
        }
    })
    .await
}

/// The page that `handstand compare --report` writes of the steps up to the present one.
fn report(session: &LabSession, saved: &SavedSession) -> Result<String, LabError> {
    let mut comparisons = Vec::new();
    let mut model_files = Vec::new();
    let mut split = Split::default();
    for step in 0..=saved.current {
        let evaluation = session.evaluation(saved, step)?;
        let evaluation = evaluation.ok_or(LabError::NotFound("comparison"))?;
        comparisons.push(evaluation.comparison().clone());
        let text = saved.steps[step].toml.as_bytes();
        model_files.push(HashedModel::of(format!("model-{step}.toml"), text));
        split = Split::default();
        for (index, motion) in evaluation.run.data.motions.iter().enumerate() {
            let side = match evaluation.is_held_out(index) {
                true => &mut split.held_out,
                false => &mut split.training,
            };
            side.push(motion.clone());
        }
    }
    Ok(html(&Report {
        title: format!("{} against measured motions", comparisons[0].model),
        comparisons,
        diagnosis: None,
        provenance: ReportProvenance::new(model_files, &split, saved.compare_command()),
    }))
}
