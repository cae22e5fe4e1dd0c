//! One sample as numbers in SI.

use super::header::{Cell, LogHeader, fields, number};
use super::reason::LogReason;
use crate::error::{Error, Place, Result};
use crate::model::{Column, LogColumns};
use std::path::{Path, PathBuf};

/// Longest gap within a motion, s; over a longer one no simulation says anything, and it would take ages.
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
    /// Each joint's angle.
    pub position: Vec<usize>,
    /// Each joint's input; 0 where it has none.
    pub input: Vec<usize>,
}

/// One sample.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LogRow {
    /// The file.
    pub path: PathBuf,
    /// Cells in the file, counted from 1; 0 in a JSON log.
    pub line: usize,
    /// Data row, counted from 0.
    pub number: usize,
    /// Where its quantities stand.
    pub fields: Fields,
    /// Time, s.
    pub time_s: f64,
    /// Value of the segment column as written.
    pub segment: Option<String>,
    /// Per joint: angle, rad.
    pub position_rad: Vec<f64>,
    /// Per joint: speed, rad/s, where logged.
    pub velocity_rad_s: Vec<Option<f64>>,
    /// Per joint: what the drive was told, SI of its kind.
    pub input: Vec<Option<f64>>,
    /// Supply, V, where logged.
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
    /// This row as the one before the next.
    pub(super) fn before(&self) -> Before<'_> {
        Before {
            segment: self.segment.as_deref(),
            time_s: self.time_s,
            payload_kg: self.payload_kg,
            turned: self.turned,
        }
    }

    /// Sample `index` of a motion that came from no CSV.
    pub(super) fn of(motion: &super::Motion, index: usize) -> LogRow {
        let joints = motion.position_rad.len();
        let at = |series: &Option<Vec<f64>>| series.as_ref().map(|values| values[index]);
        LogRow {
            path: motion.source.path.clone(),
            number: index,
            fields: Fields {
                position: vec![0; joints],
                input: vec![0; joints],
                ..Fields::default()
            },
            time_s: motion.time_s[index],
            position_rad: motion
                .position_rad
                .iter()
                .map(|values| values[index])
                .collect(),
            velocity_rad_s: motion.velocity_rad_s.iter().map(at).collect(),
            input: motion.input.iter().map(at).collect(),
            supply_v: at(&motion.supply_v),
            torque_on: motion.torque_on.as_ref().map(|values| values[index]),
            payload_kg: motion.payload_kg,
            turned: motion.turned,
            ..LogRow::default()
        }
    }

    /// Why this row cannot follow `previous` within a motion, with the field that shows it; `None` if a new
    /// motion begins with it: another segment, or a gap longer than `split_at_gap_s`.
    pub(super) fn follows(
        &self,
        previous: &Before,
        split_at_gap_s: Option<f64>,
    ) -> Option<Vec<(usize, LogReason)>> {
        let (time_s, previous_s) = (self.time_s, previous.time_s);
        let split = split_at_gap_s.is_some_and(|gap_s| time_s - previous_s > gap_s);
        if self.segment.as_deref() != previous.segment || split {
            return None;
        }
        let mut wrong = Vec::new();
        if time_s <= previous_s {
            let reason = LogReason::TimeNotIncreasing { time_s, previous_s };
            wrong.push((self.fields.time, reason));
        }
        if time_s - previous_s > LONGEST_GAP_S {
            wrong.push((
                self.fields.time,
                LogReason::TimeJumps { time_s, previous_s },
            ));
        }
        if self.payload_kg != previous.payload_kg {
            let reason = LogReason::PayloadChanges {
                payload_kg: self.payload_kg,
                previous_kg: previous.payload_kg,
            };
            wrong.push((self.fields.payload, reason));
        }
        if self.turned != previous.turned {
            wrong.push((self.fields.turned, LogReason::TurnedRound));
        }
        Some(wrong)
    }

    /// The place of a field of this row, counted from 1.
    pub fn place(&self, field: usize) -> Place {
        match self.line {
            0 => Place::file(&self.path),
            line => Place::at(&self.path, line, field.max(1)),
        }
    }
}

/// Turns lines of one file into rows.
pub(super) struct RowReader<'a> {
    columns: &'a LogColumns,
    path: &'a Path,
    separator: u8,
    names: Vec<String>,
    time: Cell,
    segment: Option<Cell>,
    supply: Option<Cell>,
    torque_on: Option<Cell>,
    payload: Option<Cell>,
    turned: Option<Cell>,
    position: Vec<Cell>,
    velocity: Vec<Option<Cell>>,
    input: Vec<Option<Cell>>,
}

impl<'a> RowReader<'a> {
    /// Finds every column the model names.
    ///
    /// # Errors
    /// A column that is missing or ambiguous.
    pub fn new(path: &'a Path, columns: &'a LogColumns, header: &LogHeader) -> Result<Self> {
        let cell = |column: &Column| header.cell(&column.name);
        let maybe = |column: &Option<Column>| column.as_ref().map(cell).transpose();
        let flag = |name: &Option<String>| name.as_ref().map(|n| header.cell(n)).transpose();
        let joints = &columns.joints;
        Ok(RowReader {
            columns,
            path,
            separator: header.separator,
            names: header.names.clone(),
            time: cell(&columns.time)?,
            segment: flag(&columns.segment)?,
            supply: maybe(&columns.supply)?,
            torque_on: flag(&columns.torque_on)?,
            payload: maybe(&columns.payload)?,
            turned: flag(&columns.turned)?,
            position: joints
                .iter()
                .map(|j| cell(&j.position))
                .collect::<Result<_>>()?,
            velocity: joints
                .iter()
                .map(|j| maybe(&j.velocity))
                .collect::<Result<_>>()?,
            input: joints
                .iter()
                .map(|j| maybe(&j.input))
                .collect::<Result<_>>()?,
        })
    }

    /// Columns for places.
    pub fn fields(&self) -> Fields {
        let optional = |cell: &Option<Cell>| cell.as_ref().map_or(0, Cell::column);
        Fields {
            time: self.time.column(),
            payload: optional(&self.payload),
            turned: optional(&self.turned),
            position: self.position.iter().map(Cell::column).collect(),
            input: self.input.iter().map(optional).collect(),
        }
    }

    /// Fills `row` from one line.
    ///
    /// # Errors
    /// Too few or too many fields, and needed fields that hold no finite number.
    pub fn fill(&self, line: &str, at: usize, row: &mut LogRow) -> Result<()> {
        let fields = fields(line, self.separator);
        if fields.len() != self.names.len() {
            let (found, expected) = (fields.len(), self.names.len());
            let place = Place::at(self.path, at, found.min(expected) + 1);
            return Err(Error::refused(
                place,
                LogReason::FieldCount { found, expected },
            ));
        }
        let line = Cells {
            reader: self,
            fields: &fields,
            at,
        };
        row.time_s = line.value(&self.time, &self.columns.time)?;
        row.segment = self.segment.as_ref().map(|cell| line.text(cell));
        row.supply_v = line.maybe(&self.supply, &self.columns.supply)?;
        row.torque_on = self
            .torque_on
            .as_ref()
            .map(|cell| line.flag(cell))
            .transpose()?;
        row.payload_kg = line
            .maybe(&self.payload, &self.columns.payload)?
            .unwrap_or(0.0);
        row.turned = match &self.turned {
            Some(cell) => line.flag(cell)?,
            None => false,
        };
        row.position_rad.clear();
        row.velocity_rad_s.clear();
        row.input.clear();
        for (i, joint) in self.columns.joints.iter().enumerate() {
            row.position_rad
                .push(line.value(&self.position[i], &joint.position)?);
            row.velocity_rad_s
                .push(line.maybe(&self.velocity[i], &joint.velocity)?);
            row.input.push(line.maybe(&self.input[i], &joint.input)?);
        }
        Ok(())
    }
}

struct Cells<'a> {
    reader: &'a RowReader<'a>,
    fields: &'a [std::borrow::Cow<'a, str>],
    at: usize,
}

impl Cells<'_> {
    fn maybe(&self, cell: &Option<Cell>, column: &Option<Column>) -> Result<Option<f64>> {
        match (cell, column) {
            (Some(cell), Some(column)) => self.value(cell, column).map(Some),
            _ => Ok(None),
        }
    }

    fn value(&self, cell: &Cell, column: &Column) -> Result<f64> {
        let written = match cell {
            Cell::Constant(value, _) => *value,
            Cell::Field(index) => {
                let text = &self.fields[*index];
                match number(text, self.reader.separator) {
                    Some(value) => value,
                    None => return Err(self.refuse(cell, "a number")),
                }
            }
        };
        let value = column.to_si(written);
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.refuse(cell, "finite"))
        }
    }

    fn flag(&self, cell: &Cell) -> Result<bool> {
        let text = self.text(cell).to_ascii_lowercase();
        match (text.as_str(), number(&text, self.reader.separator)) {
            ("true", _) => Ok(true),
            ("false", _) => Ok(false),
            (_, Some(1.0)) => Ok(true),
            (_, Some(0.0)) => Ok(false),
            _ => Err(self.refuse(cell, "0 or 1")),
        }
    }

    fn text(&self, cell: &Cell) -> String {
        match cell {
            Cell::Field(index) => self.fields[*index].to_string(),
            Cell::Constant(value, _) => value.to_string(),
        }
    }

    fn refuse(&self, cell: &Cell, expected: &'static str) -> Error {
        let (line, column) = match cell {
            Cell::Field(index) => (self.at, self.reader.names[*index].as_str()),
            Cell::Constant(_, line) => (*line, "a constant"),
        };
        let reason = LogReason::WrongField {
            column: column.to_string(),
            found: self.text(cell),
            expected,
        };
        Error::refused(Place::at(self.reader.path, line, cell.column()), reason)
    }
}
