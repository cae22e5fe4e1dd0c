//! Every log as one table: columns by name, of which a model file says what they mean.
//!
//! A value that is not there is not a number. Sizes that a file states are believed only as far as
//! its bytes can bear them.
#![cfg_attr(
    not(all(feature = "matlab", feature = "parquet", feature = "ros")),
    allow(
        dead_code,
        unused_variables,
        reason = "what formats share is for those that are there"
    )
)]

#[cfg(feature = "ros")]
mod joint_states;
#[cfg(feature = "matlab")]
mod mat;
#[cfg(feature = "ros")]
mod mcap;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(feature = "ros")]
mod rosbag;
#[cfg(feature = "ros")]
mod sqlite;
#[cfg(all(test, feature = "matlab", feature = "parquet", feature = "ros"))]
mod tests;
mod text;

pub(super) use text::TextCells;

use super::bam::{self, BenchFigures};
use super::cell::{is_missing, number};
use super::csv;
use super::fault::RowFault;
use super::foreign::{HEAD, foreign};
use super::format::LogFormat;
use crate::error::{Error, Place, Result};
use crate::model::LogColumns;
use crate::output::number::hex;
use crate::output::shortened;
use bytes::Bytes;
use sha2::{Digest, Sha256};
use std::borrow::Cow;
use std::path::Path;

/// Largest file that is read whole, bytes.
const LARGEST: u64 = 4 << 30;
/// Most numbers of a table: 1.6 GB.
pub(super) const MOST_CELLS: usize = 200_000_000;

/// What is wrong with a file.
pub(super) type Broken = &'static str;

/// A log as columns.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct LogTable {
    /// In the file's order.
    pub names: Vec<String>,
    /// As long as each other.
    pub columns: Vec<Vec<f64>>,
    /// Numbers for the whole file, and the line that says them.
    pub constants: Vec<(String, f64, usize)>,
    /// Columns that hold no numbers a row, and what they hold.
    pub left_out: Vec<(String, Cow<'static, str>)>,
    /// What looks wrong with the file, and what to do about it.
    pub warning: Option<(&'static str, &'static str)>,
    /// Whether the format says that angles are rad, speeds rad/s and torques N m.
    pub is_si: bool,
    /// The bench that recorded it, where the file says.
    pub bench: Option<BenchFigures>,
    /// SHA-256 of the file, lower-case hexadecimal.
    pub sha256: String,
    /// The first row's number in the file.
    pub first: usize,
    /// Whether rows are entries of a list, which have no line and column.
    pub is_entries: bool,
    /// What text says beyond numbers.
    pub text: Option<TextCells>,
}

/// Where a quantity's value comes from.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum LogCell {
    /// Field of each row, counted from 0.
    Field(usize),
    /// One number for the whole file, from the comment on this line.
    Constant(f64, usize),
}

impl LogCell {
    /// The field counted from 1, as places count; 1 for a constant.
    pub fn column(&self) -> usize {
        match self {
            LogCell::Field(index) => index + 1,
            LogCell::Constant(..) => 1,
        }
    }
}

impl LogTable {
    /// Reads a file of any format; `columns` are the model's, where they are known: of variables of
    /// several lengths those as long as its time are given, of text its flags as they are written.
    ///
    /// # Errors
    /// What the system refuses, and what is no such file.
    pub fn read(path: &Path, format: LogFormat, columns: Option<&LogColumns>) -> Result<LogTable> {
        if format == LogFormat::Csv {
            return csv::read(path, columns);
        }
        let bytes = LogTable::bytes(path, format)?;
        let time = columns.map(|columns| columns.time.name.as_str());
        let digest = || hex(Sha256::digest(&bytes));
        let read = || Self::of(bytes.clone(), TableFile { path }, format, time);
        let (table, sha256) = rayon::join(read, digest);
        Ok(LogTable { sha256, ..table? })
    }

    /// The bytes of a file of this format.
    ///
    /// # Errors
    /// What the system refuses; more than 4 GiB; the file of another format.
    pub fn bytes(path: &Path, format: LogFormat) -> Result<Bytes> {
        let refused = |source| Error::file(path, "read", source);
        let length = std::fs::metadata(path).map_err(refused)?.len();
        if length > LARGEST {
            let remedy = "cut the log into shorter ones";
            return Err(TableFile { path }.wrong("more than 4 GiB", remedy));
        }
        let bytes = Bytes::from(std::fs::read(path).map_err(refused)?);
        match foreign(path, &bytes[..bytes.len().min(HEAD)], format) {
            Some(error) => Err(error),
            None => Ok(bytes),
        }
    }

    /// Reads the bytes of a file that is no text.
    ///
    /// # Errors
    /// What is no such file.
    pub fn of(
        bytes: Bytes,
        file: TableFile,
        format: LogFormat,
        time: Option<&str>,
    ) -> Result<LogTable> {
        match format {
            #[cfg(feature = "ros")]
            LogFormat::Mcap => mcap::read(&bytes, file),
            #[cfg(feature = "matlab")]
            LogFormat::Mat => mat::read(bytes, file, time),
            #[cfg(feature = "ros")]
            LogFormat::Rosbag => rosbag::read(&bytes, file),
            #[cfg(feature = "parquet")]
            LogFormat::Parquet => parquet::read(bytes, file),
            #[cfg(not(feature = "matlab"))]
            LogFormat::Mat => Err(file.left_out("matlab")),
            #[cfg(not(feature = "parquet"))]
            LogFormat::Parquet => Err(file.left_out("parquet")),
            #[cfg(not(feature = "ros"))]
            LogFormat::Mcap | LogFormat::Rosbag => Err(file.left_out("ros")),
            LogFormat::Bam => bam::read_alone(&bytes, file),
            LogFormat::Csv => Err(file.wrong("not a table", "name a log")),
        }
    }

    /// Rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Where the column of this name is.
    ///
    /// # Errors
    /// No such column, with those found and the likeliest meant; a name that stands there twice.
    pub fn cell(&self, path: &Path, name: &str) -> Result<LogCell> {
        let mut found = (0..self.names.len()).filter(|&i| self.names[i] == name);
        match (found.next(), found.next()) {
            (Some(_), Some(second)) => {
                let place = Place::at(path, self.names_line(), second + 1);
                Err(Error::data(
                    place,
                    format!("column '{name}' stands there twice"),
                    "rename one of them, so that it is clear which is meant",
                ))
            }
            (Some(index), None) => Ok(LogCell::Field(index)),
            (None, _) => match self.constants.iter().find(|(key, ..)| key == name) {
                Some((_, value, line)) => Ok(LogCell::Constant(*value, *line)),
                None => Err(self.missing(path, name)),
            },
        }
    }

    fn missing(&self, path: &Path, name: &str) -> Error {
        let place = Place::at(path, self.names_line(), 1);
        if let Some((_, holds)) = self.left_out.iter().find(|(left_out, _)| left_out == name) {
            return Error::data(
                place,
                format!("column '{name}' holds {holds}"),
                "name a column of numbers, or save this one as numbers",
            );
        }
        let plain = |name: &str| -> String {
            let letters = name.chars().filter(|letter| letter.is_alphanumeric());
            letters.flat_map(char::to_lowercase).collect()
        };
        let likeness = |known: &str| strsim::jaro_winkler(&plain(known), &plain(name));
        let constants = self.constants.iter().map(|(key, ..)| key);
        let nearest = self
            .names
            .iter()
            .chain(constants)
            .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
            .filter(|known| likeness(known) > 0.8);
        let meant = nearest.map_or(".".to_string(), |nearest| {
            format!("; did you mean '{}'?", shortened(nearest))
        });
        let remedy = format!(
            "name the column under [log] in the model, or, if it never changes, write \
             '# {name} = VALUE' above the header"
        );
        let has = listed(&self.names);
        Error::data(
            place,
            format!("no column '{name}'{meant} The log has: {has}"),
            remedy,
        )
    }

    fn names_line(&self) -> usize {
        self.text.as_ref().map_or(1, |text| text.names_line)
    }

    /// Line of a row, counted from 1; of what has none its number.
    pub fn line(&self, row: usize) -> usize {
        match &self.text {
            Some(text) => text.lines[row],
            None => self.first + row + 1,
        }
    }

    /// What is wrong with a row as a whole, and the field that shows it, counted from 1.
    pub fn fault(&self, row: usize) -> Option<(usize, RowFault)> {
        self.text.as_ref()?.fault_of(row)
    }

    fn written(&self, row: usize, column: usize) -> Option<&str> {
        self.text.as_ref()?.written(row, column)
    }

    /// The number in a cell, if one is.
    pub fn number(&self, row: usize, column: usize) -> Option<f64> {
        match (&self.text, self.written(row, column)) {
            (Some(text), Some(written)) => number(written, text.separator),
            _ => Some(self.columns[column][row]).filter(|value| !value.is_nan()),
        }
    }

    /// A cell as it is written.
    pub fn text(&self, row: usize, column: usize) -> Cow<'_, str> {
        match (self.written(row, column), self.columns[column][row]) {
            (Some(written), _) => written.into(),
            (None, value) if value.is_nan() => "".into(),
            (None, value) => value.to_string().into(),
        }
    }

    /// Whether a cell says that there is no value.
    pub fn is_gap(&self, row: usize, column: usize) -> bool {
        match self.written(row, column) {
            Some(written) => is_missing(written),
            None => self.columns[column][row].is_nan(),
        }
    }
}

/// Up to 40 names.
fn listed(names: &[String]) -> String {
    let shown: Vec<Cow<str>> = names
        .iter()
        .take(40)
        .map(|name| match name.as_str() {
            "" => "(unnamed)".into(),
            name => shortened(name),
        })
        .collect();
    let more = if names.len() > 40 { ", ..." } else { "" };
    format!("{}{more}", shown.join(", "))
}

/// The file, for errors.
#[derive(Debug, Clone, Copy)]
pub(super) struct TableFile<'a> {
    pub path: &'a Path,
}

impl TableFile<'_> {
    /// The file is refused.
    pub fn wrong(&self, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::data(Place::file(self.path), what, remedy)
    }

    /// Its format is one that this build cannot read.
    #[cfg(not(all(feature = "matlab", feature = "parquet", feature = "ros")))]
    fn left_out(&self, feature: &str) -> Error {
        self.wrong(
            "a format that this build leaves out",
            format!("build it with the cargo feature `{feature}`, which is on by default"),
        )
    }
}

/// Whole numbers as they stand; where a double could not hold them to the last digit, counted from
/// the first, for then they are times.
pub(super) fn from_integers(values: &[i64]) -> Vec<f64> {
    const EXACT: u64 = 1 << 53;
    let first = if values.iter().any(|value| value.unsigned_abs() > EXACT) {
        values[0]
    } else {
        0
    };
    values
        .iter()
        .map(|value| value.wrapping_sub(first) as f64)
        .collect()
}

/// Likewise, of numbers without a sign.
pub(super) fn from_unsigned(values: &[u64]) -> Vec<f64> {
    let whole: std::result::Result<Vec<i64>, _> =
        values.iter().map(|value| i64::try_from(*value)).collect();
    let Ok(whole) = whole else {
        let from_first = |value: &u64| value.wrapping_sub(values[0]) as i64 as f64;
        return values.iter().map(from_first).collect();
    };
    from_integers(&whole)
}
