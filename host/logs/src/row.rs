//! One row of a log, in SI.

use super::reason::LogReason;
use crate::error::Place;
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
    pub reason: LogReason,
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
        let mut say = |kind, field, reason| {
            wrong.push(OutOfPlace {
                kind,
                field,
                reason,
            });
        };
        if time_s <= previous_s {
            let reason = LogReason::TimeNotIncreasing { time_s, previous_s };
            say("time", self.fields.time, reason);
        }
        if time_s - previous_s > LONGEST_GAP_S {
            let reason = LogReason::TimeJumps { time_s, previous_s };
            say("jump", self.fields.time, reason);
        }
        if self.payload_kg != previous.payload_kg {
            let reason = LogReason::PayloadChanges {
                payload_kg: self.payload_kg,
                previous_kg: previous.payload_kg,
            };
            say("payload", self.fields.payload, reason);
        }
        if self.turned != previous.turned {
            say("turned", self.fields.turned, LogReason::TurnedRound);
        }
        Some(wrong)
    }

    /// The place of a field of this row, counted from 1.
    pub fn place(&self, field: usize) -> Place {
        self.fields.place(&self.path, self.line, field)
    }
}
