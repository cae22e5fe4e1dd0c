//! A log's columns as they stand in the file, before a model says what they mean.

use super::bam::BenchFigures;
use super::fault::RowFault;
use super::format::LogFormat;
use super::lerobot::{DatasetFacts, LerobotDataset, raw_log};
use super::reading_limit::ReadingLimit;
use super::request::LogRequest;
use super::table::LogTable;
use crate::error::{Place, Result};
use crate::output::shortened;
use std::path::Path;

/// Columns that are named of those that are not read.
const LISTED: usize = 20;

/// Columns of a log.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RawLog {
    /// Names, in the file's order.
    pub names: Vec<String>,
    /// Values of each column; not a number where a cell is none.
    pub columns: Vec<Vec<f64>>,
    /// Whether the column holds ISO 8601 time stamps; its values count in s from the first.
    pub iso: Vec<bool>,
    /// The first cell of each column that is neither a number nor a gap; absent without one.
    pub words: Vec<Option<String>>,
    /// Columns that hold something else than a number a row, and what they hold.
    pub left_out: Vec<(String, String)>,
    /// What looks wrong with the file, and what to do about it.
    pub warning: Option<(&'static str, &'static str)>,
    /// Whether the format says that angles are rad, speeds rad/s and torques N m.
    pub is_si: bool,
    /// The bench that recorded it, where the file says.
    pub bench: Option<BenchFigures>,
    /// What a data set of LeRobot says of its columns.
    pub dataset: Option<DatasetFacts>,
}

impl RawLog {
    /// Reads a log of any format as it stands, with numbers that no sensor gives; of a data set of
    /// LeRobot, all episodes one after the other.
    ///
    /// # Errors
    /// A file without a header, or that is no text.
    pub fn read(path: &Path) -> Result<RawLog> {
        RawLog::read_checked(path, None)
    }

    /// Reads a log of any format; in the rows asked for, readings must be ones that a sensor gives.
    pub(super) fn read_checked(path: &Path, checked: Option<&LogRequest>) -> Result<RawLog> {
        if LerobotDataset::is_one(path) {
            return raw_log(path, checked);
        }
        let table = LogTable::read(path, LogFormat::of(path), None)?;
        hold(path, &table, checked)?;
        Ok(RawLog::of(table))
    }

    fn of(table: LogTable) -> RawLog {
        let width = table.names.len();
        let (iso, words) = match table.text {
            Some(text) => (text.iso, text.words),
            None => (vec![false; width], vec![None; width]),
        };
        let left_out = table.left_out.into_iter();
        RawLog {
            names: table.names,
            columns: table.columns,
            iso,
            words,
            left_out: left_out.map(|(name, holds)| (name, holds.into())).collect(),
            warning: table.warning,
            is_si: table.is_si,
            bench: table.bench,
            dataset: None,
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
        if let Some(problem) = request.beyond(rows) {
            return Err(problem.at(Place::file(&request.path)));
        }
        if let Some((first, last)) = request.rows {
            log.columns
                .iter_mut()
                .for_each(|column| *column = column[first..=last].to_vec());
        }
        Ok(log)
    }

    /// What looks wrong with the file, and what of it is not read; each with what to do about it.
    pub fn remarks(&self) -> Vec<(String, &'static str)> {
        let warning = self
            .warning
            .map(|(what, remedy)| (what.to_string(), remedy));
        let holds =
            |(name, holds): &(String, String)| format!("{:?} holds {holds}", shortened(name));
        let left_out: Vec<String> = self.left_out.iter().take(LISTED).map(holds).collect();
        let more = match self.left_out.len().saturating_sub(LISTED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let left_out = (!left_out.is_empty()).then(|| {
            let what = format!("not read: {}{more}", left_out.join(", "));
            (what, "only numbers are read, one a row")
        });
        warning.into_iter().chain(left_out).collect()
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

    /// Whether a column is called a time.
    pub fn called_time(&self, index: usize) -> bool {
        let name = self.names[index].to_lowercase();
        name == "t" || name.starts_with("time") || name.starts_with("t_")
    }

    /// The first column that is called a time, else the first that only grows.
    pub fn time(&self) -> Option<usize> {
        let grows =
            |column: &Vec<f64>| column.len() > 1 && column.windows(2).all(|pair| pair[1] > pair[0]);
        let named = (0..self.names.len()).find(|index| self.called_time(*index));
        named.or_else(|| self.columns.iter().position(grows))
    }
}

/// Refuses what no row may hold, whatever its columns mean: bytes that are no text. Of the rows
/// asked for, readings must be ones that a sensor gives, and fields must not be too many: which is
/// which nothing tells.
fn hold(path: &Path, table: &LogTable, checked: Option<&LogRequest>) -> Result<()> {
    let limit = checked.map(|request| ReadingLimit::new(request, &table.names));
    for row in 0..table.rows() {
        if let Some((field, fault)) = table.fault(row) {
            let is_borne = match fault {
                RowFault::Fields { found, expected } => found <= expected || limit.is_none(),
                RowFault::NoText(_) => false,
            };
            if !is_borne {
                let place = Place::at(path, table.line(row), field);
                return Err(fault.problem().at(place));
            }
        }
        if let Some(limit) = &limit {
            limit.hold(table, row)?;
        }
    }
    Ok(())
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
