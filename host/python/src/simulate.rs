//! `simulate`: a model with all its effects, along inputs.

use crate::arrays::{numbers, rows_or_none};
use crate::errors::usage;
use crate::logs::fits;
use crate::model::Model;
use crate::motion::Motion;
use crate::work;
use handstand::model::{MeasuredSignal, hanging};
use handstand::motion::MotionSource;
use handstand::sim::{Plant, PlantMemory, StartState, predict};
use pyo3::prelude::*;

/// Simulates a model with all its effects.
///
/// Parameters
/// ----------
/// model : Model
/// time_s : array
///     Times of the samples, s.
/// input : array of shape (joints, samples), or a list with `None` for passive joints
///     What each drive is told, in SI of its kind (N m, duty, rad, rad/s); each value holds to the
///     next sample.
/// angle_rad, speed_rad_s : array
///     Where it starts, a value per joint, as the model counts it; hanging at rest without.
/// supply_v : array
///     Supply, V.
/// payload_kg : float
///     Mass bolted to the last link, kg.
///
/// Returns
/// -------
/// Motion
///     What the sensors would read.
#[pyfunction]
#[pyo3(signature = (model, time_s, *, input=None, angle_rad=None, speed_rad_s=None, supply_v=None,
                    payload_kg=0.0))]
#[expect(clippy::too_many_arguments, reason = "keywords of a Python function")]
pub fn simulate(
    py: Python<'_>,
    model: &Bound<'_, Model>,
    time_s: &Bound<'_, PyAny>,
    input: Option<&Bound<'_, PyAny>>,
    angle_rad: Option<&Bound<'_, PyAny>>,
    speed_rad_s: Option<&Bound<'_, PyAny>>,
    supply_v: Option<&Bound<'_, PyAny>>,
    payload_kg: f64,
) -> PyResult<Motion> {
    let model = model.borrow().clone();
    let joints = model.inner.link_count();
    let time_s = numbers("time_s", time_s)?;
    let samples = time_s.len();
    let motion = Motion::of(handstand::motion::Motion {
        name: "simulated".to_string(),
        source: MotionSource {
            path: "simulated".into(),
            sha256: String::new(),
            lines: (1, samples),
        },
        time_s,
        position_rad: vec![vec![0.0; samples]; joints],
        velocity_rad_s: vec![None; joints],
        rate_rad_s: vec![None; joints],
        input: rows_or_none("input", input, joints, samples)?,
        supply_v: supply_v
            .map(|given| numbers("supply_v", given))
            .transpose()?,
        payload_kg,
        ..Default::default()
    })?;
    fits(&motion.inner, &model)?;
    let start = StartState {
        angle_rad: state("angle_rad", angle_rad, hanging(&model.inner))?,
        speed_rad_s: state("speed_rad_s", speed_rad_s, vec![0.0; joints])?,
        ..StartState::default()
    };
    work::run(py, None, move |_| simulated(&model, motion, &start))
}

/// A value per joint.
fn state(name: &str, given: Option<&Bound<'_, PyAny>>, rest: Vec<f64>) -> PyResult<Vec<f64>> {
    let Some(given) = given else {
        return Ok(rest);
    };
    let values = match given.extract::<f64>() {
        Ok(one) => vec![one],
        Err(_) => numbers(name, given)?,
    };
    if values.len() == rest.len() && values.iter().all(|value| value.is_finite()) {
        Ok(values)
    } else {
        Err(usage(
            format!("`{name}` is {values:?} for {} joints", rest.len()),
            "give a number per joint",
        ))
    }
}

fn simulated(model: &Model, motion: Motion, start: &StartState) -> Motion {
    let mut motion = motion.inner;
    let (joints, samples) = (motion.position_rad.len(), motion.len());
    let plant = Plant::new(&model.inner, &motion);
    let mut readings = vec![0.0; plant.signals() * samples];
    let mut memory = PlantMemory::default();
    predict(
        &plant,
        &motion,
        0..samples,
        start,
        &mut memory,
        &mut readings,
    );
    let (of_joints, of_rates) = readings.split_at(joints * samples);
    for (&joint, read) in plant.rate_joints().iter().zip(of_rates.chunks(samples)) {
        motion.rate_rad_s[joint] = Some(read.to_vec());
    }
    for (joint, read) in of_joints.chunks(samples).enumerate() {
        match model
            .inner
            .log
            .joints
            .get(joint)
            .map(|columns| columns.signal())
        {
            Some(MeasuredSignal::Rate) => {
                motion.position_rad[joint] = vec![f64::NAN; samples];
                motion.velocity_rad_s[joint] = Some(read.to_vec());
            }
            _ => motion.position_rad[joint] = read.to_vec(),
        }
    }
    Motion { inner: motion }
}
