//! `drift`: do a model's values differ from log to log?

use crate::errors::{exception, usage};
use crate::logs::{check, given, horizon, is_frame};
use crate::model::Model;
use crate::motion::Motion;
use crate::refit::names;
use crate::value::plain;
use crate::work;
use handstand::fitting::{DriftSession, Horizon, freed};
use handstand::motion::Split;
use pyo3::prelude::*;

/// Tests whether a model's values differ between sessions, or servos.
///
/// Parameters
/// ----------
/// model : Model
/// logs : list of file names, paths, motions, DataFrames, or lists of these
///     Each a session, at least two.
/// free : str or list of str
///     Addresses of the values to compare; those that the model frees without it.
/// horizon_s : float or "whole"
///     The longest that models run without correction, s.
///
/// Returns
/// -------
/// dict
///     `sessions`, `joints` and `refused`, with the keys of `handstand drift --json`.
#[pyfunction]
#[pyo3(signature = (model, logs, *, free=None, horizon_s=None))]
pub fn drift<'py>(
    py: Python<'py>,
    model: &Bound<'py, Model>,
    logs: &Bound<'py, PyAny>,
    free: Option<&Bound<'py, PyAny>>,
    horizon_s: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut model = model.borrow().clone();
    let named = free.map(names).transpose()?.unwrap_or_default();
    let free = freed(&mut model.inner, &named).map_err(exception)?;
    let mut sessions: Vec<DriftSession> = Vec::new();
    for (index, log) in logs.try_iter()?.enumerate() {
        let log = log?;
        let motions = given(&log, &model)?.motions(&model)?;
        for before in &sessions {
            Split::told_apart(before.motions.clone(), motions.clone()).map_err(|_| {
                usage(
                    format!("sessions {} and {} share a motion", before.name, index + 1),
                    "name each motion once: one named twice agrees with itself",
                )
            })?;
        }
        let name = name(&log, index)?;
        sessions.push(DriftSession { name, motions });
    }
    if sessions.len() < 2 {
        return Err(usage(
            "fewer than two sessions",
            "give a list of two logs or more",
        ));
    }
    let horizon: Option<Horizon> = horizon(horizon_s)?;
    check(
        horizon,
        &model,
        sessions.iter().flat_map(|session| &session.motions),
    )?;
    let found = work::run(py, None, move |_| {
        let found = handstand::fitting::drift(&model.inner, &free, &sessions, horizon);
        serde_json::to_value(found).unwrap_or_default()
    })?;
    plain(py, &found)
}

/// What a session is called.
fn name(log: &Bound<'_, PyAny>, index: usize) -> PyResult<String> {
    if let Ok(motion) = log.cast::<Motion>() {
        return Ok(motion.get().inner.name.clone());
    }
    let is_file = log.extract::<String>().is_ok() || log.hasattr("__fspath__")?;
    if is_file && !is_frame(log)? {
        Ok(log.str()?.to_string())
    } else {
        Ok(format!("session {}", index + 1))
    }
}
