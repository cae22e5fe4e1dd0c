//! `gains`: a regulator for a model, and the loop simulated with all its effects.

use crate::arrays::{matrix, numbers, rows};
use crate::errors::{exception, failed, usage};
use crate::model::Model;
use crate::value::plain;
use crate::work::{self, WorkReport};
use handstand::fitting::Progress;
use handstand::report::{gains_json, margins_json, margins_text, with_margins};
use handstand::sim::closed_loop::Velocity;
use handstand::study::{Verification, left_out, verification_steps, verify};
use handstand::synth::export::{self, Provenance};
use handstand::synth::{
    CostWeights, Design, LoopFigures, PoseText, Readings, Request, Time, Weight, balanced,
};
use nalgebra::DMatrix;
use numpy::PyArray2;
use pyo3::prelude::*;
use std::cell::Cell;
use std::collections::BTreeMap;

/// A matrix as an array.
type Matrix<'py> = Bound<'py, PyArray2<f64>>;

/// Gains with the plant they were designed for, and the verification of the loop.
#[pyclass(frozen, module = "handstand")]
#[derive(Debug, Clone)]
pub struct Gains {
    design: Design,
    made: Provenance,
    verification: Verification,
    figures: Option<LoopFigures>,
}

/// Gains that balance a model at a pose. The loop is then simulated with every effect of the model,
/// those included that the design leaves out.
///
/// Parameters
/// ----------
/// model : Model
/// q, r : a number, a diagonal or a matrix
///     Weights of states and inputs. Without both, one over the square of the largest departure of
///     each: 0.5 rad, 10 rad/s, the drive's limit (Bryson's rule). `q` alone goes with 1; the
///     paper's weights are `q=100`.
/// ts_s : float or None
///     Sampling time, s; `None` designs in continuous time.
/// delay_s : float
///     From sample to torque, s; that of the model without.
/// pose_rad : array or dict
///     The pose, rad, of slides m: an angle per joint, or of a robot in space those of some joints
///     by name. Without it upright; in space, and where a joint is not named, 0, or the middle of
///     the joint's range where that does not hold 0.
/// balance : bool
///     Take the balanced pose that is nearest.
/// position_step_rad : float
///     Step of the angles that the simulated law is given; the model's without.
/// speeds : "true" or "difference"
///     Its speeds: the true ones, or differences of those angles over the sampling time.
/// progress : callable
///     Called as `progress(what, done, total)`.
///
/// Returns
/// -------
/// Gains
#[pyfunction]
#[pyo3(signature = (model, *, q=None, r=None, ts_s=Some(0.01), delay_s=None, pose_rad=None,
                    balance=false, position_step_rad=None, speeds="true", progress=None),
       text_signature = "(model, *, q=None, r=None, ts_s=0.01, delay_s=None, pose_rad=None, \
                          balance=False, position_step_rad=None, speeds='true', progress=None)")]
#[expect(clippy::too_many_arguments, reason = "keywords of a Python function")]
pub fn gains(
    py: Python<'_>,
    model: &Bound<'_, Model>,
    q: Option<&Bound<'_, PyAny>>,
    r: Option<&Bound<'_, PyAny>>,
    ts_s: Option<f64>,
    delay_s: Option<f64>,
    pose_rad: Option<&Bound<'_, PyAny>>,
    balance: bool,
    position_step_rad: Option<f64>,
    speeds: &str,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Gains> {
    let model = model.borrow().clone();
    let standard = Request::standard(&model.inner);
    let weights = match (q, r) {
        (Some(q), Some(r)) => CostWeights::Given {
            q: weight("q", q)?,
            r: weight("r", r)?,
        },
        (Some(q), None) => CostWeights::Given {
            q: weight("q", q)?,
            r: Weight::Scalar(1.0),
        },
        (None, None) => standard.weights.clone(),
        (None, Some(_)) => {
            return Err(usage("weights of the inputs alone", "give q as well"));
        }
    };
    let mut pose_rad = match pose_rad {
        Some(given) => pose(&model.inner, given)?,
        None => standard.pose_rad.clone(),
    };
    if balance {
        pose_rad = balanced(&model.inner, &pose_rad).map_err(exception)?;
    }
    let speeds = match speeds {
        "true" => Velocity::Direct,
        "difference" => Velocity::Difference,
        other => {
            let what = format!("speeds={other:?}");
            return Err(usage(what, "give \"true\" or \"difference\""));
        }
    };
    if position_step_rad.is_some_and(|step| !(step > 0.0 && step.is_finite())) {
        return Err(usage("position_step_rad is no positive number", "give rad"));
    }
    let request = Request {
        pose_rad,
        readings: Readings {
            position_step_rad,
            speeds,
        },
        weights,
        time: match ts_s {
            Some(ts_s) => Time::Sampled { ts_s, delay_s },
            None => Time::Continuous,
        },
        ..standard
    };
    let file = model.file();
    let made = Provenance {
        model: file.name,
        sha256: file.sha256,
        command: "handstand.gains".to_string(),
    };
    let found = work::run(py, progress, move |report| {
        designed(&model, &request, report)
    })?;
    let (design, verification, figures) = found.map_err(exception)?;
    Ok(Gains {
        design,
        made,
        verification,
        figures,
    })
}

/// A pose: an angle per joint, or angles by the joints' names.
fn pose(model: &handstand::Model, given: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let pose = match given.extract::<BTreeMap<String, f64>>() {
        Ok(named) => PoseText::Named(named.into_iter().collect()),
        Err(_) => PoseText::Angles(numbers("pose_rad", given)?),
    };
    pose.resolve(model).map_err(exception)
}

fn designed(
    model: &Model,
    request: &Request,
    report: &WorkReport,
) -> handstand::Result<(Design, Verification, Option<LoopFigures>)> {
    let model = &model.inner;
    let design = Design::of(model, request)?;
    let left_out = left_out(model, model, &design);
    let (total, done) = (verification_steps(&left_out), Cell::new(0));
    let tell = || {
        done.set(done.get() + 1);
        report.tell(Progress {
            done: done.get(),
            total,
            what: "simulations of the loop".into(),
            best: None,
            left_s: None,
        });
    };
    let verification = verify(model, &design, request, &left_out, &tell)?;
    let figures = LoopFigures::of(model, &design)?;
    Ok((design, verification, figures))
}

/// A weight: a number, a diagonal or a matrix.
fn weight(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Weight> {
    if let Ok(number) = given.extract::<f64>() {
        return Ok(Weight::Scalar(number));
    }
    if let Ok(diagonal) = numbers(name, given) {
        return Ok(Weight::Diagonal(diagonal));
    }
    let rows = rows(name, given, None)?;
    let size = rows.len();
    if rows.iter().all(|row| row.len() == size) {
        Ok(Weight::Matrix(DMatrix::from_fn(size, size, |i, j| {
            rows[i][j]
        })))
    } else {
        Err(usage(
            format!("`{name}` has {size} rows of {} numbers", rows[0].len()),
            "give a number, a diagonal or a square matrix",
        ))
    }
}

fn array<'py>(py: Python<'py>, of: &DMatrix<f64>) -> PyResult<Matrix<'py>> {
    let rows: Vec<Vec<f64>> = of
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect();
    matrix(py, &rows)
}

#[pymethods]
impl Gains {
    /// K of u = u0 - K (x - x0): shape (inputs, states).
    #[getter]
    fn k<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        array(py, &self.design.gains.k)
    }

    /// Names of the states that K multiplies.
    #[getter]
    fn states(&self) -> Vec<String> {
        self.design
            .states
            .iter()
            .map(|state| state.name.clone())
            .collect()
    }

    /// The operating point of the states, SI.
    #[getter]
    fn x0(&self) -> Vec<f64> {
        self.design.x0.clone()
    }

    /// The inputs that hold it, SI.
    #[getter]
    fn u0(&self) -> Vec<f64> {
        self.design.u0.clone()
    }

    /// `(A, B)` of the plant in continuous time.
    #[getter]
    fn plant<'py>(&self, py: Python<'py>) -> PyResult<(Matrix<'py>, Matrix<'py>)> {
        let plant = &self.design.plant;
        Ok((array(py, &plant.a)?, array(py, &plant.b)?))
    }

    /// Whether the simulated loop, with every effect of the model, is stabilised.
    #[getter]
    fn stabilised(&self) -> bool {
        self.verification.stabilised
    }

    /// Largest cube of starts of which 95 % are stabilised: half its edge, rad.
    #[getter]
    fn region_rad(&self) -> f64 {
        self.verification.region_rad
    }

    /// Whether the region may be larger still: the search ends there.
    #[getter]
    fn region_open(&self) -> bool {
        self.verification.region_open
    }

    /// Whether the robot stays up with all gains at zero too: `stabilised` then says nothing.
    #[getter]
    fn stays_uncontrolled(&self) -> bool {
        self.verification.stays_uncontrolled
    }

    /// Gain, phase and delay margins of the linear loop, its disk margin and the peaks of S and T,
    /// at the inputs: `margins` of `handstand gains --json`; `None` of a loop that is not stable.
    #[getter]
    fn margins<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &margins_json(self.figures.as_ref())["margins"])
    }

    /// The header of the fixed-point law for C; its names begin with `name`, so that one file can
    /// include several.
    #[pyo3(signature = (name="gains"))]
    fn c_header(&self, name: &str) -> PyResult<String> {
        let fixed = self.fixed()?;
        if !export::is_c_name(name) {
            return Err(usage(
                format!("`{name}` begins no names of C"),
                "give small letters, digits and _, a letter first",
            ));
        }
        Ok(export::c_header(&self.design, fixed, &self.made, name))
    }

    /// The fixed-point law for Rust.
    fn rust_file(&self) -> PyResult<String> {
        let fixed = self.fixed()?;
        Ok(export::rust_file(&self.design, fixed, &self.made))
    }

    /// Everything, with the keys of `handstand gains --json`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(
            py,
            &with_margins(
                gains_json(&self.design, &self.made, &self.verification),
                self.figures.as_ref(),
            ),
        )
    }

    fn _repr_html_(&self) -> String {
        let escaped = self.__str__().replace('&', "&amp;").replace('<', "&lt;");
        format!("<pre>{escaped}</pre>")
    }

    fn __str__(&self) -> String {
        let margins = margins_text(self.figures.as_ref(), &self.design);
        format!("{}\n\n{margins}", export::text(&self.design).trim_end())
    }

    fn __repr__(&self) -> String {
        let loop_is = if self.verification.stabilised {
            "stabilised"
        } else {
            "NOT stabilised"
        };
        format!(
            "<Gains for {:?}: the simulated loop is {loop_is}>",
            self.design.model
        )
    }
}

impl Gains {
    fn fixed(&self) -> PyResult<&handstand::synth::FixedDesign> {
        self.design.fixed.as_ref().ok_or_else(|| {
            failed("gains in continuous time have no fixed-point law\nremedy: give ts_s")
        })
    }
}
