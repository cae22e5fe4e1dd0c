//! `diagnose`: which physical effect does the model lack?

use crate::errors::exception;
use crate::logs::{Learned, horizon, judging, learned_and_held_out};
use crate::model::Model;
use crate::value::{framed, plain};
use crate::work;
use handstand::compare::compare_all;
use handstand::diagnose::conventions::ModelFile;
use handstand::diagnose::{DiagnoseOptions, FittedEffect, LogDiagnosis, diagnose_logs};
use handstand::fitting::{Horizon, Progress, effect_ids, free_parameters};
use handstand::model::JointNames;
use handstand::motion::Split;
use handstand::report::{Report, ReportProvenance, diagnosis_json, diagnosis_text, html};
use pyo3::prelude::*;

/// A diagnosis: the verdict, what it rests on, and what to do next.
#[pyclass(frozen, module = "handstand")]
#[derive(Debug, Clone)]
pub struct Diagnosis {
    pub inner: handstand::diagnose::Diagnosis,
    model: Model,
    pub split: Split,
}

/// Diagnoses what a model lacks.
///
/// Parameters
/// ----------
/// model : Model
/// logs : file name, path, Motion, DataFrame, or a list of them
///     What is learned from. Files are first checked for wrong signs, zeros, units and drives.
/// holdout : as `logs`
///     What judges; without it the last third of the motions. What is learned from is refused.
/// without : list of str
///     Effects to leave out.
/// known : list of str
///     Addresses of values that were measured by themselves.
/// seed : int
///     Of the search's random starts.
/// tolerance_rad : float
///     A model whose error is below is good enough, rad.
/// horizon_s : float or "whole"
///     The longest that models run without correction, s.
/// trust_log : bool
///     Leave the check of files out.
/// within_s : float
///     The seconds that it may take: the best verdict of that time.
/// progress : callable
///     Called as `progress(what, done, total)`.
///
/// Returns
/// -------
/// Diagnosis
#[pyfunction]
#[pyo3(signature = (model, logs, *, holdout=None, without=Vec::new(), known=Vec::new(),
                    seed=None, tolerance_rad=None, horizon_s=None, trust_log=false,
                     within_s=None, progress=None, hold_out=None),
       text_signature = "(model, logs, *, holdout=None, without=..., known=..., seed=None, \
                         tolerance_rad=None, horizon_s=None, trust_log=False, within_s=None, \
                         progress=None)")]
#[expect(clippy::too_many_arguments, reason = "keywords of a Python function")]
pub fn diagnose(
    py: Python<'_>,
    model: &Bound<'_, Model>,
    logs: &Bound<'_, PyAny>,
    holdout: Option<&Bound<'_, PyAny>>,
    without: Vec<String>,
    known: Vec<String>,
    seed: Option<u64>,
    tolerance_rad: Option<f64>,
    horizon_s: Option<&Bound<'_, PyAny>>,
    trust_log: bool,
    within_s: Option<f64>,
    progress: Option<&Bound<'_, PyAny>>,
    hold_out: Option<&Bound<'_, PyAny>>,
) -> PyResult<Diagnosis> {
    let model = model.borrow().clone();
    let defaults = DiagnoseOptions::default();
    let options = DiagnoseOptions {
        seed: seed.unwrap_or(defaults.seed),
        without: effect_ids(&without).map_err(exception)?,
        known: match known.as_slice() {
            [] => Vec::new(),
            known => free_parameters(&model.inner, known).map_err(exception)?,
        },
        horizon: horizon(horizon_s)?,
        tolerance_rad,
        trust_log,
        within_s: within_s.map(seconds).transpose().map_err(exception)?,
        ..defaults
    };
    let logs = learned_and_held_out(logs, judging(py, holdout, hold_out)?, &model)?;
    let found = work::run(py, progress, move |report| {
        let options = DiagnoseOptions {
            stop: report.stop_switch().clone(),
            ..options
        };
        found(model, logs, &options, &|progress| report.tell(progress))
    })?;
    found.map_err(exception)
}

/// A limit of time, s.
pub fn seconds(within_s: f64) -> handstand::Result<f64> {
    if within_s > 0.0 && within_s <= 3.2e7 {
        Ok(within_s)
    } else {
        Err(handstand::Error::usage(
            format!("within_s = {within_s} is no time"),
            "give seconds above 0, or leave it out",
        ))
    }
}

/// Diagnoses logs that were read.
pub fn found(
    model: Model,
    logs: Learned,
    options: &DiagnoseOptions,
    tell: &(dyn Fn(Progress) + Sync),
) -> handstand::Result<Diagnosis> {
    let LogDiagnosis { diagnosis, split } = match logs {
        Learned::Files(set) => {
            let file = ModelFile {
                path: &model.path,
                text: &model.text,
            };
            diagnose_logs(&model.inner, file, &set, options, tell)?
        }
        Learned::Motions(training, held_out) => {
            if let Some(horizon) = options.horizon {
                horizon.check(&model.inner, training.iter().chain(&held_out))?;
            }
            let split = Split::told_apart(training, held_out)?;
            let split = handstand::motion::split(split.training, split.held_out);
            let (training, held_out) = (split.training.clone(), split.held_out.clone());
            let model = &model.inner;
            LogDiagnosis {
                diagnosis: handstand::diagnose::diagnose(model, training, held_out, options, tell),
                split,
            }
        }
    };
    Ok(Diagnosis {
        inner: diagnosis,
        model,
        split,
    })
}

#[pymethods]
impl Diagnosis {
    /// `nominal`, `adequate`, `wrong_value`, `named`, `ambiguous`, `unexplained` or `unfit`.
    #[getter]
    fn verdict(&self) -> &'static str {
        self.inner.verdict.name()
    }

    /// The effects of the best explanation, as `add` takes them.
    #[getter]
    fn effects(&self) -> Vec<String> {
        self.inner
            .effects
            .iter()
            .map(FittedEffect::address)
            .collect()
    }

    /// The answer in sentences.
    #[getter]
    fn summary(&self) -> Vec<String> {
        named(&self.inner.summary, &self.model)
    }

    /// What to be wary of.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        named(&self.inner.warnings, &self.model)
    }

    /// Everything, with the keys of `handstand diagnose --json`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &diagnosis_json(&self.inner))
    }

    /// The page of `handstand diagnose --report`.
    fn html(&self, py: Python<'_>) -> String {
        py.detach(|| html(&self.report()))
    }

    fn _repr_html_(&self, py: Python<'_>) -> String {
        framed(&self.html(py))
    }

    fn __str__(&self) -> String {
        diagnosis_text(&self.inner, &JointNames::of(&self.model.inner))
    }

    fn __repr__(&self) -> String {
        let effects = self.effects().join(", ");
        format!("<Diagnosis: {} {effects}>", self.verdict())
    }
}

impl Diagnosis {
    fn report(&self) -> Report {
        let (diagnosis, split) = (&self.inner, &self.split);
        let models = diagnosis.models(&self.model.inner);
        report(models, diagnosis, split, &self.model, "handstand.diagnose")
    }
}

/// A page: the model as it is and with what was found, against all motions.
pub fn report(
    models: Vec<(String, handstand::Model)>,
    diagnosis: &handstand::diagnose::Diagnosis,
    split: &Split,
    file: &Model,
    made_by: &str,
) -> Report {
    let motions = [split.training.as_slice(), &split.held_out].concat();
    let compared = models
        .iter()
        // Logs that were refused are not simulated.
        .filter(|_| !motions.is_empty())
        .map(|(name, model)| (name.as_str(), model, motions.as_slice()));
    Report {
        title: format!("What {} lacks", file.inner.name),
        comparisons: compare_all(compared, diagnosis.horizon_s.map(Horizon::Seconds)),
        diagnosis: Some(diagnosis.clone()),
        provenance: ReportProvenance::new(vec![file.file()], split, made_by),
        names: JointNames::of(&file.inner),
    }
}

/// Sentences with the names that the model's robot gives its joints and links.
pub fn named(sentences: &[String], model: &Model) -> Vec<String> {
    let names = JointNames::of(&model.inner);
    sentences.iter().map(|line| names.in_text(line)).collect()
}
