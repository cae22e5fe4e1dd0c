//! One row of a log, in SI.

use crate::error::{Place, Problem};
use std::path::{Path, PathBuf};

/// Longest gap within a motion, s; over a longer one no simulation says anything, and it would take
/// ages.
const LONGEST_GAP_S: f64 = 100.0;

/// Columns of the file, counted from 1, where a place is to be shown.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Fields {
    /// Time.
    pub time: usize,
    /// Payload, where the file has it.
    pub payload: usize,
    /// Which way round the rig stood, where the file has it.
    pub turned: usize,
    /// Each joint's angle, or rate where it has no angle; 0 where it has neither.
    pub position: Vec<usize>,
    /// Each joint's input; 0 where it has none.
    pub input: Vec<usize>,
}

impl Fields {
    /// The place of a field in a line, both counted from 1; entries of a JSON log have none.
    pub fn place(&self, path: &Path, line: usize, field: usize) -> Place {
        match self.time {
            0 => Place::file(path),
            _ => Place::at(path, line, field.max(1)),
        }
    }
}

/// Why a row cannot follow the one before.
pub(super) struct OutOfPlace {
    /// The kind of finding that it is.
    pub kind: &'static str,
    /// The field that shows it.
    pub field: usize,
    /// What is said of it.
    pub problem: Problem,
}

/// One sample.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LogRow {
    /// The file.
    pub path: PathBuf,
    /// Line in the file, counted from 1; of a JSON log the entry.
    pub line: usize,
    /// Where its quantities stand.
    pub fields: Fields,
    /// Time, s.
    pub time_s: f64,
    /// Value of the segment column as written.
    pub segment: Option<String>,
    /// Per joint: angle, rad; not a number where it was not measured.
    pub position_rad: Vec<f64>,
    /// Per joint: speed, rad/s, where logged; not a number where it was not measured.
    pub velocity_rad_s: Vec<Option<f64>>,
    /// Per joint: reading of its own rate sensor, rad/s, where it has one; not a number where it
    /// was not measured.
    pub rate_rad_s: Vec<Option<f64>>,
    /// Per joint: the drive's input, SI of its kind; not a number where the field is empty.
    pub input: Vec<Option<f64>>,
    /// Supply, V, where logged; not a number where the field is empty.
    pub supply_v: Option<f64>,
    /// Whether the drives were energised, where logged.
    pub torque_on: Option<bool>,
    /// Mass bolted to the last link, kg.
    pub payload_kg: f64,
    /// Whether the rig stood turned by 180 degrees.
    pub turned: bool,
}

/// What the next row of a motion is held against.
pub(super) struct Before<'a> {
    pub segment: Option<&'a str>,
    pub time_s: f64,
    pub payload_kg: f64,
    pub turned: bool,
}

impl LogRow {
    /// Why this row cannot follow `previous` within a motion; `None` if a new motion begins with
    /// it: another segment, or a gap longer than `split_at_gap_s`.
    pub(super) fn follows(
        &self,
        previous: &Before,
        split_at_gap_s: Option<f64>,
    ) -> Option<Vec<OutOfPlace>> {
        let (time_s, previous_s) = (self.time_s, previous.time_s);
        let split = split_at_gap_s.is_some_and(|gap_s| time_s - previous_s > gap_s);
        if self.segment.as_deref() != previous.segment || split {
            return None;
        }
        let mut wrong = Vec::new();
        let mut say = |kind, field, what: String, remedy: &str| {
            let problem = Problem::new(what, remedy);
            wrong.push(OutOfPlace {
                kind,
                field,
                problem,
            });
        };
        let times = || (short(time_s), short(previous_s));
        if time_s <= previous_s {
            let remedy = if time_s == previous_s {
                "the clock is coarser than the rows: log times with more digits, or keep one row \
                 of each time; of rows a fixed period apart, write their number times the period"
            } else {
                "cut the log there, mark the recordings in a segment column, or name a range of \
                 rows"
            };
            let (now, before) = times();
            let what = format!("time does not increase: {now} s after {before} s");
            say("time", self.fields.time, what, remedy);
        }
        if time_s - previous_s > LONGEST_GAP_S {
            let (now, before) = times();
            let what = format!("time jumps from {before} s to {now} s within a motion");
            let remedy = "check the time column's unit, or set split_at_gap_s in the model's \
                          [log] to begin a new motion there";
            say("jump", self.fields.time, what, remedy);
        }
        if self.payload_kg != previous.payload_kg {
            let what = format!(
                "payload changes from {} kg to {} kg within a motion",
                previous.payload_kg, self.payload_kg
            );
            let remedy =
                "stop the recording to change the payload, or mark motions in a segment column";
            say("payload", self.fields.payload, what, remedy);
        }
        if self.turned != previous.turned {
            let what = "the rig is turned round within a motion".to_string();
            let remedy = "stop the recording to turn the rig, or mark motions in a segment column";
            say("turned", self.fields.turned, what, remedy);
        }
        Some(wrong)
    }

    /// The place of a field of this row, counted from 1.
    pub fn place(&self, field: usize) -> Place {
        self.fields.place(&self.path, self.line, field)
    }
}

/// A time with all its digits, unless it is too large to be one.
fn short(time_s: f64) -> String {
    if time_s.abs() < 1e15 {
        time_s.to_string()
    } else {
        format!("{time_s:e}")
    }
}
