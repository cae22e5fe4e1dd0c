//! `compare`: a model's simulation beside what was measured.

use crate::arrays::matrix;
use crate::logs::{check, given, horizon};
use crate::model::Model;
use crate::motion::Motion;
use crate::value::{framed, plain};
use crate::work;
use handstand::compare::{ModelRun, text};
use handstand::fitting::{FitProblem, Horizon};
use handstand::model::JointNames;
use handstand::motion::Split;
use handstand::report::{Report, ReportProvenance, html, json};
use numpy::PyArray2;
use pyo3::prelude::*;

/// A comparison: errors of each joint, the floor that noise leaves, where the model fails; and what
/// was predicted at every sample.
///
/// `predictions` and `residuals` have an array for each motion, of shape (signals, samples): a row
/// per joint, then one per rate sensor that a joint has beside the one of its angle.
#[pyclass(frozen, module = "handstand")]
#[derive(Debug, Clone)]
pub struct Comparison {
    report: Report,
    motions: Vec<handstand::motion::Motion>,
    /// `[motion][signal][sample]`.
    predicted: Vec<Vec<Vec<f64>>>,
    /// `[signal][motion][sample]`.
    residuals: Vec<Vec<Vec<f64>>>,
}

/// Compares a model with logs.
///
/// Parameters
/// ----------
/// model : Model
/// logs : file name, path, Motion, DataFrame, or a list of them
/// horizon_s : float or "whole"
///     The longest that the model runs without correction, s.
///
/// Returns
/// -------
/// Comparison
#[pyfunction]
#[pyo3(signature = (model, logs, *, horizon_s=None))]
pub fn compare(
    py: Python<'_>,
    model: &Bound<'_, Model>,
    logs: &Bound<'_, PyAny>,
    horizon_s: Option<&Bound<'_, PyAny>>,
) -> PyResult<Comparison> {
    let model = model.borrow().clone();
    let horizon = horizon(horizon_s)?;
    let motions = given(logs, &model)?.motions(&model)?;
    check(horizon, &model, &motions)?;
    let name = model.file().name;
    work::run(py, None, move |_| {
        let horizon = horizon.unwrap_or(Horizon::Whole);
        let data = FitProblem::new(&model.inner, motions.clone(), horizon);
        let run = ModelRun::new(model.inner.clone(), data, horizon);
        let comparison = run.comparison(&name);
        let split = Split {
            training: motions.clone(),
            held_out: Vec::new(),
        };
        let report = Report {
            title: format!("{name} against measured motions"),
            comparisons: vec![comparison],
            diagnosis: None,
            provenance: ReportProvenance::new(vec![model.file()], &split, "handstand.compare"),
            names: JointNames::of(&model.inner),
        };
        Comparison {
            report,
            motions,
            residuals: run.residuals(),
            predicted: run.predicted,
        }
    })
}

#[pymethods]
impl Comparison {
    /// Per measured joint: the root-mean-square error, rad, or rad/s of a joint whose rate alone is
    /// logged; then of the rate sensors that joints have beside those of their angles, rad/s.
    #[getter]
    fn rms(&self) -> Vec<f64> {
        let signals = self.report.comparisons[0].signals.iter();
        signals.map(|signal| signal.rms).collect()
    }

    /// Per measured joint and rate sensor: what resolution and noise alone leave, as `rms`.
    #[getter]
    fn floor(&self) -> Vec<f64> {
        let signals = self.report.comparisons[0].signals.iter();
        signals.map(|signal| signal.floor).collect()
    }

    /// The motions that were compared.
    #[getter]
    fn motions(&self) -> Vec<Motion> {
        let motions = self.motions.iter().cloned();
        motions.map(|inner| Motion { inner }).collect()
    }

    /// Per motion: what the model predicts at every sample, rad (m of a slide) or rad/s, of shape
    /// (signals, samples).
    #[getter]
    fn predictions<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        let motions = self.predicted.iter();
        motions.map(|signals| matrix(py, signals)).collect()
    }

    /// Per motion: measured minus predicted at every sample, of the same shape; not-a-number where
    /// nothing was measured.
    #[getter]
    fn residuals<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        let of = |motion: usize| -> Vec<Vec<f64>> {
            let signals = self.residuals.iter();
            signals.map(|signal| signal[motion].clone()).collect()
        };
        let motions = 0..self.motions.len();
        motions.map(|motion| matrix(py, &of(motion))).collect()
    }

    /// Everything, with the keys of `handstand compare --json`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &json(&self.report))
    }

    /// The page of `handstand compare --report`.
    fn html(&self) -> String {
        html(&self.report)
    }

    fn _repr_html_(&self) -> String {
        framed(&self.html())
    }

    fn __str__(&self) -> String {
        text(&self.report.comparisons, &self.report.names)
    }

    fn __repr__(&self) -> String {
        let rms: Vec<String> = self
            .rms()
            .iter()
            .map(|rms| format!("{:.2}", 1e3 * rms))
            .collect();
        format!("<Comparison: {} mrad RMS>", rms.join(", "))
    }
}
