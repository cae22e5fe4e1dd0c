//! Logs that are tables of numbers already: MCAP, rosbag2, MATLAB, Parquet.
//!
//! Each becomes columns by name, which the model file then reads as it reads those of CSV. A value
//! that is not there is not a number. Sizes that a file states are believed only as far as its
//! bytes can bear them.
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

use super::foreign::{HEAD, foreign};
use super::format::LogFormat;
use crate::error::{Error, Place, Result};
use crate::output::number::hex;
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
    /// Numbers for the whole file.
    pub constants: Vec<(String, f64)>,
    /// Columns that hold no numbers a row, and what they hold.
    pub left_out: Vec<(String, Cow<'static, str>)>,
    /// What looks wrong with the file, and what to do about it.
    pub warning: Option<(&'static str, &'static str)>,
    /// Whether the format says that angles are rad, speeds rad/s and torques N m.
    pub is_si: bool,
    /// SHA-256 of the file, lower-case hexadecimal.
    pub sha256: String,
}

impl LogTable {
    /// Reads a file in one of these formats; `time` names its column of time, where it is known:
    /// a file of variables of several lengths gives those as long as that.
    ///
    /// # Errors
    /// What the system refuses, and what is no such file.
    pub fn read(path: &Path, format: LogFormat, time: Option<&str>) -> Result<LogTable> {
        let refused = |source| Error::file(path, "read", source);
        let length = std::fs::metadata(path).map_err(refused)?.len();
        let file = TableFile { path };
        if length > LARGEST {
            return Err(file.wrong("more than 4 GiB", "cut the log into shorter ones"));
        }
        let bytes = Bytes::from(std::fs::read(path).map_err(refused)?);
        if let Some(error) = foreign(path, &bytes[..bytes.len().min(HEAD)], format) {
            return Err(error);
        }
        let digest = || hex(Sha256::digest(&bytes));
        let (table, sha256) = rayon::join(|| Self::of(bytes.clone(), file, format, time), digest);
        Ok(LogTable { sha256, ..table? })
    }

    /// Reads the bytes of a file.
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
            LogFormat::Csv | LogFormat::Bam => Err(file.wrong("not a table", "name a log")),
        }
    }

    /// Rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }
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
