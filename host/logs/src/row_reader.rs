//! Reads the rows of a table in SI, by the columns that a model names.

use super::cell::decimal_comma;
use super::fault::{CellFault, DECIMAL_COMMAS, LogFault, RowFault, WrongCell, quoted};
use super::iso::iso_ns;
use super::reading_limit::beyond_readings;
use super::row::{Fields, LogRow};
use super::table::{LogCell, LogTable};
use crate::error::{Error, Place, Problem, Result};
use crate::model::{Column, ColumnMean, Dimension, LogColumns};
use std::borrow::Cow;
use std::cell::Cell;
use std::path::Path;

/// What a field with a time stamp must be.
const STAMP: &str = "a time stamp such as 2026-03-01T12:00:00.5Z";
/// What a flag must be.
const FLAG: &str = "0 or 1";

/// What is read of a row, or what is wrong with it.
type Read<T> = std::result::Result<T, Box<LogFault>>;

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

/// Reads the rows of one file.
pub(super) struct RowReader<'a> {
    path: &'a Path,
    table: &'a LogTable,
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
    pub fn new(path: &'a Path, columns: &'a LogColumns, table: &'a LogTable) -> Result<Self> {
        let named = |name: &str| table.cell(path, name);
        let cell = |name: &Option<String>| name.as_deref().map(named).transpose();
        let quantity = |column: &'a Column| {
            let cell = named(&column.name)?;
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
            table,
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
        if self.table.is_entries {
            return Fields {
                position: vec![0; self.joints.len()],
                input: vec![0; self.joints.len()],
                ..Fields::default()
            };
        }
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

    /// Fills `row` from one row of the table, counted from 0.
    ///
    /// What is not a number, or says `nan`, `NA`, `NULL` or the like, is a gap: that quantity is
    /// not a number in this row.
    ///
    /// # Errors
    /// Too few or too many fields, fields that hold something else than a finite number, a flag
    /// that is neither 0 nor 1, and a row without a time.
    pub fn fill(&self, index: usize, row: &mut LogRow) -> Read<()> {
        row.line = self.table.line(index);
        if let Some((field, fault)) = self.table.fault(index) {
            let place = Place::at(self.path, row.line, field);
            let cell = matches!(fault, RowFault::Fields { .. }).then(|| WrongCell {
                column: String::new(),
                fault: CellFault::Fields,
                of_column: None,
            });
            let problem = fault.problem();
            return Err(Box::new(LogFault {
                place,
                problem,
                cell,
            }));
        }
        let line = Cells {
            reader: self,
            row: index,
        };
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

/// The fields of one row.
struct Cells<'a> {
    reader: &'a RowReader<'a>,
    /// Counted from 0.
    row: usize,
}

impl Cells<'_> {
    fn maybe(&self, quantity: &Option<LogQuantity>) -> Read<Option<f64>> {
        quantity
            .as_ref()
            .map(|quantity| self.value(quantity))
            .transpose()
    }

    /// The mean of columns, a gap if one of them has one; none of none.
    fn mean(&self, columns: &[LogQuantity]) -> Read<Option<f64>> {
        let mut sum = 0.0;
        for quantity in columns {
            sum += self.gap_or(quantity)?;
        }
        Ok((!columns.is_empty()).then(|| sum / columns.len() as f64))
    }

    /// The value, or not a number where there is none.
    fn gap_or(&self, quantity: &LogQuantity) -> Read<f64> {
        if self.is_gap(&quantity.cell) {
            Ok(f64::NAN)
        } else {
            self.value(quantity)
        }
    }

    fn value(&self, LogQuantity { cell, column }: &LogQuantity) -> Read<f64> {
        let written = match cell {
            LogCell::Constant(value, _) => Some(*value),
            LogCell::Field(_) if column.unit.name == "iso8601" => {
                return self.stamp_s(cell);
            }
            LogCell::Field(index) => self.table().number(self.row, *index),
        };
        match written.map(|written| column.to_si(written)) {
            Some(value) if value.is_finite() => self.reading(cell, column, value),
            Some(_) => Err(self.refuse(cell, "finite")),
            None if column.unit.dimension == Dimension::Time => Err(self.no_time(cell)),
            None => Err(self.refuse(cell, "a number")),
        }
    }

    /// The value, unless no sensor gives one as large.
    fn reading(&self, cell: &LogCell, column: &Column, value: f64) -> Read<f64> {
        let found = || self.text(cell).into();
        match beyond_readings(self.name(cell), value, column.unit.dimension, found) {
            Some(problem) => Err(self.wrong(cell, CellFault::Beyond, problem, None)),
            None => Ok(value),
        }
    }

    fn table(&self) -> &LogTable {
        self.reader.table
    }

    /// Seconds since the file's first stamp.
    fn stamp_s(&self, cell: &LogCell) -> Read<f64> {
        let stamp_ns = iso_ns(&self.text(cell)).ok_or_else(|| self.refuse(cell, STAMP))?;
        let first_ns = self.reader.first_ns.get().unwrap_or(stamp_ns);
        self.reader.first_ns.set(Some(first_ns));
        Ok(stamp_ns.saturating_sub(first_ns) as f64 / 1e9)
    }

    fn is_gap(&self, cell: &LogCell) -> bool {
        match cell {
            LogCell::Field(index) => self.table().is_gap(self.row, *index),
            LogCell::Constant(..) => false,
        }
    }

    fn flag(&self, cell: &Option<LogCell>) -> Read<Option<bool>> {
        let Some(cell) = cell else { return Ok(None) };
        let value = match cell {
            LogCell::Field(index) => self.table().number(self.row, *index),
            LogCell::Constant(value, _) => Some(*value),
        };
        match (value, self.text(cell)) {
            (Some(1.0), _) => Ok(Some(true)),
            (Some(0.0), _) => Ok(Some(false)),
            (None, text) if text.eq_ignore_ascii_case("true") => Ok(Some(true)),
            (None, text) if text.eq_ignore_ascii_case("false") => Ok(Some(false)),
            _ => Err(self.refuse(cell, FLAG)),
        }
    }

    fn text(&self, cell: &LogCell) -> Cow<'_, str> {
        match cell {
            LogCell::Field(index) => self.table().text(self.row, *index),
            LogCell::Constant(value, _) => value.to_string().into(),
        }
    }

    /// A time that is no number: a stamp needs no more than another unit.
    fn no_time(&self, cell: &LogCell) -> Box<LogFault> {
        let found = self.text(cell);
        if iso_ns(&found).is_none() {
            return self.refuse(cell, "a number");
        }
        let problem = Problem::new(
            format!(
                "{}: {} is a time stamp, not a number",
                self.name(cell),
                quoted(&found)
            ),
            "write unit = \"iso8601\" for this column in the model's [log]",
        );
        self.wrong(cell, CellFault::Stamp, problem, None)
    }

    fn refuse(&self, cell: &LogCell, expected: &'static str) -> Box<LogFault> {
        let found = self.text(cell);
        let what = format!("{}: {} is not {expected}", self.name(cell), quoted(&found));
        let fault = match &*found {
            "" => CellFault::Nothing,
            _ => CellFault::Not(expected),
        };
        if decimal_comma(&found).is_some() {
            return self.wrong(cell, fault, Problem::new(what, DECIMAL_COMMAS), None);
        }
        let problem = Problem::new(
            what,
            "the model reads this column: delete the line, or leave it out by a row range such as \
             log.csv:26-139",
        );
        self.wrong(cell, fault, problem, Some(of_column(&found, expected)))
    }

    fn wrong(
        &self,
        cell: &LogCell,
        fault: CellFault,
        problem: Problem,
        of_column: Option<&'static str>,
    ) -> Box<LogFault> {
        Box::new(LogFault {
            place: self.place(cell),
            problem,
            cell: Some(WrongCell {
                column: self.name(cell).to_string(),
                fault,
                of_column,
            }),
        })
    }

    fn name(&self, cell: &LogCell) -> &str {
        match cell {
            LogCell::Field(index) => &self.table().names[*index],
            LogCell::Constant(..) => "a constant",
        }
    }

    fn place(&self, cell: &LogCell) -> Place {
        let line = match cell {
            LogCell::Field(_) => self.table().line(self.row),
            LogCell::Constant(_, line) => *line,
        };
        Place::at(self.reader.path, line, cell.column())
    }
}

/// What to do about a column in which this was found throughout.
fn of_column(found: &str, expected: &str) -> &'static str {
    let is_number = found.replacen(',', ".", 1).parse::<f64>().is_ok();
    match expected {
        _ if found.is_empty() => "record this column, or name another one in the model's [log]",
        STAMP if is_number => {
            "write the unit of these numbers for this column in the model's [log]: \
             unit = \"s\", \"ms\", \"us\" or \"ns\""
        }
        STAMP => {
            "save the times as such stamps, or as numbers with their unit in the model's [log]"
        }
        FLAG => "save this column as 0 and 1, or take it out of the model's [log]",
        _ => {
            "name a column of numbers in the model's [log], or save this one as numbers with a \
             decimal point"
        }
    }
}
