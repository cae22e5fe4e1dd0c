//! What a person takes along: the model, the report, the next motion, the session.

use super::{blocking, session};
use crate::model::JointNames;
use crate::motion::Split;
use crate::pages::report as pages;
use crate::reply::{Answer, LabError, download as file};
use crate::report::{HashedModel, Report, ReportProvenance, html_with};
use crate::server::LabState;
use crate::session::{LabSession, MOTION_FILE, SavedSession};
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
                let page = report(&session, &session.view())?;
                Ok(file("text/html; charset=utf-8", "report.html", page))
            }
            MOTION_FILE => {
                let view = session.view();
                let motion = view.proposal().and_then(|found| found.motion_csv.clone());
                let motion = motion.ok_or(LabError::NotFound("motion"))?;
                Ok(file("text/csv; charset=utf-8", MOTION_FILE, motion))
            }
            "session.json" => {
                let text = serde_json::to_string_pretty(&session.to_file(saved));
                Ok(file(
                    "application/json",
                    "session.json",
                    text.unwrap_or_default(),
                ))
            }
            _ => Err(LabError::NotFound("file")),
        }
    })
    .await
}

/// The page that `handstand compare --report` writes of the steps up to the present one, titled by
/// the diagnosis, with the values that were fitted and what a person wrote down.
fn report(session: &LabSession, saved: &SavedSession) -> Result<String, LabError> {
    let mut comparisons = Vec::new();
    let mut model_files = Vec::new();
    let mut split = Split::default();
    let mut names = JointNames::default();
    for step in 0..=saved.current {
        let evaluation = session.evaluation(saved, step)?;
        let evaluation = evaluation.ok_or(LabError::NotFound("comparison"))?;
        comparisons.push(evaluation.comparison().clone());
        names = JointNames::of(&evaluation.run.model);
        let text = saved.steps[step].toml.as_bytes();
        model_files.push(HashedModel::of(format!("model-{step}.toml"), text));
        split = Split::default();
        for (index, motion) in evaluation.run.data.motions.iter().enumerate() {
            let side = if evaluation.is_held_out(index) {
                &mut split.held_out
            } else {
                &mut split.training
            };
            side.push(motion.clone());
        }
    }
    let report = Report {
        title: pages::title(saved),
        comparisons,
        diagnosis: None,
        provenance: ReportProvenance::new(model_files, &split, saved.compare_command()),
        names,
    };
    Ok(html_with(&report, pages::sections(saved)))
}
