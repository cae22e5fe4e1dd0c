//! A model that comes as a file: one of this program's, or another simulator's.

use super::LabSession;
use super::job::JobReport;
use super::saved::{SavedSession, SavedStep};
use super::work::unchanged;
use crate::error::{Error, Result};
use crate::first_model::estimate;
use crate::log::init::Draft;
use crate::log::{LogRequest, RawLog};
use crate::model::Model;
use crate::model::import::{ImportPlan, Remark, import};
use std::path::Path;

/// Endings of files that a model is in.
pub const MODEL_ENDINGS: [&str; 3] = ["toml", "urdf", "xml"];

/// Whether a file of this name holds a model.
pub fn is_model(name: &Path) -> bool {
    let ending = name.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| {
        let mut known = MODEL_ENDINGS.iter();
        known.any(|own| ending.eq_ignore_ascii_case(own))
    })
}

/// The step that a model file makes; URDF and MJCF are imported as `handstand import` does, and
/// what is not carried becomes the step's note.
///
/// # Errors
/// A text that is no model.
pub fn model_step(name: &Path, text: &str) -> Result<SavedStep> {
    let file = name.file_name().unwrap_or(name.as_os_str());
    let file = file.to_string_lossy();
    let foreign = name.extension().is_some_and(|ending| {
        ending.eq_ignore_ascii_case("urdf") || ending.eq_ignore_ascii_case("xml")
    });
    if !foreign {
        Model::parse(text, name)?;
        return Ok(SavedStep::by_hand(format!("from {file}"), text));
    }
    let imported = import(text, name, &ImportPlan::default())?;
    let joints = imported.joints.join(", ");
    let title = format!("imported from {file}, joints {joints}");
    let note = imported.left_out.iter().map(not_carried);
    Ok(SavedStep {
        note: note.collect::<Vec<_>>().join("; "),
        ..SavedStep::by_hand(title, imported.toml)
    })
}

fn not_carried(part: &Remark) -> String {
    format!("not carried: {part}")
}

impl LabSession {
    /// What the first log that tells anything says of a model, as `handstand init` guesses it;
    /// `drive` is that of the joints, where it is known.
    pub fn draft(&self, saved: &SavedSession, drive: Option<&str>) -> Option<Draft> {
        self.drafted(saved, drive).map(|(draft, _)| draft)
    }

    /// The same with its guesses fitted to that log, as `handstand init` writes it.
    fn estimated(&self, saved: &SavedSession, report: &JobReport) -> Result<Draft> {
        let drafted = self.drafted(saved, None);
        let (mut draft, request) = drafted.ok_or_else(|| {
            Error::usage(
                "no log tells of joints",
                "bring a log with a column of time and one of angles",
            )
        })?;
        estimate(&mut draft, &request, report.stop_switch(), &|p| {
            report.hear(p);
        })?;
        Ok(draft)
    }

    /// Takes a model that is estimated from the first log as the first step.
    ///
    /// # Errors
    /// No log tells of joints; a session that was changed meanwhile.
    pub fn begin_estimated(&self, report: &JobReport) -> Result<()> {
        let begun = self.saved();
        let toml = self.estimated(&begun, report)?.toml()?;
        report.tell("the new model");
        unchanged(&self.saved(), &begun)?;
        self.begin_model("estimated from the log", &toml)
    }

    fn drafted(&self, saved: &SavedSession, drive: Option<&str>) -> Option<(Draft, LogRequest)> {
        saved.logs.iter().find_map(|log| {
            let request = LogRequest {
                path: self.log_path(&log.file),
                rows: log.rows,
            };
            let raw = RawLog::read_request(&request).ok()?;
            let draft = Draft::of(&raw, &log.file, drive).ok()?;
            Some((draft, request))
        })
    }

    /// Takes a model file: as the first step, or as the next one.
    ///
    /// # Errors
    /// A text that is no model, the system's refusal.
    pub fn bring_model(&self, name: &Path, text: &str) -> Result<()> {
        self.push_step(model_step(name, text)?)
    }
}
