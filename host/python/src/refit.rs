//! `add` and `fit`: a model with effects it lacked, or with values fitted to logs.

use crate::errors::{exception, failed};
use crate::logs::{check, horizon, judging, learned_and_held_out};
use crate::model::Model;
use crate::value::plain;
use crate::work::{self, WorkReport};
use handstand::fitting::{
    Addition, Refitted, Undetermined, add_effects, candidates_named, freed, refit, with_refitted,
};
use handstand::model::JointNames;
use handstand::report::{refitted_json, refitted_text, remedy_of};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A refitted model, its values with intervals, and the error before and after.
#[pyclass(frozen, module = "handstand")]
#[derive(Debug, Clone)]
pub struct Refit {
    model: Model,
    refitted: Refitted,
    /// Which model left the error before.
    before: &'static str,
}

/// Adds effects to a model, and fits their values along with those that the model frees. Effects
/// that do not lower the error are refused.
///
/// Parameters
/// ----------
/// model : Model
/// effects : str or list of str
///     `"coulomb@1"`, or those of a diagnosis.
/// logs : file name, path, Motion, DataFrame, or a list of them
/// holdout : as `logs`
///     What judges; without it the motions that were fitted. What is fitted is refused.
/// horizon_s : float or "whole"
///     The longest that models run without correction, s.
/// progress : callable
///     Called as `progress(what, done, total)`.
///
/// Returns
/// -------
/// Refit
#[pyfunction]
#[pyo3(signature = (model, effects, logs, *, holdout=None, horizon_s=None, progress=None,
                    hold_out=None),
       text_signature = "(model, effects, logs, *, holdout=None, horizon_s=None, progress=None)")]
#[expect(clippy::too_many_arguments, reason = "keywords of a Python function")]
pub fn add(
    py: Python<'_>,
    model: &Bound<'_, Model>,
    effects: &Bound<'_, PyAny>,
    logs: &Bound<'_, PyAny>,
    holdout: Option<&Bound<'_, PyAny>>,
    horizon_s: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
    hold_out: Option<&Bound<'_, PyAny>>,
) -> PyResult<Refit> {
    let model = model.borrow().clone();
    let names = names(effects)?;
    let candidates = candidates_named(&names, &model.inner).map_err(exception)?;
    let split =
        learned_and_held_out(logs, judging(py, holdout, hold_out)?, &model)?.named(&model)?;
    let horizon = horizon(horizon_s)?;
    check(
        horizon,
        &model,
        split.training.iter().chain(&split.held_out),
    )?;
    let (text, path) = (model.text, model.path.clone());
    let added = work::run(py, progress, move |report: &WorkReport| {
        let tell = |progress| report.tell(progress);
        add_effects(&text, &path, &candidates, &split, horizon, &tell)
    })?;
    match added.map_err(exception)? {
        Addition::Added { text, refitted } => Ok(Refit {
            model: Model::of(text, model.path).map_err(exception)?,
            refitted: *refitted,
            before: "for the model refitted without",
        }),
        Addition::Unhelpful(why) => Err(failed(format!(
            "{}\nremedy: {}",
            why.why(&names),
            why.remedy()
        ))),
        Addition::Undetermined(why) => Err(undetermined(&why)),
    }
}

/// Fits values of a model to logs.
///
/// Parameters
/// ----------
/// model : Model
/// logs : file name, path, Motion, DataFrame, or a list of them
/// free : str or list of str
///     Addresses of the values (`"link1.com_m"`, `"coulomb@1.torque_nm"`); those that the model
///     frees without it.
/// holdout : as `logs`
///     What judges; without it the motions that were fitted. What is fitted is refused.
/// horizon_s : float or "whole"
///     The longest that models run without correction, s.
/// progress : callable
///     Called as `progress(what, done, total)`.
///
/// Returns
/// -------
/// Refit
#[pyfunction]
#[pyo3(signature = (model, logs, *, free=None, holdout=None, horizon_s=None, progress=None,
                    hold_out=None),
       text_signature = "(model, logs, *, free=None, holdout=None, horizon_s=None, progress=None)")]
#[expect(clippy::too_many_arguments, reason = "keywords of a Python function")]
pub fn fit(
    py: Python<'_>,
    model: &Bound<'_, Model>,
    logs: &Bound<'_, PyAny>,
    free: Option<&Bound<'_, PyAny>>,
    holdout: Option<&Bound<'_, PyAny>>,
    horizon_s: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
    hold_out: Option<&Bound<'_, PyAny>>,
) -> PyResult<Refit> {
    let mut model = model.borrow().clone();
    let named = free.map(names).transpose()?.unwrap_or_default();
    let free = freed(&mut model.inner, &named).map_err(exception)?;
    let split =
        learned_and_held_out(logs, judging(py, holdout, hold_out)?, &model)?.named(&model)?;
    let horizon = horizon(horizon_s)?;
    check(
        horizon,
        &model,
        split.training.iter().chain(&split.held_out),
    )?;
    let path = model.path.clone();
    let fitted = work::run(py, progress, move |report| -> PyResult<_> {
        let tell = |progress| report.tell(progress);
        let refitted = refit(&model.inner, &free, &split, horizon, &tell);
        let refitted = refitted.map_err(|why| undetermined(&why))?;
        let text = with_refitted(&model.text, &model.path, &model.inner, &refitted, &split);
        Ok((text.map_err(exception)?, refitted))
    })?;
    let (text, refitted) = fitted?;
    Ok(Refit {
        model: Model::of(text, path).map_err(exception)?,
        refitted,
        before: "for the model as it was",
    })
}

/// One name, or a list of them.
pub fn names(given: &Bound<'_, PyAny>) -> PyResult<Vec<String>> {
    match given.extract::<String>() {
        Ok(one) => Ok(vec![one]),
        Err(_) => given.extract(),
    }
}

fn undetermined(why: &Undetermined) -> PyErr {
    failed(format!("{why}\nremedy: {}", remedy_of(why)))
}

#[pymethods]
impl Refit {
    /// The new model.
    #[getter]
    fn model(&self) -> Model {
        self.model.clone()
    }

    /// Fitted values by their addresses: `value`, `low` and `high`, the interval at 95 %.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let named = py.import("handstand._values")?.getattr("FittedValue")?;
        let values = PyDict::new(py);
        for own in &self.refitted.values {
            values.set_item(&own.path, named.call1((own.value, own.low, own.high))?)?;
        }
        Ok(values)
    }

    /// Root-mean-square error before, rad.
    #[getter]
    fn error_before_rad(&self) -> f64 {
        self.refitted.error.before_rad
    }

    /// Root-mean-square error of the new model, rad.
    #[getter]
    fn error_after_rad(&self) -> f64 {
        self.refitted.error.after_rad
    }

    /// Everything, with the keys of `handstand add --json`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &refitted_json(&self.refitted))
    }

    fn _repr_html_(&self) -> String {
        let text = self.__str__();
        let escaped = text.replace('&', "&amp;").replace('<', "&lt;");
        format!("<pre>{escaped}</pre>")
    }

    fn __str__(&self) -> String {
        let names = JointNames::of(&self.model.inner);
        refitted_text(&self.refitted, self.before, &names)
    }

    fn __repr__(&self) -> String {
        let [before, after] = [self.error_before_rad(), self.error_after_rad()];
        format!("<Refit: {:.2} -> {:.2} mrad>", 1e3 * before, 1e3 * after)
    }
}
