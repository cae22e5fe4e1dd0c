//! The long work: diagnosing, adding effects, fitting values; each ends in what the session keeps.

use super::LabSession;
use super::card::SavedDiagnosis;
use super::data::model_file;
use super::job::JobReport;
use super::saved::{SavedSession, SavedStep};
use crate::diagnose::conventions::ModelFile;
use crate::diagnose::{DiagnoseOptions, diagnose_logs};
use crate::error::{Error, Result};
use crate::fitting::{
    Addition, Undetermined, add_effects, candidates_named, free_parameters, refit, with_refitted,
};
use crate::model::Model;

impl LabSession {
    /// Diagnoses the model in force.
    ///
    /// # Errors
    /// Logs that cannot be read; a session that was changed meanwhile.
    pub fn diagnose(&self, report: &JobReport) -> Result<()> {
        let begun = self.saved();
        let model = self.model_at(&begun)?;
        let options = DiagnoseOptions {
            horizon: begun.window.by_hand(),
            stop: report.stop_switch().clone(),
            ..DiagnoseOptions::default()
        };
        let (path, logs) = (model_file(begun.current), self.log_set(&begun));
        let file = ModelFile {
            path: &path,
            text: self.toml(&begun)?,
        };
        let found = diagnose_logs(&model, file, &logs, &options, &|p| report.hear(p))?;
        let mut said = SavedDiagnosis::of(&found.diagnosis, begun.current);
        for line in said.summary.iter_mut().chain(&mut said.warnings) {
            *line = self.shortened(line);
        }
        // Commands are typed in the session's folder.
        for line in &mut said.next {
            *line = line.replace(&format!("{}/", self.folder().display()), "");
        }
        self.change(|saved| {
            unchanged(saved, &begun)?;
            saved.diagnosis = Some(said);
            Ok(())
        })
    }

    /// Adds effects to the model in force, as a new step.
    ///
    /// # Errors
    /// Effects that the model has or cannot have, or that do not reduce its error.
    pub fn add_to_model(&self, report: &JobReport, names: &[String]) -> Result<()> {
        let begun = self.saved();
        let model = self.model_at(&begun)?;
        let candidates = candidates_named(names, &model)?;
        let (text, file) = (self.toml(&begun)?, model_file(begun.current));
        let split = self.log_set(&begun).read(&model.log)?;
        let horizon = begun.horizon();
        let added = add_effects(
            text,
            &file,
            &candidates,
            &split,
            Some(horizon),
            &|progress| report.hear(progress),
        )?;
        let toml = match added {
            Addition::Added { text, .. } => text,
            Addition::Unhelpful(why) => return Err(Error::usage(why.why(names), why.remedy())),
            Addition::Undetermined(why) => return Err(undetermined(&why)),
        };
        self.keep_step(
            &begun,
            SavedStep {
                title: format!("{} added", names.join(", ")),
                toml,
                command: Some(begun.add_command(names)),
                note: String::new(),
            },
        )
    }

    /// Fits values of the model in force to the logs, as a new step; those it frees where none are
    /// named.
    ///
    /// # Errors
    /// Values that it has not, or that the motions do not determine.
    pub fn fit_values(&self, report: &JobReport, values: &[String]) -> Result<()> {
        let begun = self.saved();
        let model = self.model_at(&begun)?;
        let free = free_parameters(&model, values)?;
        let split = self.log_set(&begun).read(&model.log)?;
        let horizon = Some(begun.horizon());
        let refitted = refit(&model, &free, &split, horizon, &|p| report.hear(p))
            .map_err(|why| undetermined(&why))?;
        let file = model_file(begun.current);
        let toml = with_refitted(self.toml(&begun)?, &file, &model, &refitted, &split)?;
        let names: Vec<String> = free.iter().map(ToString::to_string).collect();
        self.keep_step(
            &begun,
            SavedStep {
                title: format!("{} fitted", names.join(", ")),
                toml,
                command: Some(begun.fit_command(values)),
                note: String::new(),
            },
        )
    }

    fn keep_step(&self, begun: &SavedSession, step: SavedStep) -> Result<()> {
        unchanged(&self.saved(), begun)?;
        self.push_step(step)
    }

    fn model_at(&self, saved: &SavedSession) -> Result<Model> {
        let model = self.model(saved)?.filter(|_| !saved.logs.is_empty());
        model.ok_or_else(|| Error::usage("a model and a log are needed", "bring them first"))
    }

    fn toml<'a>(&self, saved: &'a SavedSession) -> Result<&'a str> {
        let step = saved.step().map(|step| step.toml.as_str());
        step.ok_or_else(|| Error::usage("there is no model", "bring one first"))
    }
}

fn undetermined(why: &Undetermined) -> Error {
    Error::usage(
        why.to_string(),
        "bring a motion that shows them, or free fewer values",
    )
}

fn unchanged(saved: &SavedSession, begun: &SavedSession) -> Result<()> {
    let key = |s: &SavedSession| (s.logs.clone(), s.current, s.step().cloned());
    match key(saved) == key(begun) {
        true => Ok(()),
        false => Err(Error::usage(
            "the model or the logs were changed meanwhile",
            "begin again: the result would be of what was there before",
        )),
    }
}
