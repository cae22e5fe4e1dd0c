//! Reads logs into motions: cut at segments and gaps, refused where no simulation can follow.

use super::csv::visit;
use super::reason::LogReason;
use super::request::LogRequest;
use super::row::{Before, LogRow};
use super::{Motion, MotionSource, bam};
use crate::error::{Error, Place, Result};
use crate::model::LogColumns;
use std::collections::HashMap;

/// Fewest samples a motion may have.
pub const LEAST_ROWS: usize = 10;

/// Reads the requested logs into motions, in order; a file ending in `.json` is a BAM log.
///
/// Motions are named after the file, its rows where only some were asked for, and the segment:
/// `a.csv`, `a.csv:26-139`, `a.csv#3`; pieces between gaps count from 0. Rows outside a range are
/// not judged.
///
/// # Errors
/// Unreadable cells and rows, time that does not increase, a payload or orientation that changes
/// within a motion, fewer than [`LEAST_ROWS`] rows; each with file, line, column and remedy.
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
    if let Some(reason) = request.beyond(facts.rows) {
        return Err(Error::refused(Place::file(&request.path), reason));
    }
    let motions = cutter.finish(&facts.sha256)?.into_iter();
    motions.map(|motion| moved(motion, columns)).collect()
}

/// The motion with its columns moved in time, refused where too little is left of it.
fn moved(motion: Motion, columns: &LogColumns) -> Result<Motion> {
    let motion = motion.shifted(columns);
    if motion.len() >= LEAST_ROWS {
        return Ok(motion);
    }
    let place = Place {
        line: Some(motion.source.lines.0),
        ..Place::file(&motion.source.path)
    };
    let rows = motion.len();
    Err(Error::refused(place, LogReason::TooShort { rows }))
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
    split_at_gap_s: Option<f64>,
    pieces: Vec<Piece>,
}

impl Cutter<'_> {
    fn take(&mut self, row: &LogRow) -> Result<()> {
        let previous = self.pieces.last().map(Piece::before);
        match previous.and_then(|previous| row.follows(&previous, self.split_at_gap_s)) {
            None => {
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

    /// Refuses the motion just ended if it is too short.
    fn close(&self) -> Result<()> {
        match self.pieces.last() {
            Some(Piece { motion, .. }) if motion.len() < LEAST_ROWS => {
                let place = Place {
                    line: Some(motion.source.lines.0),
                    ..Place::file(&self.request.path)
                };
                let rows = motion.len();
                Err(Error::refused(place, LogReason::TooShort { rows }))
            }
            _ => Ok(()),
        }
    }

    fn finish(self, sha256: &str) -> Result<Vec<Motion>> {
        if self.pieces.is_empty() {
            let place = Place::file(&self.request.path);
            return Err(Error::refused(place, LogReason::NoSample));
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

fn begin(row: &LogRow) -> Motion {
    Motion {
        name: String::new(),
        source: MotionSource {
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
        push(&mut motion.input[joint], row.input[joint]);
    }
    push(&mut motion.supply_v, row.supply_v);
    push(&mut motion.torque_on, row.torque_on);
}
