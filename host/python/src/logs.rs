//! Logs as arguments: files, motions, or lists of either.

use crate::errors::{exception, usage};
use crate::model::Model;
use crate::motion::Motion;
use handstand::fitting::Horizon;
use handstand::log::{LogRequest, LogSet, read};
use handstand::motion::Split;
use pyo3::exceptions::PyDeprecationWarning;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use std::path::PathBuf;

/// What was given.
pub enum LogSource {
    /// Files, as the command line names them.
    Files(Vec<LogRequest>),
    /// Motions, those of files read as the model declares their columns.
    Motions(Vec<handstand::motion::Motion>),
}

/// A log's motions, as the model declares its columns.
///
/// Parameters
/// ----------
/// path : file name, path or DataFrame
///     `a.csv`, or `a.csv:100-899` for data rows 100 to 899. A DataFrame's columns are named as in
///     a file; an index that has a name is a column.
/// model : Model
///     Names the columns and their units.
///
/// Returns
/// -------
/// list of Motion
#[pyfunction]
pub fn read_log(path: &Bound<'_, PyAny>, model: &Bound<'_, Model>) -> PyResult<Vec<Motion>> {
    let motions = motions_of(path, &model.borrow())?;
    Ok(motions.into_iter().map(Motion::read).collect())
}

/// The motions of a file or a DataFrame.
fn motions_of(log: &Bound<'_, PyAny>, model: &Model) -> PyResult<Vec<handstand::motion::Motion>> {
    if !is_frame(log)? {
        return read(&[request(log)?], &model.inner.log).map_err(exception);
    }
    let file = FrameFile::of(log)?;
    let motions = read(&[file.request()], &model.inner.log);
    let mut motions = motions.map_err(|error| exception(FrameFile::named(error)))?;
    for motion in &mut motions {
        motion.source.path = FrameFile::NAME.into();
    }
    Ok(motions)
}

/// Whether it is a table as pandas has it: columns, and a way to write them.
pub fn is_frame(given: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(given.hasattr("columns")? && given.hasattr("to_csv")? && given.hasattr("index")?)
}

/// A table as a file: it is read as every log is.
pub struct FrameFile {
    folder: tempfile::TempDir,
}

impl FrameFile {
    /// What a table of pandas is called where a file has a name.
    pub const NAME: &str = "DataFrame.csv";

    /// Writes the table, with every digit; an index that has a name as its first column.
    pub fn of(frame: &Bound<'_, PyAny>) -> PyResult<FrameFile> {
        let folder = tempfile::tempdir();
        let folder = folder.map_err(|error| {
            exception(handstand::Error::file(std::env::temp_dir(), "write", error))
        })?;
        let has_name = !frame.getattr("index")?.getattr("name")?.is_none();
        let options = PyDict::new(frame.py());
        options.set_item("index", has_name)?;
        frame.call_method("to_csv", (folder.path().join(Self::NAME),), Some(&options))?;
        Ok(FrameFile { folder })
    }

    /// All of it.
    pub fn request(&self) -> LogRequest {
        LogRequest::whole(self.folder.path().join(Self::NAME))
    }

    /// An error of the file as one of the table.
    pub fn named(error: handstand::Error) -> handstand::Error {
        match error {
            handstand::Error::Data { mut place, problem } => {
                place.file = Self::NAME.into();
                handstand::Error::Data { place, problem }
            }
            error => error,
        }
    }
}

/// What judges: `holdout`, or `hold_out` as it was called.
pub fn judging<'a, 'py>(
    py: Python<'py>,
    holdout: Option<&'a Bound<'py, PyAny>>,
    hold_out: Option<&'a Bound<'py, PyAny>>,
) -> PyResult<Option<&'a Bound<'py, PyAny>>> {
    let Some(old) = hold_out else {
        return Ok(holdout);
    };
    if holdout.is_some() {
        return Err(usage("`holdout` is given twice", "leave `hold_out` out"));
    }
    let category = py.get_type::<PyDeprecationWarning>();
    PyErr::warn(py, &category, c"`hold_out` is now called `holdout`", 1)?;
    Ok(Some(old))
}

/// A file's name, as the command line has it.
pub fn request(path: &Bound<'_, PyAny>) -> PyResult<LogRequest> {
    match path.cast::<PyString>() {
        Ok(text) => text.to_str()?.parse().map_err(exception),
        Err(_) => Ok(LogRequest::whole(path.extract::<PathBuf>().map_err(
            |_| {
                usage(
                    format!("{path} is no log"),
                    "give file names, paths, motions, DataFrames, or a list of them",
                )
            },
        )?)),
    }
}

/// What an argument holds; motions are held against the model.
pub fn given(logs: &Bound<'_, PyAny>, model: &Model) -> PyResult<LogSource> {
    let is_one = logs.is_instance_of::<PyString>()
        || logs.is_instance_of::<Motion>()
        || logs.hasattr("__fspath__")?
        || is_frame(logs)?;
    let items: Vec<Bound<'_, PyAny>> = if is_one {
        vec![logs.clone()]
    } else {
        logs.try_iter()?.collect::<PyResult<_>>()?
    };
    if items.is_empty() {
        return Err(usage("no log is given", "name at least one"));
    }
    let mut files = true;
    for item in &items {
        files &= !item.is_instance_of::<Motion>() && !is_frame(item)?;
    }
    if files {
        let requests = items.iter().map(request).collect::<PyResult<_>>()?;
        return Ok(LogSource::Files(requests));
    }
    let mut motions = Vec::new();
    for item in &items {
        match item.cast::<Motion>() {
            Ok(motion) => {
                let motion = motion.get().inner.clone();
                fits(&motion, model)?;
                motions.push(motion);
            }
            Err(_) => motions.extend(motions_of(item, model)?),
        }
    }
    Ok(LogSource::Motions(motions))
}

/// Refuses a motion of another rig.
pub fn fits(motion: &handstand::motion::Motion, model: &Model) -> PyResult<()> {
    let (joints, links) = (motion.position_rad.len(), model.inner.link_count());
    if joints != links {
        return Err(usage(
            format!(
                "motion {:?} has {joints} joints, the model {links}",
                motion.name
            ),
            "give a row per joint of the model",
        ));
    }
    for (index, (input, joint)) in motion.input.iter().zip(&model.inner.joints).enumerate() {
        if input.is_some() != joint.drive.is_driven() {
            let (has, drive) = match input {
                Some(_) => ("an input", "is passive"),
                None => ("no input", "is driven"),
            };
            return Err(usage(
                format!(
                    "motion {:?} has {has} of joint {}, which {drive} in the model",
                    motion.name,
                    index + 1
                ),
                "give the inputs of driven joints, and None for the others",
            ));
        }
    }
    Ok(())
}

impl LogSource {
    /// The motions.
    pub fn motions(self, model: &Model) -> PyResult<Vec<handstand::motion::Motion>> {
        match self {
            LogSource::Files(files) => read(&files, &model.inner.log).map_err(exception),
            LogSource::Motions(motions) => Ok(motions),
        }
    }
}

/// Logs to learn from and logs to judge by, as given.
pub fn learned_and_held_out(
    logs: &Bound<'_, PyAny>,
    hold_out: Option<&Bound<'_, PyAny>>,
    model: &Model,
) -> PyResult<Learned> {
    let hold_out = hold_out
        .map(|hold_out| given(hold_out, model))
        .transpose()?;
    Ok(match (given(logs, model)?, hold_out) {
        (LogSource::Files(training), None) => Learned::Files(LogSet {
            training,
            held_out: Vec::new(),
        }),
        (LogSource::Files(training), Some(LogSource::Files(held_out))) => {
            Learned::Files(LogSet { training, held_out })
        }
        (training, held_out) => {
            let held_out = held_out.map(|held_out| held_out.motions(model));
            Learned::Motions(
                training.motions(model)?,
                held_out.transpose()?.unwrap_or_default(),
            )
        }
    })
}

/// What is learned from, and what judges it.
pub enum Learned {
    /// Files alone, which are also checked for wrong signs, zeros and units.
    Files(LogSet),
    /// Motions to learn from, and those held out.
    Motions(
        Vec<handstand::motion::Motion>,
        Vec<handstand::motion::Motion>,
    ),
}

impl Learned {
    /// Read, as the commands that fit read: nothing is held out unless it is named.
    pub fn named(self, model: &Model) -> PyResult<Split> {
        match self {
            Learned::Files(set) => set.read(&model.inner.log).map_err(exception),
            Learned::Motions(training, held_out) => {
                Split::told_apart(training, held_out).map_err(exception)
            }
        }
    }
}

/// Refuses a horizon that leaves windows of these motions too few samples.
pub fn check<'a>(
    horizon: Option<Horizon>,
    model: &Model,
    motions: impl IntoIterator<Item = &'a handstand::motion::Motion>,
) -> PyResult<()> {
    let checked = horizon.map(|horizon| horizon.check(&model.inner, motions));
    checked.transpose().map(drop).map_err(exception)
}

/// The longest that models run without correction: seconds, or `"whole"`.
pub fn horizon(given: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Horizon>> {
    let Some(given) = given else {
        return Ok(None);
    };
    if let Ok(seconds) = given.extract::<f64>()
        && seconds.is_finite()
        && seconds > 0.0
    {
        return Ok(Some(Horizon::Seconds(seconds)));
    }
    match given.extract::<String>().as_deref() {
        Ok("whole") => Ok(Some(Horizon::Whole)),
        _ => Err(usage(
            format!("a horizon of {given}"),
            "give seconds above 0, or \"whole\" to run whole motions freely",
        )),
    }
}
