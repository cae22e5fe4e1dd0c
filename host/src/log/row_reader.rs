//! Turns the lines of a CSV log into rows.

use super::header::{LogCell, LogHeader, fields, number};
use super::reason::LogReason;
use super::row::{Fields, LogRow};
use crate::error::{Error, Place, Result};
use crate::model::{Column, LogColumns};
use std::borrow::Cow;
use std::path::Path;

/// Where a quantity stands, and how it is scaled.
struct LogQuantity<'a> {
    cell: LogCell,
    column: &'a Column,
}

struct JointQuantities<'a> {
    position: LogQuantity<'a>,
    velocity: Option<LogQuantity<'a>>,
    input: Option<LogQuantity<'a>>,
}

/// Reads the lines of one file.
pub(super) struct RowReader<'a> {
    path: &'a Path,
    separator: u8,
    names: Vec<String>,
    time: LogQuantity<'a>,
    segment: Option<LogCell>,
    supply: Option<LogQuantity<'a>>,
    torque_on: Option<LogCell>,
    payload: Option<LogQuantity<'a>>,
    turned: Option<LogCell>,
    joints: Vec<JointQuantities<'a>>,
}

impl<'a> RowReader<'a> {
    /// Finds every column the model names.
    ///
    /// # Errors
    /// A column that is missing or ambiguous.
    pub fn new(path: &'a Path, columns: &'a LogColumns, header: &LogHeader) -> Result<Self> {
        let cell = |name: &Option<String>| name.as_ref().map(|name| header.cell(name)).transpose();
        let quantity = |column: &'a Column| {
            let cell = header.cell(&column.name)?;
            Ok::<_, Error>(LogQuantity { cell, column })
        };
        let maybe = |column: &'a Option<Column>| column.as_ref().map(quantity).transpose();
        let joints = columns.joints.iter().map(|joint| {
            Ok(JointQuantities {
                position: quantity(&joint.position)?,
                velocity: maybe(&joint.velocity)?,
                input: maybe(&joint.input)?,
            })
        });
        Ok(RowReader {
            path,
            separator: header.separator,
            names: header.names.clone(),
            time: quantity(&columns.time)?,
            segment: cell(&columns.segment)?,
            supply: maybe(&columns.supply)?,
            torque_on: cell(&columns.torque_on)?,
            payload: maybe(&columns.payload)?,
            turned: cell(&columns.turned)?,
            joints: joints.collect::<Result<_>>()?,
        })
    }

    /// Columns for places.
    pub fn fields(&self) -> Fields {
        let column =
            |quantity: &Option<LogQuantity>| quantity.as_ref().map_or(0, |q| q.cell.column());
        let joints = || self.joints.iter();
        Fields {
            time: self.time.cell.column(),
            payload: column(&self.payload),
            turned: self.turned.as_ref().map_or(0, LogCell::column),
            position: joints().map(|joint| joint.position.cell.column()).collect(),
            input: joints().map(|joint| column(&joint.input)).collect(),
        }
    }

    /// Fills `row` from one line.
    ///
    /// # Errors
    /// Too few or too many fields, and needed fields that hold no finite number.
    pub fn fill(&self, line: &str, at: usize, row: &mut LogRow) -> Result<()> {
        let fields = fields(line, self.separator);
        let (found, expected) = (fields.len(), self.names.len());
        if found != expected {
            let place = Place::at(self.path, at, found.min(expected) + 1);
            let reason = LogReason::FieldCount { found, expected };
            return Err(Error::refused(place, reason));
        }
        let line = Cells {
            reader: self,
            fields: &fields,
            at,
        };
        row.time_s = line.value(&self.time)?;
        row.segment = self.segment.as_ref().map(|cell| line.text(cell).into());
        row.supply_v = line.maybe(&self.supply)?;
        row.torque_on = line.flag(&self.torque_on)?;
        row.payload_kg = line.maybe(&self.payload)?.unwrap_or(0.0);
        row.turned = line.flag(&self.turned)?.unwrap_or(false);
        row.position_rad.clear();
        row.velocity_rad_s.clear();
        row.input.clear();
        for joint in &self.joints {
            row.position_rad.push(line.value(&joint.position)?);
            row.velocity_rad_s.push(line.maybe(&joint.velocity)?);
            row.input.push(line.maybe(&joint.input)?);
        }
        Ok(())
    }
}

/// The fields of one line.
struct Cells<'a> {
    reader: &'a RowReader<'a>,
    fields: &'a [Cow<'a, str>],
    at: usize,
}

impl Cells<'_> {
    fn maybe(&self, quantity: &Option<LogQuantity>) -> Result<Option<f64>> {
        quantity
            .as_ref()
            .map(|quantity| self.value(quantity))
            .transpose()
    }

    fn value(&self, LogQuantity { cell, column }: &LogQuantity) -> Result<f64> {
        let written = match cell {
            LogCell::Constant(value, _) => Some(*value),
            LogCell::Field(index) => number(&self.fields[*index], self.reader.separator),
        };
        match written.map(|written| column.to_si(written)) {
            Some(value) if value.is_finite() => Ok(value),
            Some(_) => Err(self.refuse(cell, "finite")),
            None => Err(self.refuse(cell, "a number")),
        }
    }

    fn flag(&self, cell: &Option<LogCell>) -> Result<Option<bool>> {
        let Some(cell) = cell else { return Ok(None) };
        let text = self.text(cell).to_ascii_lowercase();
        match (text.as_str(), number(&text, self.reader.separator)) {
            ("true", _) | (_, Some(1.0)) => Ok(Some(true)),
            ("false", _) | (_, Some(0.0)) => Ok(Some(false)),
            _ => Err(self.refuse(cell, "0 or 1")),
        }
    }

    fn text(&self, cell: &LogCell) -> Cow<'_, str> {
        match cell {
            LogCell::Field(index) => Cow::Borrowed(&self.fields[*index]),
            LogCell::Constant(value, _) => value.to_string().into(),
        }
    }

    fn refuse(&self, cell: &LogCell, expected: &'static str) -> Error {
        let (line, column) = match cell {
            LogCell::Field(index) => (self.at, self.reader.names[*index].as_str()),
            LogCell::Constant(_, line) => (*line, "a constant"),
        };
        let reason = LogReason::WrongField {
            column: column.to_string(),
            found: self.text(cell).into(),
            expected,
        };
        Error::refused(Place::at(self.reader.path, line, cell.column()), reason)
    }
}
