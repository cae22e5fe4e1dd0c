//! What a person takes along: the model, the report, the session.

use super::{blocking, session};
use crate::lab::reply::{Answer, LabError, download as file};
use crate::lab::server::LabState;
use crate::lab::session::{SavedSession, Session};
use crate::log::Motion;
use crate::output::number::hex;
use crate::report::{LogFile, ModelFile, Report, ReportProvenance, html};
use axum::extract::{Path, State};
use sha2::{Digest as _, Sha256};
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
fn report(session: &Session, saved: &SavedSession) -> Result<String, LabError> {
    let mut comparisons = Vec::new();
    let mut model_files = Vec::new();
    let mut logs = Vec::new();
    for step in 0..=saved.current {
        let evaluation = session.evaluation(saved, step)?;
        let evaluation = evaluation.ok_or(LabError::NotFound("comparison"))?;
        comparisons.push(evaluation.comparison().clone());
        model_files.push(ModelFile {
            name: format!("model-{step}.toml"),
            sha256: hex(Sha256::digest(&saved.steps[step].toml)),
        });
        let motions = evaluation.run.data.motions.iter().enumerate();
        logs = motions
            .map(|(i, motion)| log_file(motion, evaluation.is_held_out(i)))
            .collect();
    }
    Ok(html(&Report {
        title: format!("{} against measured motions", comparisons[0].model),
        comparisons,
        diagnosis: None,
        provenance: ReportProvenance {
            program_version: env!("CARGO_PKG_VERSION").to_string(),
            model_files,
            logs,
            command: saved.compare_command(),
        },
    }))
}

fn log_file(motion: &Motion, held_out: bool) -> LogFile {
    LogFile {
        name: motion.name.clone(),
        sha256: motion.source.sha256.clone(),
        samples: motion.len(),
        held_out,
    }
}
