//! `next`: which experiment parts what logs leave open, or tightens values?

use crate::diagnose::{found, named};
use crate::errors::{exception, usage};
use crate::logs::{Learned, check, horizon, judging, learned_and_held_out};
use crate::model::Model;
use crate::motion::Motion;
use crate::refit::names;
use crate::value::plain;
use crate::work;
use handstand::diagnose::{DiagnoseOptions, Verdict};
use handstand::experiment::{
    Criterion, ExperimentLimits, ExperimentProposal, ProposeOptions, propose, propose_values,
};
use handstand::fitting::{Horizon, effect_named, free_parameters};
use handstand::motion::Split;
use pyo3::prelude::*;
use serde_json::json;

/// A proposed experiment.
#[pyclass(frozen, module = "handstand")]
#[derive(Debug, Clone)]
pub struct Proposal {
    inner: Option<ExperimentProposal>,
    /// What the diagnosis says.
    summary: Vec<String>,
    /// What a person does: of the experiment, or without one what the diagnosis asks for.
    instructions: Vec<String>,
}

/// The longest motion that is proposed without `seconds`, s; as on the command line.
const SECONDS: f64 = 20.0;

/// Proposes the next experiment: the one that parts the explanations that logs leave open, or
/// tightens values where one explanation is left.
///
/// Parameters
/// ----------
/// model : Model
///     Its joints turn.
/// logs : file name, path, Motion, DataFrame, or a list of them
/// holdout : as `logs`
///     What judges the diagnosis.
/// value : str or list of str
///     Addresses of values to tighten, whatever a diagnosis says.
/// criterion : "d" or "a"
///     What tightening makes small: the volume of all values' confidence region, or the sum of
///     their variances.
/// angles_rad : (low, high), or a list of them for each joint
///     Lowest and highest angle, rad; as in the logs without.
/// speed_rad_s, torque_nm : float
///     Fastest speed of a joint, and largest torque of a drive.
/// seconds : float
///     Longest duration, s.
/// mass_kg : float
///     Known mass that can be bolted onto the last link, kg; 0 for none.
/// without, known, trust_log, horizon_s, progress
///     As of `diagnose`.
/// seed : int
///     Of random motions and draws.
///
/// Returns
/// -------
/// Proposal
#[pyfunction]
#[pyo3(signature = (model, logs, *, holdout=None, value=None, criterion="d", angles_rad=None,
                    speed_rad_s=None, torque_nm=None, seconds=SECONDS, mass_kg=None,
                    without=Vec::new(), known=Vec::new(), trust_log=false, seed=1, horizon_s=None,
                    progress=None),
       text_signature = "(model, logs, *, holdout=None, value=None, criterion='d', \
                         angles_rad=None, speed_rad_s=None, torque_nm=None, seconds=20.0, \
                         mass_kg=None, without=..., known=..., trust_log=False, seed=1, \
                         horizon_s=None, progress=None)")]
#[expect(clippy::too_many_arguments, reason = "keywords of a Python function")]
pub fn next(
    py: Python<'_>,
    model: &Bound<'_, Model>,
    logs: &Bound<'_, PyAny>,
    holdout: Option<&Bound<'_, PyAny>>,
    value: Option<&Bound<'_, PyAny>>,
    criterion: &str,
    angles_rad: Option<&Bound<'_, PyAny>>,
    speed_rad_s: Option<f64>,
    torque_nm: Option<f64>,
    seconds: f64,
    mass_kg: Option<f64>,
    without: Vec<String>,
    known: Vec<String>,
    trust_log: bool,
    seed: u64,
    horizon_s: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Proposal> {
    let mut model = model.borrow().clone();
    let turning = (model.inner).hinges_only("proposed motions are for servos that turn");
    turning.map_err(exception)?;
    for effect in &without {
        effect_named(effect).map_err(exception)?;
    }
    let known = match known.as_slice() {
        [] => Vec::new(),
        known => free_parameters(&model.inner, known).map_err(exception)?,
    };
    model.inner.free.retain(|path| !known.contains(path));
    let values = match value.map(names).transpose()?.unwrap_or_default() {
        named if named.is_empty() => None,
        named => Some(free_parameters(&model.inner, &named).map_err(exception)?),
    };
    let criterion = match criterion {
        "d" => Criterion::D,
        "a" => Criterion::A,
        other => {
            return Err(usage(
                format!("a criterion {other:?}"),
                "give \"d\" or \"a\"",
            ));
        }
    };
    for (name, limit) in [
        ("seconds", Some(seconds)),
        ("speed_rad_s", speed_rad_s),
        ("torque_nm", torque_nm),
    ] {
        if let Some(limit) = limit.filter(|limit| !(limit.is_finite() && *limit > 0.0)) {
            return Err(usage(
                format!("`{name}` is {limit}"),
                "give a number above 0",
            ));
        }
    }
    let horizon = horizon(horizon_s)?;
    let learned = learned_and_held_out(logs, judging(py, holdout, None)?, &model)?;
    let (learned, all) = read_all(learned, &model)?;
    check(horizon, &model, &all)?;
    let mut limits = ExperimentLimits::of_logs(&model.inner, &all, seconds);
    if let Some(given) = angles_rad {
        (limits.low_rad, limits.high_rad) = ranges(given, model.inner.link_count())?;
    }
    if let Some(speed) = speed_rad_s {
        limits.speed_rad_s = vec![speed; model.inner.link_count()];
    }
    limits.torque_nm = torque_nm;
    let options = ProposeOptions {
        limits,
        mass_kg,
        criterion,
        seed,
    };
    let proposed = work::run(py, progress, move |report| -> handstand::Result<Proposal> {
        if let Some(values) = values {
            let horizon = horizon.unwrap_or(Horizon::Whole);
            let proposal = propose_values(&model.inner, &values, all, horizon, &options)?;
            return Ok(Proposal::of(Some(proposal), [&[], &[]], &model));
        }
        let search = DiagnoseOptions {
            without,
            known,
            horizon,
            trust_log,
            ..DiagnoseOptions::default()
        };
        let diagnosis = found(model.clone(), learned, &search, &|step| report.tell(step))?.inner;
        let inner = match diagnosis.verdict {
            Verdict::Unfit => None,
            _ => Some(propose(&model.inner, &diagnosis, all, &options)?),
        };
        let said = [diagnosis.summary.as_slice(), &diagnosis.next];
        Ok(Proposal::of(inner, said, &model))
    })?;
    proposed.map_err(exception)
}

/// The logs as they were given, and all their motions.
fn read_all(
    learned: Learned,
    model: &Model,
) -> PyResult<(Learned, Vec<handstand::motion::Motion>)> {
    let together = |split: &Split| [split.training.as_slice(), &split.held_out].concat();
    Ok(match learned {
        Learned::Files(set) => {
            let split = set.read(&model.inner.log).map_err(exception)?;
            (Learned::Files(set), together(&split))
        }
        Learned::Motions(training, held_out) => {
            let split = Split::told_apart(training, held_out).map_err(exception)?;
            let all = together(&split);
            (Learned::Motions(split.training, split.held_out), all)
        }
    })
}

/// Lowest and highest angles, rad: one pair for all joints, or one for each.
fn ranges(given: &Bound<'_, PyAny>, joints: usize) -> PyResult<(Vec<f64>, Vec<f64>)> {
    let pairs: Vec<(f64, f64)> = match given.extract::<(f64, f64)>() {
        Ok(one) => vec![one; joints],
        Err(_) => given.extract().unwrap_or_default(),
    };
    let is_range = |(low, high): &(f64, f64)| low.is_finite() && high.is_finite() && low < high;
    if pairs.len() == joints && pairs.iter().all(is_range) {
        Ok(pairs.into_iter().unzip())
    } else {
        Err(usage(
            format!(
                "`angles_rad` is {given} for {}",
                crate::value::counted(joints, "joint")
            ),
            "give (low, high) for all joints, or a list of one for each",
        ))
    }
}

impl Proposal {
    /// A proposal after what a diagnosis says and asks for, with the names of the model's joints.
    fn of(
        inner: Option<ExperimentProposal>,
        [summary, next]: [&[String]; 2],
        model: &Model,
    ) -> Proposal {
        let experiment = inner.as_ref().and_then(|own| own.experiment.as_ref());
        let instructions = experiment.map_or(next, |own| &own.instructions);
        Proposal {
            summary: named(summary, model),
            instructions: named(instructions, model),
            inner,
        }
    }
}

#[pymethods]
impl Proposal {
    /// Whether an experiment within the limits helps.
    #[getter]
    fn helps(&self) -> bool {
        self.inner.as_ref().is_some_and(ExperimentProposal::helps)
    }

    /// What a person does, in sentences; without an experiment what the diagnosis asks for.
    #[getter]
    fn instructions(&self) -> Vec<String> {
        self.instructions.clone()
    }

    /// The motion to play: times, inputs, and what the first explanation predicts; `None` without
    /// an experiment.
    #[getter]
    fn motion(&self) -> Option<Motion> {
        let experiment = self.inner.as_ref()?.experiment.as_ref()?;
        Some(Motion::read(experiment.motion.clone()))
    }

    /// What the diagnosis says, in sentences.
    #[getter]
    fn summary(&self) -> Vec<String> {
        self.summary.clone()
    }

    /// `proposal` and `diagnosis`, as `handstand next --json` has them.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(
            py,
            &json!({ "proposal": self.inner, "diagnosis": self.summary }),
        )
    }

    fn __str__(&self) -> String {
        let lines = self.summary.iter().cloned();
        lines
            .chain(self.instructions.iter().cloned())
            .collect::<Vec<_>>()
            .join("\n")
    }

    fn __repr__(&self) -> String {
        if self.helps() {
            "<Proposal: an experiment that helps>".to_string()
        } else {
            "<Proposal: no experiment within the limits helps>".to_string()
        }
    }
}
