//! Recordings as text: `time_s`, then per servo `q1_rad`, `dq1_rad_s`, `load1`, `goal1_rad`,
//! `supply1_v`, `temperature1_celsius`, `error1`; where a CM-5 reads the servos, `gyro_code`,
//! `gyro_zero`, `gyro_rad_s` behind them. What a servo did not say is an empty field.

use super::recorder::Writer;
use super::sample::{GyroSample, RobotSample, ServoSample};
use crate::error::{Error, Place, Result};
use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::Path;

/// Writes row by row, each with one call to the system: a killed program leaves whole rows.
pub(super) struct CsvWriter {
    file: File,
    row: String,
    ids: Vec<u8>,
    /// Whether there are columns of a gyro, once the header is written.
    has_gyro: Option<bool>,
}

impl CsvWriter {
    /// The header follows with the first sample, which says whether there is a gyro.
    pub fn new(file: File, ids: &[u8]) -> Self {
        CsvWriter {
            file,
            row: String::new(),
            ids: ids.to_vec(),
            has_gyro: None,
        }
    }

    fn begin(&mut self, has_gyro: bool) -> std::io::Result<()> {
        let mut header = String::from("time_s");
        for id in &self.ids {
            for (before, behind) in ServoSample::NAMES {
                // Writing to a string does not fail.
                let _ = write!(header, ",{before}{id}{behind}");
            }
        }
        for name in GyroSample::NAMES.iter().filter(|_| has_gyro) {
            let _ = write!(header, ",{name}");
        }
        header.push('\n');
        self.has_gyro = Some(has_gyro);
        self.file.write_all(header.as_bytes())
    }
}

impl Writer for CsvWriter {
    fn write(&mut self, sample: &RobotSample) -> std::io::Result<()> {
        if self.has_gyro.is_none() {
            self.begin(sample.gyro.is_some())?;
        }
        let gyro = sample.gyro.map_or([None; 3], |gyro| gyro.values());
        let gyro = gyro.into_iter().filter(|_| self.has_gyro == Some(true));
        self.row.clear();
        let _ = write!(self.row, "{:.6}", sample.time_s);
        for value in sample
            .joints
            .iter()
            .flat_map(ServoSample::values)
            .chain(gyro)
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
        match self.has_gyro {
            Some(_) => Ok(()),
            None => self.begin(false),
        }
    }
}

/// Ids, samples, and whether a torn last row was dropped.
pub(super) fn read(text: &str, path: &Path) -> Result<(Vec<u8>, Vec<RobotSample>, bool)> {
    let whole = text.rfind('\n').map_or(0, |end| end + 1);
    let mut lines = text[..whole].lines();
    let header: Vec<&str> = lines.next().unwrap_or("").split(',').collect();
    let ids: Vec<u8> = header
        .iter()
        .filter_map(|name| name.strip_prefix('q')?.strip_suffix("_rad")?.parse().ok())
        .collect();
    let per_joint = ServoSample::NAMES.len();
    let of_joints = 1 + per_joint * ids.len();
    let has_gyro = header.ends_with(&GyroSample::NAMES);
    let of_gyro = if has_gyro { GyroSample::NAMES.len() } else { 0 };
    if header.first() != Some(&"time_s") || ids.is_empty() || header.len() != of_joints + of_gyro {
        let what = "this is no recording: its first line must begin `time_s,q1_rad,dq1_rad_s,..`";
        return Err(Error::data(
            Place::at(path, 1, 1),
            what,
            "give a file that `handstand record` wrote",
        ));
    }
    let mut samples = Vec::new();
    for (line, row) in (2..).zip(lines) {
        let fields: Vec<&str> = row.split(',').collect();
        let place = |column| Place::at(path, line, column);
        if fields.len() != header.len() {
            let what = format!(
                "{} fields where the header has {}",
                fields.len(),
                header.len()
            );
            return Err(Error::data(
                place(fields.len()),
                what,
                "the line is damaged: delete it",
            ));
        }
        let mut values = Vec::new();
        for (column, field) in (1..).zip(&fields) {
            values.push(match (*field, field.parse::<f64>()) {
                ("", _) if column > 1 => None,
                (_, Ok(value)) if value.is_finite() => Some(value),
                _ => {
                    return Err(Error::data(
                        place(column),
                        format!("`{field}` is not a number"),
                        "the line is damaged: delete it",
                    ));
                }
            });
        }
        let joint =
            |values: &[Option<f64>]| values.try_into().map(ServoSample::of).unwrap_or_default();
        samples.push(RobotSample {
            time_s: values[0].unwrap_or(0.0),
            joints: values[1..of_joints].chunks(per_joint).map(joint).collect(),
            gyro: values[of_joints..].try_into().ok().and_then(GyroSample::of),
        });
    }
    Ok((ids, samples, whole < text.len()))
}
