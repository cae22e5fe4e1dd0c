//! Logs as arguments: files, motions, or lists of either.

use crate::errors::{exception, usage};
use crate::model::Model;
use crate::motion::Motion;
use handstand::fitting::Horizon;
use handstand::log::{LogRequest, LogSet, Split, read};
use pyo3::prelude::*;
use pyo3::types::PyString;
use std::path::PathBuf;

/// What was given.
pub enum Given {
    /// Files, as the command line names them.
    Files(Vec<LogRequest>),
    /// Motions, those of files read as the model declares their columns.
    Motions(Vec<handstand::log::Motion>),
}

/// A file's motions, as the model declares its columns: `a.csv`, or `a.csv:100-899` for data rows
/// 100 to 899.
#[pyfunction]
pub fn read_log(path: &Bound<'_, PyAny>, model: &Bound<'_, Model>) -> PyResult<Vec<Motion>> {
    let motions = read(&[request(path)?], &model.get().inner.log).map_err(exception)?;
    let motions = motions.into_iter().map(|inner| Motion { inner });
    Ok(motions.collect())
}

fn request(path: &Bound<'_, PyAny>) -> PyResult<LogRequest> {
    match path.cast::<PyString>() {
        Ok(text) => text.to_str()?.parse().map_err(exception),
        Err(_) => Ok(LogRequest::whole(path.extract::<PathBuf>().map_err(
            |_| {
                usage(
                    format!("{path} is no log"),
                    "give file names, paths, motions, or a list of them",
                )
            },
        )?)),
    }
}

/// What an argument holds; motions are held against the model.
pub fn given(logs: &Bound<'_, PyAny>, model: &Model) -> PyResult<Given> {
    let is_one = logs.is_instance_of::<PyString>()
        || logs.is_instance_of::<Motion>()
        || logs.hasattr("__fspath__")?;
    let items: Vec<Bound<'_, PyAny>> = match is_one {
        true => vec![logs.clone()],
        false => logs.try_iter()?.collect::<PyResult<_>>()?,
    };
    if items.is_empty() {
        return Err(usage("no log is given", "name at least one"));
    }
    if !items.iter().any(|item| item.is_instance_of::<Motion>()) {
        let requests = items.iter().map(request).collect::<PyResult<_>>()?;
        return Ok(Given::Files(requests));
    }
    let mut motions = Vec::new();
    for item in &items {
        match item.cast::<Motion>() {
            Ok(motion) => {
                let motion = motion.get().inner.clone();
                fits(&motion, model)?;
                motions.push(motion);
            }
            Err(_) => {
                let columns = &model.inner.log;
                motions.extend(read(&[request(item)?], columns).map_err(exception)?);
            }
        }
    }
    Ok(Given::Motions(motions))
}

/// Refuses a motion of another rig.
pub fn fits(motion: &handstand::log::Motion, model: &Model) -> PyResult<()> {
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

impl Given {
    /// The motions.
    pub fn motions(self, model: &Model) -> PyResult<Vec<handstand::log::Motion>> {
        match self {
            Given::Files(files) => read(&files, &model.inner.log).map_err(exception),
            Given::Motions(motions) => Ok(motions),
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
        (Given::Files(training), None) => Learned::Files(LogSet {
            training,
            held_out: Vec::new(),
        }),
        (Given::Files(training), Some(Given::Files(held_out))) => {
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
    Motions(Vec<handstand::log::Motion>, Vec<handstand::log::Motion>),
}

impl Learned {
    /// Read, as the commands that fit read: nothing is held out unless it is named.
    pub fn named(self, model: &Model) -> PyResult<Split> {
        match self {
            Learned::Files(set) => set.read(&model.inner.log).map_err(exception),
            Learned::Motions(training, held_out) => Ok(Split { training, held_out }),
        }
    }
}

/// Refuses a horizon that leaves windows of these motions too few samples.
pub fn check<'a>(
    horizon: Option<Horizon>,
    model: &Model,
    motions: impl IntoIterator<Item = &'a handstand::log::Motion>,
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
