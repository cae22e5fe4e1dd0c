//! `init`: a model started from a log.

use crate::errors::{exception, usage};
use crate::logs::{FrameFile, is_frame, request};
use crate::model::Model;
use crate::value::plain;
use handstand::first_model::estimate;
use handstand::fitting::StopSwitch;
use handstand::log::RawLog;
use handstand::log::init::{Draft as LogDraft, LerobotUnit, RobotDraft, RobotRequest};
use handstand::log::lerobot::Calibration;
use handstand::model::import::SpacePlan;
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A model started from a log, and what was guessed.
#[pyclass(frozen, module = "handstand")]
#[derive(Debug, Clone)]
pub struct Draft {
    model: Model,
    guesses: Value,
    values: Value,
}

/// Starts a model from a log: columns and units are guessed from the header's names and the
/// values' ranges.
///
/// Parameters
/// ----------
/// log : file name, path or DataFrame
/// name : str
///     For reports.
/// drive : "passive", "torque", "duty", "position" or "speed"
///     What drives the joints that have an input.
/// angle_zero : "hanging", "upright" or "horizontal"
///     Where the log's angles are zero.
/// angles : "relative" or "absolute"
///     What they are measured from: the link before, or the world.
/// length_m, mass_kg : list of float
///     Length of each link from joint to joint, m, and its mass, kg, from the base outwards.
/// robot : file name or path
///     URDF or MJCF file of the robot: the model is that robot in space, its columns matched by the
///     joints' names. Then neither `angle_zero`, `angles`, `length_m` nor `mass_kg`.
/// lock : dict of str to float
///     Joints of the robot that are held, and where, rad or m.
/// names : dict of str to str
///     What the log calls joints of the robot, where the names do not tell.
/// calibration : file name or path
///     LeRobot's calibration, which per cent of a joint's range refer to.
/// unit : "rad", "deg" or "percent"
///     In what LeRobot's code wrote the angles, in a data set or any table.
///
/// Returns
/// -------
/// Draft
#[pyfunction]
#[pyo3(signature = (log, *, name=None, drive=None, angle_zero=None, angles=None, length_m=None,
                    mass_kg=None, robot=None, lock=None, names=None, calibration=None,
                    unit=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of a Python function")]
pub fn init(
    log: &Bound<'_, PyAny>,
    name: Option<String>,
    drive: Option<String>,
    angle_zero: Option<String>,
    angles: Option<String>,
    length_m: Option<Vec<f64>>,
    mass_kg: Option<Vec<f64>>,
    robot: Option<PathBuf>,
    lock: Option<BTreeMap<String, f64>>,
    names: Option<BTreeMap<String, String>>,
    calibration: Option<PathBuf>,
    unit: Option<String>,
) -> PyResult<Draft> {
    let frame = if is_frame(log)? {
        Some(FrameFile::of(log)?)
    } else {
        None
    };
    let asked = match &frame {
        Some(file) => file.request(),
        None => request(log)?,
    };
    let told = |error| match &frame {
        Some(_) => exception(FrameFile::named(error)),
        None => exception(error),
    };
    let log = RawLog::read_request(&asked).map_err(told)?;
    let of_a_robot = [
        lock.is_some(),
        names.is_some(),
        calibration.is_some(),
        unit.is_some(),
    ];
    let planar = [
        angle_zero.is_some(),
        angles.is_some(),
        length_m.is_some(),
        mass_kg.is_some(),
    ];
    if let Some(file) = robot {
        if planar.contains(&true) {
            return Err(usage(
                "angle_zero, angles, length_m and mass_kg are of a model without a robot's file",
                "leave them out: the robot's file has them",
            ));
        }
        let robot = RobotWords {
            file,
            name,
            drive,
            lock: lock.unwrap_or_default(),
            names: names.unwrap_or_default(),
            calibration,
            unit,
        };
        return robot.draft(&log, &asked.name(), told);
    }
    if of_a_robot.contains(&true) {
        return Err(usage(
            "lock, names, calibration and unit are of a robot's file",
            "give robot=\"so101.urdf\", too",
        ));
    }
    let mut draft = LogDraft::of(&log, &asked.name(), drive.as_deref()).map_err(told)?;
    if let Some(drive) = drive.filter(|drive| !draft.has_input_of(drive)) {
        return Err(no_input(&drive, &log));
    }
    for (what, answer) in [
        ("name", name),
        ("angle zero", angle_zero),
        ("angles", angles),
    ] {
        if let Some(answer) = answer {
            draft.set(what, &answer).map_err(exception)?;
        }
    }
    for (what, values) in [("length", length_m), ("mass", mass_kg)] {
        if let Some(values) = values {
            draft.set_links(what, &values).map_err(exception)?;
        }
    }
    estimate(&mut draft, &asked, &StopSwitch::default(), &|_| ()).map_err(told)?;
    let text = draft.toml().map_err(exception)?;
    Ok(Draft {
        model: Model::of(text, PathBuf::from("model.toml")).map_err(exception)?,
        guesses: json!(draft.guesses),
        values: json!(draft.values().map_err(exception)?),
    })
}

/// Why a drive cannot be had.
fn no_input(drive: &str, log: &RawLog) -> PyErr {
    usage(
        format!(
            "no column that changes is named as what a drive of kind {drive:?} is told: {}",
            log.names.join(", ")
        ),
        "rename the input's column, such as tau_nm, duty, goal_rad, goal_speed_rad_s, or leave \
         `drive` out",
    )
}

/// What is said of a robot's file.
struct RobotWords {
    file: PathBuf,
    name: Option<String>,
    drive: Option<String>,
    lock: BTreeMap<String, f64>,
    names: BTreeMap<String, String>,
    calibration: Option<PathBuf>,
    unit: Option<String>,
}

impl RobotWords {
    /// The model of the robot in space with the log's columns.
    fn draft(
        self,
        log: &RawLog,
        log_name: &str,
        told: impl Fn(handstand::Error) -> PyErr,
    ) -> PyResult<Draft> {
        let unit = match self.unit.as_deref() {
            Some(unit) => Some(LerobotUnit::named(unit).ok_or_else(|| {
                usage(
                    format!("unit {unit:?}"),
                    "one of \"rad\", \"deg\", \"percent\"",
                )
            })?),
            None => None,
        };
        let read = |error| exception(handstand::Error::file(&self.file, "read", error));
        let text = std::fs::read_to_string(&self.file).map_err(read)?;
        let calibration = (self.calibration.as_deref()).map(Calibration::read);
        let calibration = calibration.transpose().map_err(exception)?;
        let names: Vec<(String, String)> = self.names.into_iter().collect();
        // A model that is saved elsewhere still finds its robot.
        let absolute = std::path::absolute(&self.file).map_err(read)?;
        let space = SpacePlan {
            robot: absolute.display().to_string(),
            locked: self.lock.into_iter().collect(),
        };
        let request = RobotRequest {
            text: &text,
            file: &self.file,
            space: &space,
            name: self.name.as_deref(),
            mapped: &names,
            calibration: calibration.as_ref(),
            unit,
            drive: self.drive.as_deref(),
        };
        let draft = RobotDraft::of(log, log_name, &request).map_err(told)?;
        if let Some(drive) = self.drive.filter(|drive| !draft.has_input_of(drive)) {
            return Err(no_input(&drive, log));
        }
        let file = PathBuf::from("model.toml");
        Ok(Draft {
            model: Model::of(draft.imported.toml, file).map_err(exception)?,
            guesses: json!(draft.guesses),
            values: json!([]),
        })
    }
}

#[pymethods]
impl Draft {
    /// The model.
    #[getter]
    fn model(&self) -> Model {
        self.model.clone()
    }

    /// What was guessed: each with `what`, `guess` and `why`.
    #[getter]
    fn guesses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.guesses)
    }

    /// The model's values: each with `path`, `value`, `low` and `high` of an estimate's 95 %
    /// interval, and `origin`: `given`, `estimated` or `guess`.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.values)
    }

    /// Everything, with the keys of `handstand init --json`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let text = &self.model.text;
        plain(
            py,
            &json!({ "file": null, "text": text, "guesses": self.guesses, "values": self.values }),
        )
    }

    fn __str__(&self) -> String {
        let all = self.guesses.as_array().into_iter().flatten();
        let line = |own: &Value| {
            let word = |key: &str| own[key].as_str().unwrap_or_default().to_string();
            format!("{}: {} ({})", word("what"), word("guess"), word("why"))
        };
        all.map(line).collect::<Vec<_>>().join("\n")
    }

    fn __repr__(&self) -> String {
        let guesses = self.guesses.as_array().map_or(0, Vec::len);
        format!(
            "<Draft {:?}: guessed {guesses} things>",
            self.model.inner.name
        )
    }
}
