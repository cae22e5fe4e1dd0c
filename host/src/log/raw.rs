//! A log's columns as they stand in the file, before a model says what they mean.

use super::bam::{self, BamBench};
use super::format::LogFormat;
use super::header::{LogHeader, fields, number};
use super::iso::iso_ns;
use super::lines::Lines;
use super::reading_limit::ReadingLimit;
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
    /// Reads a log of any format as it stands, with numbers that no sensor gives.
    ///
    /// # Errors
    /// A file without a header, or that is no text.
    pub fn read(path: &Path) -> Result<RawLog> {
        RawLog::read_checked(path, None)
    }

    /// Reads a log of any format; in the rows asked for, readings must be ones that a sensor gives.
    fn read_checked(path: &Path, checked: Option<&LogRequest>) -> Result<RawLog> {
        match LogFormat::of(path) {
            LogFormat::Bam => Ok(of_bam(bam::read(
                &LogRequest::whole(path),
                None,
                &mut BamBench::default(),
            )?)),
            LogFormat::Csv => read_csv(path, checked),
            format => {
                let table = LogTable::read(path, format)?;
                let log = RawLog {
                    iso: vec![false; table.names.len()],
                    names: table.names,
                    columns: table.columns,
                };
                if let Some(request) = checked {
                    ReadingLimit::new(request, &log.names).hold_table(&log)?;
                }
                Ok(log)
            }
        }
    }

    /// Reads the rows asked for.
    ///
    /// # Errors
    /// As [`RawLog::read`]; rows beyond the file; numbers that no sensor gives, in columns whose
    /// names tell readings.
    pub fn read_request(request: &LogRequest) -> Result<RawLog> {
        let mut log = RawLog::read_checked(&request.path, Some(request))?;
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

fn read_csv(path: &Path, checked: Option<&LogRequest>) -> Result<RawLog> {
    let mut lines = Lines::open(path)?;
    let (header, first) = LogHeader::read(path, &mut lines, "")?;
    let mut rows = CsvRows {
        limit: checked.map(|request| ReadingLimit::new(request, &header.names)),
        separator: header.separator,
        first_ns: vec![None; header.names.len()],
        log: RawLog {
            columns: vec![Vec::new(); header.names.len()],
            iso: vec![false; header.names.len()],
            names: header.names,
        },
    };
    if let Some(line) = first {
        rows.take(&line, lines.number)?;
    }
    loop {
        let at = lines.number + 1;
        match lines.next()? {
            None => return Ok(rows.log),
            Some(line) if line.trim().is_empty() || line.trim_start().starts_with('#') => {}
            Some(line) => rows.take(line, at)?,
        }
    }
}

/// Rows of text as they become columns.
struct CsvRows<'a> {
    log: RawLog,
    separator: u8,
    /// The first time stamp of each column that holds them, ns.
    first_ns: Vec<Option<i64>>,
    limit: Option<ReadingLimit<'a>>,
}

impl CsvRows<'_> {
    fn take(&mut self, line: &str, at: usize) -> Result<()> {
        let cells = fields(line, self.separator);
        for index in 0..self.log.columns.len() {
            let cell = cells.get(index).map_or("", |cell| cell);
            let value = number(cell, self.separator).or_else(|| self.stamp_s(index, cell));
            let value = value.unwrap_or(f64::NAN);
            let row = self.log.columns[index].len();
            if let Some(limit) = &self.limit {
                let name = (self.log.names[index].as_str(), index);
                limit.hold(row, at, name, value, || cell.to_string())?;
            }
            self.log.columns[index].push(value);
        }
        Ok(())
    }

    /// A time stamp, s from the column's first; none in a column that began with something else.
    fn stamp_s(&mut self, index: usize, cell: &str) -> Option<f64> {
        if !self.log.iso[index] && !self.log.columns[index].is_empty() {
            return None;
        }
        let stamp_ns = iso_ns(cell)?;
        self.log.iso[index] = true;
        let first_ns = *self.first_ns[index].get_or_insert(stamp_ns);
        Some(stamp_ns.saturating_sub(first_ns) as f64 / 1e9)
    }
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

    #[test]
    fn readings_that_no_sensor_gives_are_refused_as_elsewhere() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        let refused = |text: &str, rows| {
            std::fs::write(&path, text).unwrap();
            let path = path.clone();
            RawLog::read_request(&LogRequest { path, rows }).err()
        };
        let broken =
            "# of a bench\nstamp_ns,q1_deg\n1700000000000000000,1\n1700000000010000000,1e9\n";
        let error = refused(broken, None).unwrap();
        let said = error.to_string();
        assert!(said.contains("a.csv:4:2"), "{said}");
        assert!(
            said.contains("q1_deg: '1e9' is 1.745e7 rad, beyond the 1000000 rad"),
            "{said}"
        );
        assert!(error.remedy().unwrap().contains("leaves a gap"));
        assert_eq!(error.exit_code(), 3);
        // Who looks at a broken log sees it, and a row that is not asked for does no harm.
        assert_eq!(RawLog::read(&path).unwrap().columns[1], [1.0, 1e9]);
        assert!(refused(broken, Some((0, 0))).is_none());
        // Degrees and ticks are not rad, and what is no reading may be large.
        let fine = "time_us,angle_deg,position_ticks,sequence\n1,2e6,3e7,4e12\n";
        assert!(refused(fine, None).is_none());
    }
}
