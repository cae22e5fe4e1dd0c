//! `log_check`: are logs fit for use, and do they agree with the model's file?

use crate::errors::{exception, usage};
use crate::logs::{FrameFile, LogSource, given, is_frame};
use crate::model::Model;
use crate::value::plain;
use crate::work;
use handstand::diagnose::conventions::{ModelFile, findings};
use handstand::log::LogFinding;
use handstand::report::{log_check_json, log_check_text};
use pyo3::prelude::*;

/// What a check of logs found.
#[pyclass(frozen, module = "handstand")]
#[derive(Debug, Clone)]
pub struct LogCheck {
    findings: Vec<LogFinding>,
}

/// Checks logs before a model is fitted to them: wrong signs, zeros, units, drives and times, with
/// the lines of the model file to change, and rows that are broken.
///
/// Parameters
/// ----------
/// model : Model
/// logs : file name, path, DataFrame, or a list of files
///     As they are written: motions are read already.
///
/// Returns
/// -------
/// LogCheck
#[pyfunction]
pub fn log_check(
    py: Python<'_>,
    model: &Bound<'_, Model>,
    logs: &Bound<'_, PyAny>,
) -> PyResult<LogCheck> {
    let model = model.borrow().clone();
    let frame = if is_frame(logs)? {
        Some(FrameFile::of(logs)?)
    } else {
        None
    };
    let requests = match &frame {
        Some(file) => vec![file.request()],
        None => match given(logs, &model)? {
            LogSource::Files(files) => files,
            LogSource::Motions(_) => {
                return Err(usage(
                    "motions are read already: of units and columns they say nothing",
                    "give the files, or one DataFrame",
                ));
            }
        },
    };
    let found = work::run(py, None, move |_| {
        let file = ModelFile {
            path: &model.path,
            text: &model.text,
        };
        findings(&requests, &model.inner, file)
    })?;
    let mut findings = found.map_err(|error| match &frame {
        Some(_) => exception(FrameFile::named(error)),
        None => exception(error),
    })?;
    if let Some(file) = &frame {
        let written = file.request().path;
        let places = findings.iter_mut().filter_map(|own| own.place.as_mut());
        for place in places.filter(|place| place.file == written) {
            place.file = FrameFile::NAME.into();
        }
    }
    Ok(LogCheck { findings })
}

#[pymethods]
impl LogCheck {
    /// `clean`, `warned` or `refused`.
    #[getter]
    fn verdict(&self) -> String {
        let found = log_check_json(&self.findings);
        found["verdict"].as_str().unwrap_or_default().to_string()
    }

    /// Each with `severity`, `kind`, `file`, `line`, `column`, `what`, `remedy` and `proof`.
    #[getter]
    fn findings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &log_check_json(&self.findings)["findings"])
    }

    /// Everything, with the keys of `handstand log check --json`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &log_check_json(&self.findings))
    }

    fn __str__(&self) -> String {
        log_check_text(&self.findings)
    }

    fn __repr__(&self) -> String {
        let findings = crate::value::counted(self.findings.len(), "finding");
        format!("<LogCheck: {}, {findings}>", self.verdict())
    }
}
