//! `discover`: the law that the model and the library lack.

use crate::diagnose::{report, seconds};
use crate::errors::exception;
use crate::logs::{Learned, horizon, judging, learned_and_held_out};
use crate::model::Model;
use crate::value::{framed, plain};
use crate::work;
use handstand::diagnose::DiagnoseOptions;
use handstand::diagnose::conventions::ModelFile;
use handstand::discover::{LogDiscovery, MOST_TERMS, discover_logs};
use handstand::fitting::{Addition, Horizon, Progress, free_parameters};
use handstand::model::JointNames;
use handstand::motion::Split;
use handstand::report::{
    Report, discovered_terms, discovery_json, discovery_text, html_with, law_section,
};
use pyo3::prelude::*;

/// A law that was discovered, and the model with it.
#[pyclass(frozen, module = "handstand")]
#[derive(Debug, Clone)]
pub struct Discovery {
    found: LogDiscovery,
    /// The model that was given.
    given: Model,
    /// The model with the law.
    model: Option<Model>,
}

/// Looks for the law that a model lacks, where no effect of the library explains it.
///
/// Parameters
/// ----------
/// model : Model
/// logs : file name, path, Motion, DataFrame, or a list of them
///     What is learned from. Files are first checked for wrong signs, zeros, units and drives.
/// holdout : as `logs`
///     What judges; without it the last third of the motions. What is learned from is refused.
/// terms : int
///     Most terms of the law, 1 to 3.
/// known : list of str
///     Addresses of values that were measured by themselves.
/// seed : int
///     Of the search's random starts.
/// horizon_s : float or "whole"
///     The longest that models run without correction, s.
/// within_s : float
///     The seconds that it may take: the best verdict of that time.
/// progress : callable
///     Called as `progress(what, done, total)`.
///
/// Returns
/// -------
/// Discovery
#[pyfunction]
#[pyo3(signature = (model, logs, *, holdout=None, terms=MOST_TERMS, known=Vec::new(), seed=None,
                    horizon_s=None, within_s=None, progress=None),
       text_signature = "(model, logs, *, holdout=None, terms=2, known=..., seed=None, \
                         horizon_s=None, within_s=None, progress=None)")]
#[expect(clippy::too_many_arguments, reason = "keywords of a Python function")]
pub fn discover(
    py: Python<'_>,
    model: &Bound<'_, Model>,
    logs: &Bound<'_, PyAny>,
    holdout: Option<&Bound<'_, PyAny>>,
    terms: usize,
    known: Vec<String>,
    seed: Option<u64>,
    horizon_s: Option<&Bound<'_, PyAny>>,
    within_s: Option<f64>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Discovery> {
    let model = model.borrow().clone();
    let defaults = DiagnoseOptions::default();
    let options = DiagnoseOptions {
        seed: seed.unwrap_or(defaults.seed),
        known: match known.as_slice() {
            [] => Vec::new(),
            known => free_parameters(&model.inner, known).map_err(exception)?,
        },
        horizon: horizon(horizon_s)?,
        within_s: within_s.map(seconds).transpose().map_err(exception)?,
        most_effects: most(terms).map_err(exception)?,
        ..defaults
    };
    let logs = learned_and_held_out(logs, judging(py, holdout, None)?, &model)?;
    let found = work::run(py, progress, move |report| {
        let options = DiagnoseOptions {
            stop: report.stop_switch().clone(),
            ..options
        };
        discovered(model, logs, &options, &|progress| report.tell(progress))
    })?;
    found.map_err(exception)
}

/// A number of terms.
fn most(terms: usize) -> handstand::Result<usize> {
    if (1..=3).contains(&terms) {
        return Ok(terms);
    }
    Err(handstand::Error::usage(
        format!("terms = {terms} is no number of terms"),
        "give 1, 2 or 3",
    ))
}

fn discovered(
    model: Model,
    logs: Learned,
    options: &DiagnoseOptions,
    tell: &(dyn Fn(Progress) + Sync),
) -> handstand::Result<Discovery> {
    let found = match logs {
        Learned::Files(set) => {
            let file = ModelFile {
                path: &model.path,
                text: &model.text,
            };
            discover_logs(&model.inner, file, &set, options, tell)?
        }
        Learned::Motions(training, held_out) => {
            if let Some(horizon) = options.horizon {
                horizon.check(&model.inner, training.iter().chain(&held_out))?;
            }
            let split = Split::told_apart(training, held_out)?;
            let split = handstand::motion::split(split.training, split.held_out);
            handstand::discover::discover(&model.inner, split, options, tell)?
        }
    };
    let with_law = with_law(&found, &model, options.horizon, tell)?;
    Ok(Discovery {
        found,
        given: model,
        model: with_law,
    })
}

/// The model with the law; none where none was found, or its values cannot be determined.
fn with_law(
    found: &LogDiscovery,
    model: &Model,
    horizon: Option<Horizon>,
    tell: &dyn Fn(Progress),
) -> handstand::Result<Option<Model>> {
    if !found.discovery.has_law() {
        return Ok(None);
    }
    let (text, path) = (&model.text, &model.path);
    let added = found
        .discovery
        .added_to(text, path, &found.split, horizon, tell)?;
    match added {
        Addition::Added { text, .. } => Model::of(text, path.clone()).map(Some),
        Addition::Unhelpful(_) | Addition::Undetermined(_) => Ok(None),
    }
}

#[pymethods]
impl Discovery {
    /// `found`, `ambiguous`, `partial`, `not_found`, `nothing_missing`, `wrong_value` or `unfit`.
    #[getter]
    fn verdict(&self) -> String {
        let name = serde_json::to_value(self.found.discovery.verdict).unwrap_or_default();
        name.as_str().unwrap_or_default().to_string()
    }

    /// The terms of the law with joint and values:
    /// `joint 1: torque = -0.0764 * dir * abs(w / 4)^3 (drag_power)`.
    #[getter]
    fn terms(&self) -> Vec<String> {
        discovered_terms(&self.found.discovery, &self.names())
    }

    /// The model with the law; None where there is none to work with.
    #[getter]
    fn model(&self) -> Option<Model> {
        self.model.clone()
    }

    /// Everything, with the keys of `handstand discover --json`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &discovery_json(&self.found.discovery))
    }

    /// The page of `handstand discover --report`.
    fn html(&self, py: Python<'_>) -> String {
        py.detach(|| {
            let law = law_section(&self.found.discovery, &self.names());
            html_with(&self.report(), law.into_iter().collect())
        })
    }

    fn _repr_html_(&self, py: Python<'_>) -> String {
        framed(&self.html(py))
    }

    fn __str__(&self) -> String {
        discovery_text(&self.found.discovery, &self.names())
    }

    fn __repr__(&self) -> String {
        format!(
            "<Discovery: {} {}>",
            self.verdict(),
            self.terms().join("; ")
        )
    }
}

impl Discovery {
    fn names(&self) -> JointNames {
        JointNames::of(&self.given.inner)
    }

    fn report(&self) -> Report {
        let LogDiscovery {
            discovery,
            model,
            split,
        } = &self.found;
        let models = discovery.diagnosis.models(model);
        let diagnosis = &discovery.diagnosis;
        report(models, diagnosis, split, &self.given, "handstand.discover")
    }
}
