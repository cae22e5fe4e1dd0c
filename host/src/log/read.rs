//! From rows to motions: cutting at segments and gaps, refusing what no simulation could follow.

use super::csv::visit;
use super::request::LogRequest;
use super::row::Row;
use super::{Motion, Source, bam};
use crate::error::{Error, Place, Result};
use crate::model::LogColumns;
use std::collections::HashMap;

/// Fewest samples a motion may have.
pub const LEAST_ROWS: usize = 10;
/// Longest gap within a motion, s; over a longer one no simulation says anything, and it would take ages.
pub(super) const LONGEST_GAP_S: f64 = 100.0;

/// Reads the requested logs into motions, in order; a file ending in `.json` is a BAM log.
///
/// Motions are named after the file, its rows where only some were asked for, and the segment: `a.csv`,
/// `a.csv:26-139`, `a.csv#3`; pieces between gaps count from 0. Rows outside a range are not judged.
///
/// # Errors
/// Unreadable cells and rows, time that does not increase, a payload or orientation that changes within a
/// motion, fewer than [`LEAST_ROWS`] rows; each with file, line, column and remedy.
pub fn read(requests: &[LogRequest], columns: &LogColumns) -> Result<Vec<Motion>> {
    let mut motions = Vec::new();
    for request in requests {
        if request.is_json() {
            motions.push(bam::read(request)?);
        } else {
            motions.extend(read_csv(request, columns)?);
        }
    }
    Ok(motions)
}

fn read_csv(request: &LogRequest, columns: &LogColumns) -> Result<Vec<Motion>> {
    let mut cutter = Cutter {
        request,
        split_at_gap_s: columns.split_at_gap_s,
        pieces: Vec::new(),
    };
    let facts = visit(
        &request.path,
        columns,
        &mut |number, row| match request.wants(number) {
            true => cutter.take(row?),
            false => Ok(()),
        },
    )?;
    if let Some((first, last)) = request.rows.filter(|(_, last)| *last >= facts.rows) {
        return Err(Error::data(
            Place::file(&request.path),
            format!(
                "rows {first}-{last} asked for, but it has {} rows",
                facts.rows
            ),
            "data rows count from 0, after the header",
        ));
    }
    cutter.finish(&facts.sha256)
}

/// What to do about a gap too long.
pub(super) const GAP_REMEDY: &str = "check the time column's unit, or set split_at_gap_s in the model's [log] to begin a new motion there";

struct Piece {
    segment: Option<String>,
    motion: Motion,
}

struct Cutter<'a> {
    request: &'a LogRequest,
    split_at_gap_s: Option<f64>,
    pieces: Vec<Piece>,
}

impl Cutter<'_> {
    fn take(&mut self, row: &Row) -> Result<()> {
        if self.begins(row)? {
            self.close()?;
            self.pieces.push(Piece {
                segment: row.segment.clone(),
                motion: begin(row),
            });
        }
        if let Some(piece) = self.pieces.last_mut() {
            append(&mut piece.motion, row);
        }
        Ok(())
    }

    /// Whether a new motion begins with `row`; if not, it must fit the present one.
    fn begins(&self, row: &Row) -> Result<bool> {
        let Some(Piece { segment, motion }) = self.pieces.last() else {
            return Ok(true);
        };
        if *segment != row.segment {
            return Ok(true);
        }
        let previous = motion.time_s.last().copied().unwrap_or(f64::NEG_INFINITY);
        if row.time_s <= previous {
            return Err(Error::data(
                row.place(row.fields.time),
                format!(
                    "time does not increase: {} s after {previous} s",
                    row.time_s
                ),
                "cut the log there, mark the recordings in a segment column, or name a range of rows",
            ));
        }
        if self
            .split_at_gap_s
            .is_some_and(|gap| row.time_s - previous > gap)
        {
            return Ok(true);
        }
        if row.time_s - previous > LONGEST_GAP_S {
            return Err(Error::data(
                row.place(row.fields.time),
                format!(
                    "time jumps from {previous} s to {} s within a motion",
                    row.time_s
                ),
                GAP_REMEDY,
            ));
        }
        if row.payload_kg != motion.payload_kg {
            return Err(Error::data(
                row.place(row.fields.payload),
                format!(
                    "payload changes from {} kg to {} kg within a motion",
                    motion.payload_kg, row.payload_kg
                ),
                "stop the recording to change the payload, or mark motions in a segment column",
            ));
        }
        if row.turned != motion.turned {
            return Err(Error::data(
                row.place(row.fields.turned),
                "the rig is turned round within a motion",
                "stop the recording to turn the rig, or mark motions in a segment column",
            ));
        }
        Ok(false)
    }

    /// Refuses the motion just ended if it is too short.
    fn close(&self) -> Result<()> {
        let Some(Piece { motion, .. }) = self.pieces.last() else {
            return Ok(());
        };
        if motion.len() >= LEAST_ROWS {
            return Ok(());
        }
        let place = Place {
            line: Some(motion.source.lines.0),
            ..Place::file(&self.request.path)
        };
        Err(Error::data(
            place,
            format!(
                "a motion of {} rows; {LEAST_ROWS} are the least",
                motion.len()
            ),
            "leave it out by a row range such as log.csv:26-139, or record longer",
        ))
    }

    fn finish(self, sha256: &str) -> Result<Vec<Motion>> {
        if self.pieces.is_empty() {
            return Err(Error::data(
                Place::file(&self.request.path),
                "the log holds no sample",
                "record again: below the column names there is no row",
            ));
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
        Ok(named.collect())
    }
}

fn begin(row: &Row) -> Motion {
    Motion {
        name: String::new(),
        source: Source {
            path: row.path.clone(),
            sha256: String::new(),
            lines: (row.line, row.line),
        },
        time_s: Vec::new(),
        position_rad: vec![Vec::new(); row.position_rad.len()],
        velocity_rad_s: row
            .velocity_rad_s
            .iter()
            .map(|v| v.map(|_| Vec::new()))
            .collect(),
        input: row.input.iter().map(|u| u.map(|_| Vec::new())).collect(),
        supply_v: row.supply_v.map(|_| Vec::new()),
        torque_on: row.torque_on.map(|_| Vec::new()),
        payload_kg: row.payload_kg,
        turned: row.turned,
    }
}

fn append(motion: &mut Motion, row: &Row) {
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
        push(&mut motion.input[joint], row.input[joint]);
    }
    push(&mut motion.supply_v, row.supply_v);
    push(&mut motion.torque_on, row.torque_on);
}
