//! Cuts a log's rows into motions, at segments and gaps, whatever its format.

use super::bam::BamBench;
use super::fault::LogFault;
use super::format::LogFormat;
use super::read::LEAST_ROWS;
use super::request::LogRequest;
use super::row::{Before, Fields, LogRow};
use super::row_reader::RowReader;
use super::short::ShortMotions;
use super::table::LogTable;
use super::{LogFinding, Severity, bam};
use crate::error::{Place, Problem, Result};
use crate::model::LogColumns;
use crate::motion::{Motion, MotionSource, ends_s};
use std::borrow::Cow;
use std::path::Path;

/// What is told of each fault of a log, with the kind of its finding; an error ends the reading.
pub(super) type Report<'a> = &'a mut dyn FnMut(&'static str, LogFault) -> Result<()>;

/// A motion as its rows stand: without a name, and with gaps.
#[derive(Debug)]
pub(super) struct CutMotion {
    pub segment: Option<String>,
    pub motion: Motion,
    /// Line of each sample.
    pub lines: Vec<usize>,
}

/// What the rows asked for of a log hold.
#[derive(Debug, Default)]
pub(super) struct Cut {
    /// Motions that are long enough.
    pub motions: Vec<CutMotion>,
    /// Those that are not.
    pub short: ShortMotions,
    /// Rows asked for, unreadable ones included.
    pub rows: usize,
    /// Where quantities stand, once a row was read.
    pub fields: Fields,
    left_out: LeftOut,
}

impl Cut {
    /// Why no row at all was taken, where a column is what it lacks.
    pub fn lack(&self, columns: &LogColumns, name: &str) -> Option<Problem> {
        self.left_out.problem(columns, name)
    }

    /// Whether no row was taken.
    pub fn is_empty(&self) -> bool {
        self.motions.is_empty() && self.short.is_empty()
    }
}

/// What is known of a file once it has been read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FileFacts {
    /// SHA-256 of all its bytes, lower-case hexadecimal.
    pub sha256: String,
    /// What looks wrong with the file as a whole, and what to do about it.
    warning: Option<(&'static str, &'static str)>,
}

impl FileFacts {
    /// What looks wrong with this file, as a finding.
    pub fn finding(&self, path: &Path) -> Option<LogFinding> {
        let (what, remedy) = self.warning?;
        Some(LogFinding {
            kind: "file",
            severity: Severity::Warn,
            place: Some(Place::file(path)),
            what: what.to_string(),
            remedy: remedy.to_string(),
            proof: None,
        })
    }
}

/// Reads a log and cuts it. Where `report` goes on after a fault, so does the reading: without the
/// row that is wrong, and with a motion of its own behind a clock that was set back.
pub(super) fn cut(
    request: &LogRequest,
    columns: &LogColumns,
    bench: &mut BamBench,
    report: Report,
) -> (Cut, Result<FileFacts>) {
    let mut cut = Cut::default();
    let facts = (|| {
        let (table, columns) = match LogFormat::of(&request.path) {
            LogFormat::Bam => {
                let (table, own) = bam::read(request, columns, bench)?;
                (table, Cow::Owned(own))
            }
            format => {
                let table = LogTable::read(&request.path, format, Some(columns))?;
                (table, Cow::Borrowed(columns))
            }
        };
        let mut cutter = Cutter {
            request,
            columns: &columns,
            report,
            open: None,
            cut: &mut cut,
        };
        cutter.read(&table)?;
        Ok(FileFacts {
            sha256: table.sha256,
            warning: table.warning,
        })
    })();
    (cut, facts)
}

/// Rows before the first of a motion that lack what a motion begins with.
#[derive(Debug, Default)]
struct LeftOut {
    /// Joint without input in the rows that were left out last.
    without_input: Option<usize>,
    /// Whether rows were left out that do not say if torque is on.
    without_torque: bool,
}

impl LeftOut {
    /// The column for want of which all rows were left out.
    fn problem(&self, columns: &LogColumns, name: &str) -> Option<Problem> {
        let input = |joint: usize| columns.joints[joint].input.as_ref();
        let torque_on = columns.torque_on.clone().filter(|_| self.without_torque);
        let input = self.without_input.and_then(input).map(|input| input.name());
        Some(empty(&input.or(torque_on)?, name))
    }
}

struct Cutter<'a> {
    request: &'a LogRequest,
    columns: &'a LogColumns,
    report: Report<'a>,
    /// The motion that goes on.
    open: Option<CutMotion>,
    cut: &'a mut Cut,
}

impl Cutter<'_> {
    fn read(&mut self, table: &LogTable) -> Result<()> {
        let reader = RowReader::new(&self.request.path, self.columns, table)?;
        let mut row = LogRow {
            path: self.request.path.clone(),
            fields: reader.fields(),
            ..LogRow::default()
        };
        for index in 0..table.rows() {
            let filled = reader.fill(index, &mut row);
            if !self.request.wants(table.first + index) {
                continue;
            }
            self.cut.rows += 1;
            match filled {
                Ok(()) => self.take(&row)?,
                Err(fault) => (self.report)("cell", *fault)?,
            }
        }
        if let Some(problem) = self.request.beyond(table.first + table.rows()) {
            self.refuse("range", problem)?;
        }
        self.close()
    }

    /// Something is wrong with the file.
    fn refuse(&mut self, kind: &'static str, problem: Problem) -> Result<()> {
        let place = Place::file(&self.request.path);
        (self.report)(kind, LogFault::new(place, problem))
    }

    fn take(&mut self, row: &LogRow) -> Result<()> {
        if self.columns.torque_on.is_some() && row.torque_on.is_none() {
            self.cut.left_out.without_torque = true;
            return Ok(());
        }
        let before = self.open.as_ref().map(CutMotion::before);
        let previous_s = before.as_ref().map(|before| before.time_s);
        match before.and_then(|before| row.follows(&before, self.columns.split_at_gap_s)) {
            None => {
                if let Some(joint) = lacks_input(row) {
                    self.cut.left_out.without_input = Some(joint);
                    return Ok(());
                }
                self.close()?;
            }
            Some(wrong) => {
                for found in wrong {
                    let fault = LogFault::new(row.place(found.field), found.problem);
                    (self.report)(found.kind, fault)?;
                }
                // A sample out of order would spoil every difference after it; after a restart,
                // that is one to the samples before.
                match previous_s.map(|previous_s| row.time_s - previous_s) {
                    Some(0.0) => return Ok(()),
                    Some(..0.0) => self.close()?,
                    _ => {}
                }
            }
        }
        self.cut.fields.clone_from(&row.fields);
        let open = self.open.get_or_insert_with(|| CutMotion::begin(row));
        open.append(row);
        Ok(())
    }

    /// Ends a motion, or leaves it out if too few of its rows are left once columns are moved in
    /// time.
    fn close(&mut self) -> Result<()> {
        let Some(ended) = self.open.take() else {
            return Ok(());
        };
        let rows = rows_left(&ended.motion.time_s, ends_s(self.columns));
        if rows < LEAST_ROWS {
            self.cut.short.take(ended.motion.source.lines, rows);
            return Ok(());
        }
        for column in empty_columns(&ended.motion, self.columns) {
            self.refuse("missing", empty(&column, &self.request.name()))?;
        }
        self.cut.motions.push(ended);
        Ok(())
    }
}

impl CutMotion {
    fn begin(row: &LogRow) -> CutMotion {
        let each = |values: &[Option<f64>]| values.iter().map(|v| v.map(|_| Vec::new())).collect();
        let motion = Motion {
            name: String::new(),
            source: MotionSource {
                path: row.path.clone(),
                sha256: String::new(),
                lines: (row.line, row.line),
            },
            time_s: Vec::new(),
            position_rad: vec![Vec::new(); row.position_rad.len()],
            velocity_rad_s: each(&row.velocity_rad_s),
            rate_rad_s: each(&row.rate_rad_s),
            input: each(&row.input),
            supply_v: row.supply_v.map(|_| Vec::new()),
            torque_on: row.torque_on.map(|_| Vec::new()),
            payload_kg: row.payload_kg,
            turned: row.turned,
        };
        CutMotion {
            segment: row.segment.clone(),
            motion,
            lines: Vec::new(),
        }
    }

    fn before(&self) -> Before<'_> {
        let motion = &self.motion;
        Before {
            segment: self.segment.as_deref(),
            time_s: motion.time_s.last().copied().unwrap_or(f64::NEG_INFINITY),
            payload_kg: motion.payload_kg,
            turned: motion.turned,
        }
    }

    fn append(&mut self, row: &LogRow) {
        fn push<T: Copy>(values: &mut Option<Vec<T>>, value: Option<T>) {
            if let (Some(values), Some(value)) = (values, value) {
                values.push(value);
            }
        }
        self.lines.push(row.line);
        let motion = &mut self.motion;
        motion.source.lines.1 = row.line;
        motion.time_s.push(row.time_s);
        for (joint, value) in row.position_rad.iter().enumerate() {
            motion.position_rad[joint].push(*value);
            push(&mut motion.velocity_rad_s[joint], row.velocity_rad_s[joint]);
            push(&mut motion.rate_rad_s[joint], row.rate_rad_s[joint]);
            push(&mut motion.input[joint], row.input[joint]);
        }
        push(&mut motion.supply_v, row.supply_v);
        push(&mut motion.torque_on, row.torque_on);
    }
}

/// Whether the drives were energised at a sample.
pub(super) fn is_energised(motion: &Motion, sample: usize) -> bool {
    motion.torque_on.as_ref().is_none_or(|on| on[sample])
}

/// The joint whose input is not known though its drive is energised, if there is one.
fn lacks_input(row: &LogRow) -> Option<usize> {
    let unknown = |input: &Option<f64>| input.is_some_and(f64::is_nan);
    let joint = row.input.iter().position(unknown)?;
    (row.torque_on != Some(false)).then_some(joint)
}

/// Rows that are left once the earliest and the latest column are moved by these, s: at most 0, at
/// least 0.
fn rows_left(time_s: &[f64], (earliest, latest): (f64, f64)) -> usize {
    let (Some(first), Some(last)) = (time_s.first(), time_s.last()) else {
        return 0;
    };
    let begin = time_s.partition_point(|t| *t < first + latest);
    let end = time_s.partition_point(|t| *t <= last + earliest);
    end.saturating_sub(begin)
}

/// A column that holds no value throughout a motion.
fn empty(column: &str, motion: &str) -> Problem {
    Problem::new(
        format!("{column} holds no value in {motion}"),
        "record it (goals: by `handstand replay --record`), or take the column out of the \
         model's [log]",
    )
}

/// Columns of which a motion has no value, and inputs that an energised sample comes before.
fn empty_columns(motion: &Motion, columns: &LogColumns) -> Vec<String> {
    let known = |values: &[f64]| values.iter().any(|value| value.is_finite());
    let mut empty = Vec::new();
    for (joint, columns) in columns.joints.iter().enumerate() {
        let velocity = motion.velocity_rad_s[joint].as_deref();
        let measured = match &columns.position {
            Some(position) => (!known(&motion.position_rad[joint])).then_some(position),
            None => columns
                .velocity
                .as_ref()
                .filter(|_| !velocity.is_some_and(known)),
        };
        let silent = motion.rate(joint).is_some_and(|rate| !known(rate));
        let rate = columns.rate.as_ref().filter(|_| silent);
        let late = motion.input[joint].as_ref().is_some_and(|input| {
            let unknown = input.iter().take_while(|value| value.is_nan()).count();
            (0..unknown).any(|sample| is_energised(motion, sample))
        });
        let input = columns.input.as_ref().filter(|_| late);
        let all = measured.into_iter().chain(rate).chain(input);
        empty.extend(all.map(|column| column.name()));
    }
    if let (Some(column), Some(supply)) = (&columns.supply, &motion.supply_v)
        && !known(supply)
    {
        empty.push(column.name.clone());
    }
    empty
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_without_a_moved_column_are_not_left() {
        let left = |ends_s, rows: u32| {
            let time_s: Vec<f64> = (0..rows).map(|k| 0.01 * f64::from(k)).collect();
            rows_left(&time_s, ends_s)
        };
        assert_eq!(left((0.0, 0.0), 0), 0);
        assert_eq!(left((0.0, 0.0), 500), 500);
        assert_eq!(left((-0.025, 0.015), 13), 8);
        assert_eq!(left((-0.025, 0.015), 3), 0);
    }
}
