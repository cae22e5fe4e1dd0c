//! A log as named on the command line: a path, and the rows wanted.

use super::format::LogFormat;
use crate::error::{Error, Problem, Result};
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// A log file, whole or in part, as named on the command line: `drop.csv` or `drop.csv:26-139`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogRequest {
    /// The file as the user named it.
    pub path: PathBuf,
    /// First and last data row wanted, counted from 0 after the header; all without it.
    pub rows: Option<(usize, usize)>,
}

impl LogRequest {
    /// The whole file.
    pub fn whole(path: impl Into<PathBuf>) -> Self {
        LogRequest {
            path: path.into(),
            rows: None,
        }
    }

    /// Whether data row `number` is wanted.
    pub fn wants(&self, number: usize) -> bool {
        self.rows
            .is_none_or(|(first, last)| (first..=last).contains(&number))
    }

    /// Whether both want some row of one number.
    pub(super) fn rows_meet(&self, other: &LogRequest) -> bool {
        match (self.rows, other.rows) {
            (Some((first, last)), Some((other_first, other_last))) => {
                first <= other_last && other_first <= last
            }
            _ => true,
        }
    }

    /// Whether both name one file: `a.csv`, `./a.csv`.
    pub(super) fn is_same_file(&self, other: &LogRequest) -> bool {
        let (path, other) = (&self.path, &other.path);
        let same_name = path.file_name() == other.file_name();
        let real = |path: &Path| path.canonicalize().ok();
        path == other || (same_name && real(path).is_some_and(|own| Some(own) == real(other)))
    }

    /// Why a log of so many rows cannot give the rows wanted, if it cannot.
    pub(super) fn beyond(&self, rows: usize) -> Option<Problem> {
        let (first, last) = self.rows.filter(|(_, last)| *last >= rows)?;
        Some(Problem::new(
            format!("rows {first}-{last} asked for, but it has {rows} rows"),
            "data rows count from 0, after the header",
        ))
    }

    /// File name without its folder, and the rows where a part is wanted: `drop.csv:26-139`.
    pub fn name(&self) -> String {
        let file = self.path.file_name().unwrap_or(self.path.as_os_str());
        let file = file.to_string_lossy();
        match self.rows {
            Some((first, last)) => format!("{file}:{first}-{last}"),
            None => file.into_owned(),
        }
    }

    /// Whether it is a BAM bench's JSON, which states its own units.
    pub fn is_json(&self) -> bool {
        LogFormat::of(&self.path) == LogFormat::Bam
    }
}

impl FromStr for LogRequest {
    type Err = Error;

    /// Parses `path[:first-last]`.
    ///
    /// # Errors
    /// An empty path, a lone row number, or rows that run backwards.
    fn from_str(text: &str) -> Result<Self> {
        let is_range = |tail: &str| tail.chars().all(|c| c.is_ascii_digit() || c == '-');
        let (path, rows) = match text.rsplit_once(':') {
            Some((path, tail)) if is_range(tail) => (path, Some(range(text, tail)?)),
            _ => (text, None),
        };
        if path.is_empty() {
            return Err(Error::usage(
                format!("'{text}' names no log file"),
                "write the path of a log, such as drop.csv or drop.csv:26-139",
            ));
        }
        Ok(LogRequest {
            path: PathBuf::from(path),
            rows,
        })
    }
}

fn range(text: &str, tail: &str) -> Result<(usize, usize)> {
    let bounds = tail
        .split_once('-')
        .and_then(|(first, last)| Some((first.parse().ok()?, last.parse().ok()?)));
    match bounds {
        Some((first, last)) if first <= last => Ok((first, last)),
        _ => Err(Error::usage(
            format!("'{text}': rows '{tail}' are not a range"),
            "write the first and the last data row, counted from 0, such as drop.csv:26-139",
        )),
    }
}

impl fmt::Display for LogRequest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        match self.rows {
            Some((first, last)) => write!(f, ":{first}-{last}"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parses_paths_with_and_without_rows() {
        let request: LogRequest = "a/drop.csv:26-139".parse().unwrap();
        assert_eq!(request.path, PathBuf::from("a/drop.csv"));
        assert_eq!(request.rows, Some((26, 139)));
        assert_eq!(request.name(), "drop.csv:26-139");
        assert_eq!(request.to_string(), "a/drop.csv:26-139");
        assert!(request.wants(26) && request.wants(139) && !request.wants(140));
        assert_eq!("c:drop.csv".parse::<LogRequest>().unwrap().rows, None);
    }

    #[test]
    fn refuses_what_is_no_range() {
        for text in ["", ":1-2", "a.csv:", "a.csv:5", "a.csv:9-3", "a.csv:1-2-3"] {
            assert_eq!(
                text.parse::<LogRequest>().unwrap_err().exit_code(),
                2,
                "{text}"
            );
        }
    }
}
