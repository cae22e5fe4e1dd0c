//! Motions: what a log holds between two interruptions, as arrays.

use crate::arrays::{matrix, numbers, per_joint, rows, rows_or_none};
use crate::errors::usage;
use crate::value::counted;
use handstand::log::LEAST_ROWS;
use handstand::motion::MotionSource;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::cmp::Ordering;
use std::path::PathBuf;

/// Any object.
type Object<'py> = Bound<'py, PyAny>;

/// A motion, in SI and the log's convention of angles.
///
/// Parameters
/// ----------
/// time_s : array of shape (samples,)
///     Times, s, increasing.
/// position_rad : array of shape (joints, samples), or (samples,) of one joint
///     Measured angles, rad (m of a slide). Not-a-number is a gap: nothing is compared there.
/// input : array of the same shape, or a list with `None` for passive joints
///     What each drive is told, in SI of its kind (N m, duty, rad, rad/s), without gaps.
/// velocity_rad_s, rate_rad_s : as `input`
///     Measured speeds, and what rate sensors beside those of the angles read, rad/s.
/// supply_v : array of shape (samples,)
///     Supply, V.
/// torque_on : list of bool
///     Whether the drives are energised, at each sample.
/// payload_kg : float
///     Known mass bolted to the last link, kg.
/// turned : bool
///     Whether the rig stood turned by 180 degrees about the vertical.
/// name : str
///     For reports.
///
/// Columns of shape (samples, 1) are taken for one joint. Motions are equal where they hold the
/// same samples, gaps included, under one name.
#[pyclass(frozen, module = "handstand")]
#[derive(Debug, Clone)]
pub struct Motion {
    pub inner: handstand::motion::Motion,
}

#[pymethods]
impl Motion {
    #[new]
    #[pyo3(signature = (time_s, position_rad, *, input=None, velocity_rad_s=None, rate_rad_s=None,
                        supply_v=None, torque_on=None, payload_kg=0.0, turned=false,
                        name="motion", _source=None),
           text_signature = "(time_s, position_rad, *, input=None, velocity_rad_s=None, \
                             rate_rad_s=None, supply_v=None, torque_on=None, payload_kg=0.0, \
                             turned=False, name='motion')")]
    #[expect(
        clippy::too_many_arguments,
        reason = "keywords of a Python constructor"
    )]
    fn new(
        time_s: &Bound<'_, PyAny>,
        position_rad: &Bound<'_, PyAny>,
        input: Option<&Bound<'_, PyAny>>,
        velocity_rad_s: Option<&Bound<'_, PyAny>>,
        rate_rad_s: Option<&Bound<'_, PyAny>>,
        supply_v: Option<&Bound<'_, PyAny>>,
        torque_on: Option<Vec<bool>>,
        payload_kg: f64,
        turned: bool,
        name: &str,
        _source: Option<(PathBuf, String, usize, usize)>,
    ) -> PyResult<Motion> {
        let time_s = numbers("time_s", time_s)?;
        let samples = time_s.len();
        let position_rad = rows("position_rad", position_rad, Some(samples))?;
        let joints = position_rad.len();
        let (path, sha256, first, last) =
            _source.unwrap_or((name.into(), String::new(), 1, samples));
        let inner = handstand::motion::Motion {
            name: name.to_string(),
            source: MotionSource {
                path,
                sha256,
                lines: (first, last),
            },
            time_s,
            position_rad,
            velocity_rad_s: rows_or_none("velocity_rad_s", velocity_rad_s, joints, samples)?,
            rate_rad_s: rows_or_none("rate_rad_s", rate_rad_s, joints, samples)?,
            input: rows_or_none("input", input, joints, samples)?,
            supply_v: supply_v
                .map(|given| numbers("supply_v", given))
                .transpose()?,
            torque_on,
            payload_kg,
            turned,
        };
        Motion::of(inner)
    }

    /// What it is called in reports.
    #[getter]
    fn name(&self) -> &str {
        &self.inner.name
    }

    /// Time of each sample, s.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.inner.time_s)
    }

    /// Measured angles, rad: shape (joints, samples), not-a-number where not measured.
    #[getter]
    fn position_rad<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, &self.inner.position_rad)
    }

    /// Per joint: measured speeds, rad/s, where logged.
    #[getter]
    fn velocity_rad_s<'py>(&self, py: Python<'py>) -> Vec<Option<Bound<'py, PyArray1<f64>>>> {
        per_joint(py, &self.inner.velocity_rad_s)
    }

    /// Per joint: what a rate sensor of its own reads, rad/s, where it has one beside the angle's.
    #[getter]
    fn rate_rad_s<'py>(&self, py: Python<'py>) -> Vec<Option<Bound<'py, PyArray1<f64>>>> {
        per_joint(py, &self.inner.rate_rad_s)
    }

    /// Per joint: what the drive was told; `None` of a passive joint.
    #[getter]
    fn input<'py>(&self, py: Python<'py>) -> Vec<Option<Bound<'py, PyArray1<f64>>>> {
        per_joint(py, &self.inner.input)
    }

    /// Supply, V, where logged.
    #[getter]
    fn supply_v<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let supply = self.inner.supply_v.as_ref();
        supply.map(|supply| PyArray1::from_slice(py, supply))
    }

    /// Known mass bolted to the last link, kg.
    #[getter]
    fn payload_kg(&self) -> f64 {
        self.inner.payload_kg
    }

    /// Whether the drives were energised, at each sample, where logged.
    #[getter]
    fn torque_on(&self) -> Option<Vec<bool>> {
        self.inner.torque_on.clone()
    }

    /// Whether the rig stood turned by 180 degrees about the vertical.
    #[getter]
    fn turned(&self) -> bool {
        self.inner.turned
    }

    fn __eq__(&self, other: PyRef<'_, Motion>) -> bool {
        self.inner.name == other.inner.name && self.inner.holds_the_same(&other.inner)
    }

    /// Copies and pickles carry every sample, and the file that it came from.
    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Object<'py>, (Object<'py>, Object<'py>))> {
        let (py, own) = (slf.py(), slf.get());
        let source = &own.inner.source;
        let path = source.path.to_string_lossy().into_owned();
        let given = PyDict::new(py);
        for key in [
            "input",
            "velocity_rad_s",
            "rate_rad_s",
            "supply_v",
            "torque_on",
        ] {
            given.set_item(key, slf.getattr(key)?)?;
        }
        given.set_item("payload_kg", own.inner.payload_kg)?;
        given.set_item("turned", own.inner.turned)?;
        given.set_item("name", &own.inner.name)?;
        let (first, last) = source.lines;
        given.set_item("_source", (path, &source.sha256, first, last))?;
        let partial = py.import("functools")?.getattr("partial")?;
        let made = partial.call((slf.get_type(),), Some(&given))?;
        Ok((made, (slf.getattr("time_s")?, slf.getattr("position_rad")?)))
    }

    fn __len__(&self) -> usize {
        self.inner.len()
    }

    fn __repr__(&self) -> String {
        let joints = self.inner.position_rad.len();
        format!(
            "<Motion {:?}: {}, {} samples, {:.2} s>",
            self.inner.name,
            counted(joints, "joint"),
            self.inner.len(),
            self.inner.duration_s()
        )
    }
}

impl Motion {
    /// A motion as the library has it, with a place for every joint's rate.
    pub fn read(mut inner: handstand::motion::Motion) -> Motion {
        inner.rate_rad_s.resize(inner.position_rad.len(), None);
        Motion { inner }
    }

    /// A motion whose arrays belong together.
    pub fn of(inner: handstand::motion::Motion) -> PyResult<Motion> {
        is_whole(&inner)?;
        Ok(Motion { inner })
    }
}

/// Refuses arrays that make no motion.
fn is_whole(motion: &handstand::motion::Motion) -> PyResult<()> {
    let samples = motion.time_s.len();
    if samples < LEAST_ROWS {
        return Err(usage(
            format!("{samples} samples are no motion"),
            format!("give at least {LEAST_ROWS}"),
        ));
    }
    let increases = |pair: &[f64]| pair[0].partial_cmp(&pair[1]) == Some(Ordering::Less);
    if let Some(at) = motion.time_s.windows(2).position(|pair| !increases(pair)) {
        return Err(usage(
            format!("`time_s` does not increase after sample {at}"),
            "sort the samples, and leave out those that stand there twice",
        ));
    }
    let joints = motion.position_rad.len();
    let per_joint = [
        ("velocity_rad_s", &motion.velocity_rad_s),
        ("rate_rad_s", &motion.rate_rad_s),
        ("input", &motion.input),
    ];
    for (name, rows) in per_joint {
        if rows.len() != joints {
            return Err(usage(
                format!(
                    "`{name}` has {} for {}",
                    counted(rows.len(), "row"),
                    counted(joints, "joint")
                ),
                "give a row per joint, and None for joints without",
            ));
        }
    }
    let rows = motion.position_rad.iter().map(|row| ("position_rad", row));
    let rows = rows
        .chain(
            per_joint
                .into_iter()
                .flat_map(|(name, rows)| rows.iter().flatten().map(move |row| (name, row))),
        )
        .chain(motion.supply_v.iter().map(|row| ("supply_v", row)));
    let flags = motion
        .torque_on
        .as_ref()
        .map(|flags| ("torque_on", flags.len()));
    for (name, length) in rows.map(|(name, row)| (name, row.len())).chain(flags) {
        if length != samples {
            return Err(usage(
                format!("`{name}` has {length} samples, `time_s` {samples}"),
                "all arrays of a motion are of one length",
            ));
        }
    }
    let infinite = |row: &Vec<f64>| row.iter().any(|value| value.is_infinite());
    let measured = motion
        .position_rad
        .iter()
        .chain(motion.velocity_rad_s.iter().flatten())
        .chain(motion.rate_rad_s.iter().flatten());
    if motion.time_s.iter().any(|time| !time.is_finite())
        || measured.chain(&motion.supply_v).any(infinite)
    {
        return Err(usage(
            format!("motion {:?} holds infinite values", motion.name),
            "give numbers; what was not measured is not-a-number",
        ));
    }
    // An input holds from its sample to the next: what a drive was told has no gap.
    if motion
        .input
        .iter()
        .flatten()
        .flatten()
        .any(|told| !told.is_finite())
    {
        return Err(usage(
            "`input` holds what is no number",
            "say what each drive was told at every sample, or cut the motion there",
        ));
    }
    if motion.payload_kg.is_finite() && motion.payload_kg >= 0.0 {
        Ok(())
    } else {
        Err(usage(
            format!("a payload of {} kg", motion.payload_kg),
            "give 0 or more",
        ))
    }
}
