//! Recordings as text: `time_s`, then per servo `q1_rad`, `dq1_rad_s`, `load1`, `goal1_rad`,
//! `supply1_v`, `temperature1_celsius`, `error1`, and `current1_a` where servos measure it; where a
//! CM-5 reads the servos, `gyro_code`, `gyro_zero`, `gyro_rad_s` behind them; and `torque_on`,
//! where that is known. What a servo did not say is an empty field.
//!
//! Columns are read by name, in any order; others are left alone. So any table with `time_s` and
//! `goal1_rad` is a motion.

use super::recorder::Writer;
use super::sample::{GyroSample, RobotSample, ServoSample};
use crate::error::{Error, Place, Result};
use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::Path;

/// Columns that not every recording has.
#[derive(Debug, Clone, Copy, Default)]
struct Columns {
    current: bool,
    gyro: bool,
    torque: bool,
}

/// Writes row by row, each with one call to the system: a killed program leaves whole rows.
pub(super) struct CsvWriter {
    file: File,
    row: String,
    ids: Vec<u8>,
    /// Which columns there are besides, once the header is written.
    has: Option<Columns>,
}

impl CsvWriter {
    /// The header follows with the first sample, which says whether there is a gyro.
    pub fn new(file: File, ids: &[u8]) -> Self {
        CsvWriter {
            file,
            row: String::new(),
            ids: ids.to_vec(),
            has: None,
        }
    }

    fn begin(&mut self, has: Columns) -> std::io::Result<()> {
        let mut header = String::from("time_s");
        for id in &self.ids {
            for (before, behind) in of_servo(ServoSample::NAMES, has) {
                // Writing to a string does not fail.
                let _ = write!(header, ",{before}{id}{behind}");
            }
        }
        for name in GyroSample::NAMES.iter().filter(|_| has.gyro) {
            let _ = write!(header, ",{name}");
        }
        header += if has.torque { ",torque_on\n" } else { "\n" };
        self.has = Some(has);
        self.file.write_all(header.as_bytes())
    }
}

impl Writer for CsvWriter {
    fn write(&mut self, sample: &RobotSample) -> std::io::Result<()> {
        let has = Columns {
            current: sample.has_current,
            gyro: sample.gyro.is_some(),
            torque: sample.torque_on.is_some(),
        };
        if self.has.is_none() {
            self.begin(has)?;
        }
        let has = self.has.unwrap_or(has);
        let gyro = sample.gyro.map_or([None; 3], |gyro| gyro.values());
        let gyro = gyro.into_iter().filter(|_| has.gyro);
        let torque = sample.torque_on.map(|on| f64::from(u8::from(on)));
        let torque = std::iter::once(torque).filter(|_| has.torque);
        self.row.clear();
        let _ = write!(self.row, "{:.6}", sample.time_s);
        for value in sample
            .joints
            .iter()
            .flat_map(|joint| of_servo(joint.values(), has))
            .chain(gyro)
            .chain(torque)
        {
            self.row.push(',');
            if let Some(value) = value {
                // Six digits behind the point are 1000 times finer than any register.
                let rounded = (value * 1e6).round() / 1e6;
                let _ = write!(self.row, "{}", rounded + 0.0);
            }
        }
        self.row.push('\n');
        self.file.write_all(self.row.as_bytes())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }

    fn finish(&mut self) -> std::io::Result<()> {
        match self.has {
            Some(_) => Ok(()),
            None => self.begin(Columns::default()),
        }
    }
}

/// Those of a servo's columns that the recording has: current comes last.
fn of_servo<T>(all: [T; 8], has: Columns) -> impl Iterator<Item = T> {
    all.into_iter().take(if has.current { 8 } else { 7 })
}

/// Where each quantity stands in a row.
struct RecordingLayout {
    fields: usize,
    time: usize,
    ids: Vec<u8>,
    /// Per servo, in the order of [`ServoSample::NAMES`].
    joints: Vec<[Option<usize>; 8]>,
    gyro: [Option<usize>; 3],
    torque_on: Option<usize>,
}

impl RecordingLayout {
    /// By the names of the header; none without a time and a servo's angles or goals.
    fn of(header: &str) -> Option<RecordingLayout> {
        let names: Vec<&str> = header.split(',').map(str::trim).collect();
        let at = |wanted: &str| names.iter().position(|name| *name == wanted);
        let mut ids: Vec<u8> = Vec::new();
        for name in &names {
            let id = ["q", "goal"].iter().find_map(|before| {
                let id = name.strip_prefix(before)?.strip_suffix("_rad")?;
                id.parse().ok()
            });
            ids.extend(id.filter(|id| !ids.contains(id)));
        }
        let of_servo = |id: &u8| {
            ServoSample::NAMES.map(|(before, behind)| at(&format!("{before}{id}{behind}")))
        };
        (!ids.is_empty()).then_some(RecordingLayout {
            fields: names.len(),
            time: at("time_s")?,
            joints: ids.iter().map(of_servo).collect(),
            ids,
            gyro: GyroSample::NAMES.map(at),
            torque_on: at("torque_on"),
        })
    }

    fn sample(&self, values: &[Option<f64>]) -> RobotSample {
        let value = |at: Option<usize>| at.and_then(|at| values[at]);
        let joints = self.joints.iter();
        RobotSample {
            time_s: values[self.time].unwrap_or(0.0),
            joints: joints.map(|own| ServoSample::of(own.map(value))).collect(),
            gyro: GyroSample::of(self.gyro.map(value)),
            torque_on: value(self.torque_on).map(|on| on != 0.0),
            has_current: self.joints.iter().any(|own| own[7].is_some()),
        }
    }

    /// The values of a row; empty fields, and those of columns that nothing is read from, are none.
    fn values(&self, row: &str, path: &Path, line: usize) -> Result<Vec<Option<f64>>> {
        let fields: Vec<&str> = row.split(',').map(str::trim).collect();
        let damaged = |column: usize, what: String| {
            Error::data(
                Place::at(path, line, column),
                what,
                "the line is damaged: delete it",
            )
        };
        if fields.len() != self.fields {
            let (found, expected) = (fields.len(), self.fields);
            let what = format!("{found} fields where the header has {expected}");
            return Err(damaged(found, what));
        }
        let joints = self.joints.iter().flatten();
        let others = self.gyro.iter().chain([&self.torque_on]);
        let mut values = vec![None; fields.len()];
        for at in joints.chain(others).copied().flatten().chain([self.time]) {
            values[at] = match (fields[at], fields[at].parse::<f64>()) {
                ("", _) if at != self.time => None,
                (_, Ok(value)) if value.is_finite() => Some(value),
                (field, _) => return Err(damaged(at + 1, format!("`{field}` is not a number"))),
            };
        }
        Ok(values)
    }
}

/// Ids, samples, and whether a torn last row was dropped.
pub(super) fn read(text: &str, path: &Path) -> Result<(Vec<u8>, Vec<RobotSample>, bool)> {
    let whole = text.rfind('\n').map_or(0, |end| end + 1);
    let mut lines = text[..whole].lines();
    let Some(layout) = RecordingLayout::of(lines.next().unwrap_or("")) else {
        let what = "this is no recording: its first line must name `time_s` and servos, as \
                    `q1_rad` or `goal1_rad`";
        return Err(Error::data(
            Place::at(path, 1, 1),
            what,
            "give a file that `handstand record` or `handstand excite` wrote",
        ));
    };
    let mut samples = Vec::new();
    for (line, row) in (2..).zip(lines) {
        samples.push(layout.sample(&layout.values(row, path, line)?));
    }
    Ok((layout.ids, samples, whole < text.len()))
}
