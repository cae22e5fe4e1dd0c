//! `compare`: a model's simulation beside what was measured.

use crate::logs::{check, given, horizon};
use crate::model::Model;
use crate::value::{framed, plain};
use crate::work;
use handstand::compare::text;
use handstand::log::Split;
use handstand::report::{Report, ReportProvenance, html, json};
use pyo3::prelude::*;

/// A comparison: errors of each joint, the floor that noise leaves, where the model fails.
#[pyclass(frozen, module = "handstand")]
#[derive(Debug, Clone)]
pub struct Comparison {
    report: Report,
}

/// Compares a model with logs. `logs` are file names, motions, or a list of them; `horizon_s` is
/// the longest that the model runs without correction.
#[pyfunction]
#[pyo3(signature = (model, logs, *, horizon_s=None))]
pub fn compare(
    py: Python<'_>,
    model: &Bound<'_, Model>,
    logs: &Bound<'_, PyAny>,
    horizon_s: Option<&Bound<'_, PyAny>>,
) -> PyResult<Comparison> {
    let model = model.get().clone();
    let horizon = horizon(horizon_s)?;
    let motions = given(logs, &model)?.motions(&model)?;
    check(horizon, &model, &motions)?;
    let name = model.file().name;
    let report = work::run(py, None, move |_| {
        let comparison = handstand::compare::compare(&model.inner, &name, &motions, horizon);
        let split = Split {
            training: motions,
            held_out: Vec::new(),
        };
        Report {
            title: format!("{name} against measured motions"),
            comparisons: vec![comparison],
            diagnosis: None,
            provenance: ReportProvenance::new(vec![model.file()], &split, "handstand.compare"),
        }
    })?;
    Ok(Comparison { report })
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
        text(&self.report.comparisons)
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
