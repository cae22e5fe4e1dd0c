//! Recordings as text: `time_s`, then per servo `q1_rad`, `dq1_rad_s`, `load1`, `goal1_rad`,
//! `supply1_v`, `temperature1_celsius`, `error1`. What a servo did not say is an empty field.

use super::recorder::Writer;
use super::sample::{RobotSample, ServoSample};
use crate::error::{Error, Place, Result};
use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::Path;

/// Writes row by row, each with one call to the system: a killed program leaves whole rows.
pub(super) struct CsvWriter {
    file: File,
    row: String,
}

impl CsvWriter {
    /// Writes the header.
    pub fn new(mut file: File, ids: &[u8]) -> std::io::Result<Self> {
        let mut header = String::from("time_s");
        for id in ids {
            for (before, behind) in ServoSample::NAMES {
                // Writing to a string does not fail.
                let _ = write!(header, ",{before}{id}{behind}");
            }
        }
        header.push('\n');
        file.write_all(header.as_bytes())?;
        Ok(CsvWriter {
            file,
            row: String::new(),
        })
    }
}

impl Writer for CsvWriter {
    fn write(&mut self, sample: &RobotSample) -> std::io::Result<()> {
        self.row.clear();
        let _ = write!(self.row, "{:.6}", sample.time_s);
        for value in sample.joints.iter().flat_map(ServoSample::values) {
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
        Ok(())
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
    if header.first() != Some(&"time_s")
        || ids.is_empty()
        || header.len() != 1 + per_joint * ids.len()
    {
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
            joints: values[1..].chunks(per_joint).map(joint).collect(),
        });
    }
    Ok((ids, samples, whole < text.len()))
}
