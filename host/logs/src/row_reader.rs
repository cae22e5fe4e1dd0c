//! Turns the lines of a CSV log into rows.

use super::cell::{is_missing, number};
use super::header::{LogCell, LogHeader, fields, surplus};
use super::iso::iso_ns;
use super::reading_limit::beyond_readings;
use super::reason::{FLAG, LogReason, STAMP};
use super::row::{Fields, LogRow};
use crate::error::{Error, Place, Result};
use crate::model::{Column, ColumnMean, Dimension, LogColumns};
use std::borrow::Cow;
use std::cell::Cell;
use std::path::Path;

/// Where a quantity stands, and how it is scaled.
struct LogQuantity<'a> {
    cell: LogCell,
    column: &'a Column,
}

/// Columns whose mean counts; none where the model names none.
type Mean<'a> = Vec<LogQuantity<'a>>;

struct JointQuantities<'a> {
    position: Mean<'a>,
    velocity: Mean<'a>,
    rate: Mean<'a>,
    input: Mean<'a>,
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
    /// The file's first time stamp, ns, where they are text: the others count from it.
    first_ns: Cell<Option<i64>>,
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
        let mean = |columns: &'a Option<ColumnMean>| {
            let columns = columns.iter().flat_map(ColumnMean::columns);
            columns.map(quantity).collect::<Result<Mean>>()
        };
        let joints = columns.joints.iter().map(|joint| {
            Ok(JointQuantities {
                position: mean(&joint.position)?,
                velocity: mean(&joint.velocity)?,
                rate: mean(&joint.rate)?,
                input: mean(&joint.input)?,
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
            first_ns: Cell::new(None),
        })
    }

    /// Columns for places.
    pub fn fields(&self) -> Fields {
        let column =
            |quantity: &Option<LogQuantity>| quantity.as_ref().map_or(0, |q| q.cell.column());
        let first = |mean: &Mean| mean.first().map(|quantity| quantity.cell.column());
        let measured = |joint: &JointQuantities| {
            first(&joint.position)
                .or(first(&joint.velocity))
                .unwrap_or(0)
        };
        let joints = || self.joints.iter();
        Fields {
            time: self.time.cell.column(),
            payload: column(&self.payload),
            turned: self.turned.as_ref().map_or(0, LogCell::column),
            position: joints().map(measured).collect(),
            input: joints()
                .map(|joint| first(&joint.input).unwrap_or(0))
                .collect(),
        }
    }

    /// Fills `row` from one line.
    ///
    /// An empty field, or one that says `nan`, `NA`, `NULL` or the like, is a gap: that quantity is
    /// not a number in this row.
    ///
    /// # Errors
    /// Too few or too many fields, fields that hold something else than a finite number, and a row
    /// without a time.
    pub fn fill(&self, line: &str, at: usize, row: &mut LogRow) -> Result<()> {
        let mut fields = fields(line, self.separator);
        let (found, expected) = (fields.len(), self.names.len());
        if surplus(&mut fields, &self.names) {
            let place = Place::at(self.path, at, found.min(expected) + 1);
            let reason = LogReason::FieldCount { found, expected };
            return Err(Error::refused(place, reason));
        }
        let source = RowSource::Text(&fields);
        self.take(
            &Cells {
                reader: self,
                source,
                at,
            },
            row,
        )
    }

    /// Fills `row` from one row of a table's columns; what is not a number is a gap.
    ///
    /// # Errors
    /// An infinite number, a flag that is neither 0 nor 1, and a row without a time.
    pub fn fill_numbers(
        &self,
        columns: &[Vec<f64>],
        number: usize,
        row: &mut LogRow,
    ) -> Result<()> {
        let source = RowSource::Numbers(columns, number);
        let at = number + 1;
        self.take(
            &Cells {
                reader: self,
                source,
                at,
            },
            row,
        )
    }

    fn take(&self, line: &Cells, row: &mut LogRow) -> Result<()> {
        row.time_s = line.value(&self.time)?;
        row.segment = self.segment.as_ref().map(|cell| line.text(cell).into());
        row.supply_v = self.supply.as_ref().map(|q| line.gap_or(q)).transpose()?;
        // An empty one holds the value of the row before.
        if !self
            .torque_on
            .as_ref()
            .is_some_and(|cell| line.is_gap(cell))
        {
            row.torque_on = line.flag(&self.torque_on)?;
        }
        row.payload_kg = line.maybe(&self.payload)?.unwrap_or(0.0);
        row.turned = line.flag(&self.turned)?.unwrap_or(false);
        row.position_rad.clear();
        row.velocity_rad_s.clear();
        row.rate_rad_s.clear();
        row.input.clear();
        for joint in &self.joints {
            let position = line.mean(&joint.position)?;
            row.position_rad.push(position.unwrap_or(f64::NAN));
            row.velocity_rad_s.push(line.mean(&joint.velocity)?);
            row.rate_rad_s.push(line.mean(&joint.rate)?);
            row.input.push(line.mean(&joint.input)?);
        }
        Ok(())
    }
}

/// What a row is made of.
enum RowSource<'a> {
    /// The fields of one line.
    Text(&'a [Cow<'a, str>]),
    /// A row of these columns, counted from 0.
    Numbers(&'a [Vec<f64>], usize),
}

/// The fields of one row.
struct Cells<'a> {
    reader: &'a RowReader<'a>,
    source: RowSource<'a>,
    at: usize,
}

impl Cells<'_> {
    fn maybe(&self, quantity: &Option<LogQuantity>) -> Result<Option<f64>> {
        quantity
            .as_ref()
            .map(|quantity| self.value(quantity))
            .transpose()
    }

    /// The mean of columns, a gap if one of them has one; none of none.
    fn mean(&self, columns: &[LogQuantity]) -> Result<Option<f64>> {
        let mut sum = 0.0;
        for quantity in columns {
            sum += self.gap_or(quantity)?;
        }
        Ok((!columns.is_empty()).then(|| sum / columns.len() as f64))
    }

    /// The value, or not a number where there is none.
    fn gap_or(&self, quantity: &LogQuantity) -> Result<f64> {
        if self.is_gap(&quantity.cell) {
            Ok(f64::NAN)
        } else {
            self.value(quantity)
        }
    }

    fn value(&self, LogQuantity { cell, column }: &LogQuantity) -> Result<f64> {
        let written = match cell {
            LogCell::Constant(value, _) => Some(*value),
            LogCell::Field(index) if column.unit.name == "iso8601" => {
                return self.stamp_s(cell, *index);
            }
            LogCell::Field(index) => self.written(*index),
        };
        match written.map(|written| column.to_si(written)) {
            Some(value) if value.is_finite() => self.reading(cell, column, value),
            Some(_) => Err(self.refuse(cell, "finite")),
            None if column.unit.dimension == Dimension::Time => Err(self.no_time(cell)),
            None => Err(self.refuse(cell, "a number")),
        }
    }

    /// The value, unless no sensor gives one as large.
    fn reading(&self, cell: &LogCell, column: &Column, value: f64) -> Result<f64> {
        let found = || self.text(cell).into();
        match beyond_readings(self.name(cell), value, column.unit.dimension, found) {
            Some(reason) => Err(Error::refused(self.place(cell), reason)),
            None => Ok(value),
        }
    }

    /// The number that stands in a field, if one does.
    fn written(&self, index: usize) -> Option<f64> {
        match &self.source {
            RowSource::Text(fields) => number(&fields[index], self.reader.separator),
            RowSource::Numbers(columns, row) => Some(columns[index][*row]).filter(|v| !v.is_nan()),
        }
    }

    /// Seconds since the file's first stamp.
    fn stamp_s(&self, cell: &LogCell, index: usize) -> Result<f64> {
        let stamp_ns =
            iso_ns(&self.text(&LogCell::Field(index))).ok_or_else(|| self.refuse(cell, STAMP))?;
        let first_ns = self.reader.first_ns.get().unwrap_or(stamp_ns);
        self.reader.first_ns.set(Some(first_ns));
        Ok(stamp_ns.saturating_sub(first_ns) as f64 / 1e9)
    }

    fn is_gap(&self, cell: &LogCell) -> bool {
        match (cell, &self.source) {
            (LogCell::Field(index), RowSource::Numbers(columns, row)) => {
                columns[*index][*row].is_nan()
            }
            (cell, _) => {
                let text = self.text(cell);
                is_missing(&text)
            }
        }
    }

    fn flag(&self, cell: &Option<LogCell>) -> Result<Option<bool>> {
        let Some(cell) = cell else { return Ok(None) };
        let text = self.text(cell).to_ascii_lowercase();
        match (text.as_str(), number(&text, self.reader.separator)) {
            ("true", _) | (_, Some(1.0)) => Ok(Some(true)),
            ("false", _) | (_, Some(0.0)) => Ok(Some(false)),
            _ => Err(self.refuse(cell, FLAG)),
        }
    }

    fn text(&self, cell: &LogCell) -> Cow<'_, str> {
        match cell {
            LogCell::Field(index) => match &self.source {
                RowSource::Text(fields) => Cow::Borrowed(&fields[*index]),
                RowSource::Numbers(columns, row) if columns[*index][*row].is_nan() => "".into(),
                RowSource::Numbers(columns, row) => columns[*index][*row].to_string().into(),
            },
            LogCell::Constant(value, _) => value.to_string().into(),
        }
    }

    /// A time that is no number: a stamp needs no more than another unit.
    fn no_time(&self, cell: &LogCell) -> Error {
        let found = self.text(cell);
        if iso_ns(&found).is_none() {
            return self.refuse(cell, "a number");
        }
        let reason = LogReason::TimeStamp {
            column: self.name(cell).to_string(),
            found: found.into(),
        };
        Error::refused(self.place(cell), reason)
    }

    fn refuse(&self, cell: &LogCell, expected: &'static str) -> Error {
        let reason = LogReason::WrongField {
            column: self.name(cell).to_string(),
            found: self.text(cell).into(),
            expected,
        };
        Error::refused(self.place(cell), reason)
    }

    fn name(&self, cell: &LogCell) -> &str {
        match cell {
            LogCell::Field(index) => &self.reader.names[*index],
            LogCell::Constant(..) => "a constant",
        }
    }

    fn place(&self, cell: &LogCell) -> Place {
        let line = match cell {
            LogCell::Field(_) => self.at,
            LogCell::Constant(_, line) => *line,
        };
        Place::at(self.reader.path, line, cell.column())
    }
}
