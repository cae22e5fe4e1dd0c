//! The long work: diagnosing, adding effects, fitting values; each ends in what the session keeps.

use super::LabSession;
use super::card::SavedDiagnosis;
use super::evaluation::ShownUnit;
use super::job::JobReport;
use super::kept::DiagnosedFiles;
use super::names::{effect_name, listed, value_name};
use super::saved::{SavedSession, SavedStep, SavedValue};
use crate::diagnose::conventions::ModelFile;
use crate::diagnose::{DiagnoseOptions, Diagnosis, diagnose_logs};
use crate::discover::{MOST_TERMS, discover_logs};
use crate::error::{Error, Result};
use crate::fitting::{
    Addition, Refitted, Undetermined, add_effects, candidates_named, freed, refit, with_refitted,
};
use crate::model::edit::set_bounds;
use crate::model::{Model, ParameterPath};
use crate::report::{remedy_of, verdict_sentence};
use serde::Deserialize;
use std::path::Path;
use std::sync::PoisonError;

impl LabSession {
    /// Diagnoses the model in force.
    ///
    /// # Errors
    /// Logs that cannot be read; a session that was changed meanwhile.
    pub fn diagnose(&self, report: &JobReport) -> Result<()> {
        let begun = self.saved();
        let view = self.view_of(begun.clone());
        let (of, diagnosis) = self.diagnosis_of(report, &view)?;
        self.keep_diagnosis(&begun, of, &diagnosis)
    }

    /// The diagnosis of a view's model, and what it is of.
    pub(super) fn diagnosis_of(
        &self,
        report: &JobReport,
        view: &SavedSession,
    ) -> Result<(DiagnosedFiles, Diagnosis)> {
        let model = self.model_at(view)?;
        let options = DiagnoseOptions {
            stop: report.stop_switch().clone(),
            ..options(view)
        };
        let (path, logs) = (self.model_path(view.current), self.log_set(view));
        let file = ModelFile {
            path: &path,
            text: self.toml(view)?,
        };
        let found = diagnose_logs(&model, file, &logs, &options, &|p| report.hear(p))?;
        let of = view.files_of(view.current).ok_or_else(no_model)?;
        Ok((of, found.diagnosis))
    }

    /// Keeps what a diagnosis said.
    ///
    /// # Errors
    /// A session that was changed meanwhile.
    pub(super) fn keep_diagnosis(
        &self,
        begun: &SavedSession,
        of: DiagnosedFiles,
        diagnosis: &Diagnosis,
    ) -> Result<()> {
        let mut said = SavedDiagnosis::of(diagnosis, begun.current);
        if let Some(model) = self.model(begun)? {
            let shown = ShownUnit::of_errors(diagnosis.error.quantity, &model);
            said.tell_in(shown, diagnosis);
        }
        for line in said.summary.iter_mut().chain(&mut said.warnings) {
            *line = self.shortened(line);
        }
        // Commands are typed in the session's folder.
        for line in &mut said.next {
            *line = self.typed_here(line);
        }
        self.change(|saved| {
            unchanged(saved, begun)?;
            saved.keep_diagnosis(of.clone(), said);
            Ok(())
        })?;
        let known = self.diagnosed.lock();
        *known.unwrap_or_else(PoisonError::into_inner) = Some((of, diagnosis.clone()));
        Ok(())
    }

    /// Adds effects to the model in force, as a new step.
    ///
    /// # Errors
    /// Effects that the model has or cannot have, or that do not reduce its error.
    pub fn add_to_model(&self, report: &JobReport, names: &[String]) -> Result<()> {
        let begun = self.saved();
        let view = self.view_of(begun.clone());
        let model = self.model_at(&view)?;
        let candidates = candidates_named(names, &model)?;
        let (text, file) = (self.toml(&begun)?, self.model_path(begun.current));
        let split = self.log_set(&view).read(&model.log)?;
        let horizon = view.horizon();
        let added = add_effects(
            text,
            &file,
            &candidates,
            &split,
            Some(horizon),
            &|progress| report.hear(progress),
        )?;
        let (toml, values) = match added {
            Addition::Added { text, refitted } => (text, saved_values(&refitted)),
            Addition::Unhelpful(why) => return Err(Error::usage(why.why(names), why.remedy())),
            Addition::Undetermined(why) => return Err(undetermined(&why)),
        };
        self.keep_step(
            report,
            &begun,
            SavedStep {
                title: format!("{} added", listed(each(names, effect_name))),
                toml,
                command: Some(view.add_command(names)),
                note: String::new(),
                values,
                pictures: Vec::new(),
            },
        )
    }

    /// Fits values of the model in force to the logs, as a new step, within bounds that are written
    /// into the model; those it frees where none are named.
    ///
    /// # Errors
    /// Values that it has not, or that the motions do not determine; bounds that leave no room.
    pub fn fit_values(
        &self,
        report: &JobReport,
        values: &[String],
        bounds: &[ChosenBounds],
    ) -> Result<()> {
        let begun = self.saved();
        let view = self.view_of(begun.clone());
        self.model_at(&view)?;
        let file = self.model_path(begun.current);
        let text = with_bounds(self.toml(&begun)?, &file, bounds)?;
        let mut model = Model::parse(&text, &file)?;
        let named = named(values, &model);
        let free = freed(&mut model, named)?;
        let split = self.log_set(&view).read(&model.log)?;
        let horizon = Some(view.horizon());
        let refitted = refit(&model, &free, &split, horizon, &|p| report.hear(p))
            .map_err(|why| undetermined(&why))?;
        let toml = with_refitted(&text, &file, &model, &refitted, &split)?;
        let names: Vec<String> = free.iter().map(ToString::to_string).collect();
        self.keep_step(
            report,
            &begun,
            SavedStep {
                title: format!("{} fitted", listed(each(&names, value_name))),
                toml,
                command: Some(view.fit_command(named, bounds)),
                note: String::new(),
                values: saved_values(&refitted),
                pictures: Vec::new(),
            },
        )
    }

    /// Looks for a law that the library lacks, and adds it to the model in force as a new step.
    ///
    /// # Errors
    /// Logs that cannot be read or learned from; logs that ask for no such law.
    pub fn discover(&self, report: &JobReport) -> Result<()> {
        let begun = self.saved();
        let view = self.view_of(begun.clone());
        let model = self.model_at(&view)?;
        let options = DiagnoseOptions {
            stop: report.stop_switch().clone(),
            most_effects: MOST_TERMS,
            ..options(&view)
        };
        let (path, logs) = (self.model_path(view.current), self.log_set(&view));
        let text = self.toml(&view)?;
        let file = ModelFile { path: &path, text };
        let found = discover_logs(&model, file, &logs, &options, &|p| report.hear(p))?;
        let discovery = found.discovery;
        if !discovery.has_law() {
            return Err(Error::usage(
                verdict_sentence(&discovery),
                "bring a motion that shows more, or mend what the check of the logs says",
            ));
        }
        let horizon = view.window.by_hand();
        let hear = |progress| report.hear(progress);
        let added = discovery.added_to(text, &path, &found.split, horizon, &hear)?;
        let names = discovery.addresses();
        let (toml, refitted) = match added {
            Addition::Added { text, refitted } => (text, refitted),
            Addition::Unhelpful(why) => return Err(Error::usage(why.why(&names), why.remedy())),
            Addition::Undetermined(why) => return Err(undetermined(&why)),
        };
        let terms = discovery.terms.iter();
        let law = terms.map(|term| format!("{} = {}", term.site, term.with_values));
        self.keep_step(
            report,
            &begun,
            SavedStep {
                title: format!("law added: {}", listed(law.collect())),
                toml,
                command: Some(view.discover_command()),
                note: String::new(),
                values: saved_values(&refitted),
                pictures: discovery.pictures,
            },
        )
    }

    /// Keeps what a fit found, unless it was stopped meanwhile.
    fn keep_step(&self, report: &JobReport, begun: &SavedSession, step: SavedStep) -> Result<()> {
        report.tell("the new model");
        unchanged(&self.saved(), begun)?;
        self.push_step(step)
    }

    pub(super) fn model_at(&self, saved: &SavedSession) -> Result<Model> {
        let model = self.model(saved)?.filter(|_| !saved.logs.is_empty());
        model.ok_or_else(|| Error::usage("a model and a log are needed", "bring them first"))
    }

    fn toml<'a>(&self, saved: &'a SavedSession) -> Result<&'a str> {
        let step = saved.step().map(|step| step.toml.as_str());
        step.ok_or_else(no_model)
    }
}

/// How a view is diagnosed.
fn options(view: &SavedSession) -> DiagnoseOptions {
    DiagnoseOptions {
        horizon: view.window.by_hand(),
        ..DiagnoseOptions::default()
    }
}

pub(super) fn no_model() -> Error {
    Error::usage("there is no model", "bring one first")
}

/// Bounds of a value as a page gives them; an end that is left out is free.
#[derive(Debug, Clone, Deserialize)]
pub struct ChosenBounds {
    /// Its address.
    pub path: String,
    /// Lower bound.
    pub low: Option<f64>,
    /// Upper bound.
    pub high: Option<f64>,
}

impl ChosenBounds {
    /// Both ends; none where both are free.
    pub fn ends(&self) -> Option<(f64, f64)> {
        let (low, high) = (self.low, self.high);
        (low.is_some() || high.is_some()).then_some((
            low.unwrap_or(f64::NEG_INFINITY),
            high.unwrap_or(f64::INFINITY),
        ))
    }
}

/// The values to name in a fit of those that were chosen: none where they are what the model frees
/// and it knows something of them beforehand, which a name would take back.
fn named<'a>(values: &'a [String], model: &Model) -> &'a [String] {
    let is_chosen = |path: &ParameterPath| values.contains(&path.to_string());
    let is_own = values.len() == model.free.len() && model.free.iter().all(is_chosen);
    if is_own && !model.uncertain.is_empty() {
        &[]
    } else {
        values
    }
}

/// A model's text with these bounds.
///
/// # Errors
/// Values that it has not; bounds that leave no room, or that its value lies outside of.
pub fn with_bounds(text: &str, file: &Path, bounds: &[ChosenBounds]) -> Result<String> {
    let bounds = bounds.iter().map(|own| Ok((own.path.parse()?, own.ends())));
    match bounds.collect::<Result<Vec<_>>>()?.as_slice() {
        [] => Ok(text.to_string()),
        bounds => set_bounds(text, file, bounds),
    }
}

fn each(names: &[String], name: fn(&str) -> String) -> Vec<String> {
    names.iter().map(|each| name(each)).collect()
}

fn saved_values(refitted: &Refitted) -> Vec<SavedValue> {
    refitted.values.iter().map(SavedValue::from).collect()
}

fn undetermined(why: &Undetermined) -> Error {
    Error::usage(why.to_string(), remedy_of(why))
}

pub(super) fn unchanged(saved: &SavedSession, begun: &SavedSession) -> Result<()> {
    let key = |s: &SavedSession| (s.logs.clone(), s.current, s.step().cloned());
    if key(saved) == key(begun) {
        Ok(())
    } else {
        Err(Error::usage(
            "the model or the logs were changed meanwhile",
            "begin again: the result would be of what was there before",
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_model_frees_is_not_named_where_it_knows_something_of_it() {
        let text = "[rig]\nname = \"arm\"\nangle_zero = \"hanging\"\n\
                    [[link]]\ncom_m = 0.1\nmass_kg = 0.2\ninertia_kg_m2 = 1e-3\n\
                    [[joint]]\ndrive = \"passive\"\n\
                    [log]\ntime = { column = \"t\", unit = \"s\" }\n\
                    [[log.joint]]\nposition = { column = \"q\", unit = \"rad\" }\n";
        let stated = format!("{text}[uncertainty]\ntypical = true\n");
        let model = |text: &str| Model::parse(text, Path::new("arm.toml")).unwrap();
        let (exact, stated) = (model(text), model(&stated));
        let all: Vec<String> = stated.free.iter().map(ToString::to_string).collect();
        assert_eq!(all.len(), 3);
        assert!(named(&all, &stated).is_empty());
        assert_eq!(named(&all[1..], &stated), &all[1..]);
        assert_eq!(named(&all, &exact), all);
    }
}
