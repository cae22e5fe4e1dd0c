//! A log's columns as they stand in the file, before a model says what they mean.

use super::bam::{self, BamBench};
use super::format::LogFormat;
use super::header::{LogHeader, fields, number};
use super::iso::iso_ns;
use super::lines::Lines;
use super::request::LogRequest;
use super::table::LogTable;
use crate::error::{Error, Place, Result};
use std::path::Path;

/// Columns of a log.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RawLog {
    /// Names, in the file's order.
    pub names: Vec<String>,
    /// Values of each column; not a number where a cell is none.
    pub columns: Vec<Vec<f64>>,
    /// Whether the column holds ISO 8601 time stamps; its values count in s from the first.
    pub iso: Vec<bool>,
}

impl RawLog {
    /// Reads a log of any format.
    ///
    /// # Errors
    /// A file without a header, or that is no text.
    pub fn read(path: &Path) -> Result<RawLog> {
        match LogFormat::of(path) {
            LogFormat::Bam => Ok(of_bam(bam::read(
                &LogRequest::whole(path),
                None,
                &mut BamBench::default(),
            )?)),
            LogFormat::Csv => read_csv(path),
            format => {
                let table = LogTable::read(path, format)?;
                Ok(RawLog {
                    iso: vec![false; table.names.len()],
                    names: table.names,
                    columns: table.columns,
                })
            }
        }
    }

    /// Reads the rows asked for.
    ///
    /// # Errors
    /// As [`RawLog::read`]; rows beyond the file.
    pub fn read_request(request: &LogRequest) -> Result<RawLog> {
        let mut log = RawLog::read(&request.path)?;
        let rows = log.columns.first().map_or(0, Vec::len);
        if let Some(reason) = request.beyond(rows) {
            return Err(Error::refused(Place::file(&request.path), reason));
        }
        if let Some((first, last)) = request.rows {
            log.columns
                .iter_mut()
                .for_each(|column| *column = column[first..=last].to_vec());
        }
        Ok(log)
    }

    /// As CSV: what is not a number is an empty cell.
    pub fn to_csv(&self) -> String {
        let mut rows = ::csv::Writer::from_writer(Vec::new());
        // Writing to memory does not fail, and every record is as long as the header.
        let _ = rows.write_record(&self.names);
        for row in 0..self.columns.first().map_or(0, Vec::len) {
            let cell = |column: &Vec<f64>| match column[row] {
                value if value.is_finite() => value.to_string(),
                _ => String::new(),
            };
            let _ = rows.write_record(self.columns.iter().map(cell));
        }
        String::from_utf8_lossy(&rows.into_inner().unwrap_or_default()).into_owned()
    }

    /// The first column that is called a time, else the first that only grows.
    pub fn time(&self) -> Option<usize> {
        let named = |name: &String| {
            let name = name.to_lowercase();
            name == "t" || name.starts_with("time") || name.starts_with("t_")
        };
        let grows =
            |column: &Vec<f64>| column.len() > 1 && column.windows(2).all(|pair| pair[1] > pair[0]);
        let named = self.names.iter().position(named);
        named.or_else(|| self.columns.iter().position(grows))
    }
}

fn read_csv(path: &Path) -> Result<RawLog> {
    let mut lines = Lines::open(path)?;
    let (header, first) = LogHeader::read(path, &mut lines, "")?;
    let mut log = RawLog {
        columns: vec![Vec::new(); header.names.len()],
        iso: vec![false; header.names.len()],
        names: header.names,
    };
    let mut first_ns = vec![None; log.names.len()];
    let mut take = |line: &str| {
        let cells = fields(line, header.separator);
        for (index, column) in log.columns.iter_mut().enumerate() {
            let value = cells
                .get(index)
                .and_then(|cell| match number(cell, header.separator) {
                    None if log.iso[index] || column.is_empty() => {
                        let stamp_ns = iso_ns(cell)?;
                        log.iso[index] = true;
                        let first_ns = *first_ns[index].get_or_insert(stamp_ns);
                        Some(stamp_ns.saturating_sub(first_ns) as f64 / 1e9)
                    }
                    value => value,
                });
            column.push(value.unwrap_or(f64::NAN));
        }
    };
    if let Some(line) = first {
        take(&line);
    }
    while let Some(line) = lines.next()? {
        if !line.trim().is_empty() && !line.trim_start().starts_with('#') {
            take(line);
        }
    }
    Ok(log)
}

fn of_bam(motion: super::Motion) -> RawLog {
    let mut log = RawLog::default();
    let mut push = |name: &str, column: Option<Vec<f64>>| {
        if let Some(column) = column {
            log.names.push(name.into());
            log.iso.push(false);
            log.columns.push(column);
        }
    };
    push("timestamp", Some(motion.time_s));
    push("position", motion.position_rad.into_iter().next());
    push("goal_position", motion.input.into_iter().next().flatten());
    push("speed", motion.velocity_rad_s.into_iter().next().flatten());
    push("input_volts", motion.supply_v);
    log
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_come_as_they_stand() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        std::fs::write(&path, "q;<b>;time_ms\n1,5;x;0\n\n# note\n2;3;10\n").unwrap();
        let log = RawLog::read(&path).unwrap();
        assert_eq!(log.names, ["q", "<b>", "time_ms"]);
        assert_eq!(log.columns[0], [1.5, 2.0]);
        assert!(log.columns[1][0].is_nan() && log.columns[1][1] == 3.0);
        assert_eq!(log.time(), Some(2));
        assert_eq!(log.iso, [false; 3]);
    }

    #[test]
    fn time_stamps_count_from_the_first() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        let text = "stamp,q\n2026-03-01T12:00:00.25Z,1\n2026-03-01T13:00:00.5+01:00,2\n";
        std::fs::write(&path, text).unwrap();
        let log = RawLog::read(&path).unwrap();
        assert_eq!(log.columns[0], [0.0, 0.25]);
        assert_eq!(log.iso, [true, false]);
    }
}
