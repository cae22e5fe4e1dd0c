//! A model that comes as a file: one of this program's, or another simulator's.

use super::LabSession;
use super::job::JobReport;
use super::saved::{SavedSession, SavedStep};
use super::work::unchanged;
use crate::error::{Error, Result};
use crate::first_model::estimate;
use crate::log::init::{Draft, RobotDraft, RobotRequest};
use crate::log::{LogRequest, RawLog};
use crate::model::Model;
use crate::model::edit::set_robot_file;
use crate::model::import::{Imported, JointDrives, SpacePlan, import_whole, told};
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

/// Whether a file of this name is another simulator's: URDF or MJCF.
pub(super) fn is_robot(name: &Path) -> bool {
    name.extension().is_some_and(|ending| {
        ending.eq_ignore_ascii_case("urdf") || ending.eq_ignore_ascii_case("xml")
    })
}

/// Checks a model's file on its own: one of this program's, or another simulator's.
///
/// # Errors
/// A text that is no model.
pub(super) fn check_model(file: &Path, text: &str) -> Result<()> {
    if is_robot(file) {
        import_whole(text, file, JointDrives::OfFile, &SpacePlan::default()).map(drop)
    } else {
        Model::parse(text, file).map(drop)
    }
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

    /// The step that a model file makes, its robot's file copied into the session; `beside` is the
    /// folder it lies in, where there is one.
    ///
    /// URDF and MJCF are imported as `handstand import` does; a robot in space with the columns of
    /// the session's first log where its names are the joints', as `handstand init --robot` does.
    /// What is not carried becomes the step's note.
    ///
    /// # Errors
    /// A text that is no model, a robot's file that is not there, the system's refusal.
    pub(super) fn model_step(
        &self,
        name: &Path,
        text: &str,
        beside: Option<&Path>,
    ) -> Result<SavedStep> {
        let file = name.file_name().unwrap_or(name.as_os_str());
        let file = file.to_string_lossy();
        if !is_robot(name) {
            let toml = self.with_robot(name, text, beside)?;
            Model::parse(&toml, &self.folder().join(&*file))?;
            return Ok(SavedStep::by_hand(format!("from {file}"), toml));
        }
        let mut space = SpacePlan::default();
        let mut imported = import_whole(text, name, JointDrives::OfFile, &space)?;
        let mut note: Vec<String> = Vec::new();
        if imported.in_space {
            space.robot = match beside {
                Some(_) => self.keep_robot_from(name, text)?,
                None => self.keep_robot(&file, text)?,
            };
            imported.toml = set_robot_file(&imported.toml, name, &space.robot)?;
            match self.with_columns(name, text, &space) {
                Some(Ok(draft)) => {
                    let guesses = draft.guesses.iter();
                    note.extend(guesses.map(|own| format!("{}: {}", own.what, own.guess)));
                    imported = draft.imported;
                }
                Some(Err(why)) => note.push(format!("columns are yet to be picked: {why}")),
                None => {}
            }
        }
        let not_carried = told(&imported.left_out).into_iter();
        note.extend(not_carried.map(|part| format!("not carried: {part}")));
        Ok(SavedStep {
            note: note.join("; "),
            ..SavedStep::by_hand(imported_title(&file, &imported), imported.toml)
        })
    }

    /// A robot in space with the columns of the session's first log, or why that log's are not its
    /// joints'; none without a log.
    fn with_columns(
        &self,
        name: &Path,
        text: &str,
        space: &SpacePlan,
    ) -> Option<Result<RobotDraft>> {
        let saved = self.saved();
        let log = saved.logs.first()?;
        let raw = match RawLog::read(&self.log_path(&log.file)) {
            Ok(raw) => raw,
            Err(why) => return Some(Err(why)),
        };
        let request = RobotRequest {
            text,
            file: name,
            space,
            name: None,
            mapped: &[],
            calibration: None,
            unit: None,
            drive: None,
        };
        Some(RobotDraft::of(&raw, &log.file, &request))
    }

    /// Takes a model file that a browser sent: as the first step, or as the next one.
    ///
    /// # Errors
    /// As [`LabSession::model_step`].
    pub fn bring_model(&self, name: &Path, text: &str) -> Result<()> {
        self.push_step(self.model_step(name, text, None)?)
    }

    /// Takes a model's text that somebody pasted or edited: as the first step, or as the next one.
    ///
    /// # Errors
    /// A text that is no model, a robot's file that is not in the session.
    pub fn write_model(&self, text: &str) -> Result<()> {
        let toml = self.with_robot(Path::new("the text"), text, None)?;
        if self.saved().steps.is_empty() {
            return self.begin_model("as given", &toml);
        }
        self.push_step(SavedStep::by_hand("edited by hand", toml))
    }
}

fn imported_title(file: &str, imported: &Imported) -> String {
    let joints = imported.joints.join(", ");
    let shape = if imported.in_space { "in space, " } else { "" };
    format!("imported from {file}, {shape}joints {joints}")
}
