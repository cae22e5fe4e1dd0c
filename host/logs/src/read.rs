//! Reads logs into motions: cut at segments and gaps, refused where no simulation can follow.

use super::bam::BamBench;
use super::folder::expanded;
use super::reason::LogReason;
use super::request::LogRequest;
use super::row::{Before, LogRow};
use super::short::ShortMotions;
use super::visit::{FileFacts, visit};
use super::{LogFinding, bam};
use crate::error::{Error, Place, Result};
use crate::model::LogColumns;
use crate::motion::{Motion, MotionSource};
use std::collections::HashMap;

/// Fewest samples a motion may have.
pub const LEAST_ROWS: usize = 10;

/// Reads the requested logs into motions, in order; a file's ending says its format, a folder
/// stands for the logs in it, `-` for CSV from the standard input.
///
/// Motions are named after the file, its rows where only some were asked for, and the segment:
/// `a.csv`, `a.csv:26-139`, `a.csv#3`; pieces between gaps count from 0. Rows outside a range are
/// not judged.
///
/// A motion of fewer than [`LEAST_ROWS`] rows is left out, which [`read_with_findings`] says.
///
/// An empty field is a gap. An angle or a rate is not a number there; an input, the supply and
/// whether torque is on hold the value before. A motion begins when that is known, and all its
/// inputs are or torque is off.
///
/// # Errors
/// Columns without any value, unreadable cells and rows, time that does not increase, a payload or
/// orientation that changes within a motion, a log without any motion of [`LEAST_ROWS`] rows; each
/// with file, line, column and remedy.
pub fn read(requests: &[LogRequest], columns: &LogColumns) -> Result<Vec<Motion>> {
    Ok(read_with_findings(requests, columns)?.0)
}

/// As [`read`], with a warning for each log of which motions are left out; [`super::check()`] finds
/// the same, and more.
///
/// # Errors
/// As [`read`].
pub fn read_with_findings(
    requests: &[LogRequest],
    columns: &LogColumns,
) -> Result<(Vec<Motion>, Vec<LogFinding>)> {
    let (mut motions, mut findings) = (Vec::new(), Vec::new());
    let mut bench = BamBench::default();
    for request in &expanded(requests)? {
        if request.is_json() {
            motions.push(bam::read(request, columns, &mut bench)?);
        } else {
            let (long, short, facts) = read_rows(request, columns)?;
            motions.extend(long);
            findings.extend(facts.finding(&request.path));
            findings.extend(short.warning(&request.path));
        }
    }
    Ok((motions, findings))
}

/// The motions of a log that are long enough, those that are not, and what is known of the file.
fn read_rows(
    request: &LogRequest,
    columns: &LogColumns,
) -> Result<(Vec<Motion>, ShortMotions, FileFacts)> {
    let mut cutter = Cutter {
        request,
        columns,
        pieces: Vec::new(),
        short: ShortMotions::default(),
        left_out: LeftOut::default(),
    };
    let facts = visit(
        &request.path,
        columns,
        &mut |number, row| match request.wants(number) {
            true => cutter.take(row?),
            false => Ok(()),
        },
    )?;
    if let Some(reason) = request.beyond(facts.rows) {
        return Err(Error::refused(Place::file(&request.path), reason));
    }
    let (motions, mut short) = cutter.finish(&facts.sha256)?;
    let mut long = Vec::with_capacity(motions.len());
    for motion in motions.into_iter().map(|motion| motion.shifted(columns)) {
        match motion.len() < LEAST_ROWS {
            true => short.take(motion.source.lines, motion.len()),
            false => long.push(motion),
        }
    }
    match short.refusal(&request.path).filter(|_| long.is_empty()) {
        Some((place, reason)) => Err(Error::refused(place, reason)),
        None => Ok((long, short, facts)),
    }
}

struct Piece {
    segment: Option<String>,
    motion: Motion,
}

impl Piece {
    fn before(&self) -> Before<'_> {
        Before {
            segment: self.segment.as_deref(),
            time_s: self
                .motion
                .time_s
                .last()
                .copied()
                .unwrap_or(f64::NEG_INFINITY),
            payload_kg: self.motion.payload_kg,
            turned: self.motion.turned,
        }
    }
}

struct Cutter<'a> {
    request: &'a LogRequest,
    columns: &'a LogColumns,
    pieces: Vec<Piece>,
    short: ShortMotions,
    left_out: LeftOut,
}

/// Rows before the first of a motion that lack what a motion begins with.
#[derive(Debug, Default)]
pub(super) struct LeftOut {
    /// Joint without input in the rows that were left out last.
    without_input: Option<usize>,
    /// Whether rows were left out that do not say if torque is on.
    without_torque: bool,
}

impl LeftOut {
    /// Leaves the row out if it does not say whether torque is on.
    pub fn lacks_torque(&mut self, row: &LogRow, columns: &LogColumns) -> bool {
        let lacks = columns.torque_on.is_some() && row.torque_on.is_none();
        self.without_torque |= lacks;
        lacks
    }

    /// Leaves the row out, with which a motion would begin, if an energised joint lacks its input.
    pub fn lacks_input(&mut self, row: &LogRow) -> bool {
        let joint = lacks_input(row);
        self.without_input = joint.or(self.without_input);
        joint.is_some()
    }

    /// The column for want of which all rows were left out.
    pub fn reason(&self, columns: &LogColumns, name: &str) -> Option<LogReason> {
        let input = |joint: usize| columns.joints[joint].input.as_ref();
        let torque_on = columns.torque_on.clone().filter(|_| self.without_torque);
        let input = self.without_input.and_then(input).map(|input| input.name());
        Some(empty(input.or(torque_on)?, name))
    }
}

impl Cutter<'_> {
    fn take(&mut self, row: &LogRow) -> Result<()> {
        if self.left_out.lacks_torque(row, self.columns) {
            return Ok(());
        }
        let previous = self.pieces.last().map(Piece::before);
        let split_at_gap_s = self.columns.split_at_gap_s;
        match previous.and_then(|previous| row.follows(&previous, split_at_gap_s)) {
            None => {
                if self.left_out.lacks_input(row) {
                    return Ok(());
                }
                self.close()?;
                self.pieces.push(Piece {
                    segment: row.segment.clone(),
                    motion: begin(row),
                });
            }
            Some(wrong) => {
                if let Some((field, reason)) = wrong.into_iter().next() {
                    return Err(Error::refused(row.place(field), reason));
                }
            }
        }
        if let Some(piece) = self.pieces.last_mut() {
            append(&mut piece.motion, row);
        }
        Ok(())
    }

    /// Fills the gaps of the motion just ended, or leaves it out if it is too short.
    fn close(&mut self) -> Result<()> {
        let is_short = |piece: &mut Piece| piece.motion.len() < LEAST_ROWS;
        if let Some(Piece { motion, .. }) = self.pieces.pop_if(is_short) {
            self.short.take(motion.source.lines, motion.len());
        } else if let Some(piece) = self.pieces.last_mut() {
            let place = Place::file(&self.request.path);
            let name = self.request.name();
            filled(&mut piece.motion, self.columns, &name)
                .map_err(|reason| Error::refused(place, reason))?;
        }
        Ok(())
    }

    fn finish(mut self, sha256: &str) -> Result<(Vec<Motion>, ShortMotions)> {
        if self.pieces.is_empty() {
            let place = Place::file(&self.request.path);
            let reason = self.left_out.reason(self.columns, &self.request.name());
            return Err(Error::refused(place, reason.unwrap_or(LogReason::NoSample)));
        }
        self.close()?;
        let file = self.request.name();
        let several = self.pieces.len() > 1;
        let mut seen: HashMap<String, usize> = HashMap::new();
        let named = self.pieces.into_iter().enumerate().map(|(index, piece)| {
            let mut motion = piece.motion;
            motion.source.sha256 = sha256.to_string();
            motion.name = match piece.segment {
                Some(segment) => {
                    let name = format!("{file}#{segment}");
                    let count = seen.entry(name.clone()).or_default();
                    *count += 1;
                    match *count {
                        1 => name,
                        again => format!("{name}.{again}"),
                    }
                }
                None if several => format!("{file}#{index}"),
                None => file.clone(),
            };
            motion
        });
        Ok((named.collect(), self.short))
    }
}

/// The joint whose input is not known though its drive is energised, if there is one.
fn lacks_input(row: &LogRow) -> Option<usize> {
    let unknown = |input: &Option<f64>| input.is_some_and(f64::is_nan);
    let joint = row.input.iter().position(unknown)?;
    (row.torque_on != Some(false)).then_some(joint)
}

fn empty(column: String, motion: &str) -> LogReason {
    LogReason::EmptyColumn {
        column,
        motion: motion.to_string(),
    }
}

/// Fills the gaps of supply and inputs with the value before, at the start with the first; refuses
/// columns without any value.
fn filled(motion: &mut Motion, columns: &LogColumns, name: &str) -> Result<(), LogReason> {
    let known = |values: &[f64]| values.iter().any(|value| value.is_finite());
    for (joint, columns) in columns.joints.iter().enumerate() {
        if motion.velocity_rad_s[joint]
            .as_deref()
            .is_some_and(|v| !known(v))
        {
            motion.velocity_rad_s[joint] = None;
        }
        let measured = known(&motion.position_rad[joint]) || motion.velocity_rad_s[joint].is_some();
        let column = match &columns.position {
            Some(position) => (!known(&motion.position_rad[joint])).then_some(position),
            None => columns.velocity.as_ref().filter(|_| !measured),
        };
        let silent = motion.rate(joint).is_some_and(|rate| !known(rate));
        let rate = columns.rate.as_ref().filter(|_| silent);
        if let Some(column) = column.or(rate) {
            return Err(empty(column.name(), name));
        }
        let on = motion.torque_on.as_ref();
        if let (Some(column), Some(input)) = (&columns.input, &mut motion.input[joint]) {
            let unknown = input.iter().take_while(|value| value.is_nan()).count();
            if (0..unknown).any(|k| on.is_none_or(|on| on[k])) {
                return Err(empty(column.name(), name));
            }
            // Without torque an input does nothing.
            hold(input, 0.0);
        }
    }
    if let (Some(column), Some(supply)) = (&columns.supply, &mut motion.supply_v) {
        match supply.iter().copied().find(|value| value.is_finite()) {
            Some(first) => hold(supply, first),
            None => return Err(empty(column.name.clone(), name)),
        }
    }
    Ok(())
}

/// Fills gaps with the value before; those at the start with `first`.
fn hold(values: &mut [f64], first: f64) {
    let mut held = first;
    for value in values {
        match value.is_nan() {
            true => *value = held,
            false => held = *value,
        }
    }
}

fn begin(row: &LogRow) -> Motion {
    let each = |values: &[Option<f64>]| values.iter().map(|v| v.map(|_| Vec::new())).collect();
    Motion {
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
    }
}

fn append(motion: &mut Motion, row: &LogRow) {
    fn push<T: Copy>(values: &mut Option<Vec<T>>, value: Option<T>) {
        if let (Some(values), Some(value)) = (values, value) {
            values.push(value);
        }
    }
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
