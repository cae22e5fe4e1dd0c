//! One sample as numbers in SI.

use super::header::{Cell, Header, fields, number};
use crate::error::{Error, Place, Result};
use crate::model::{Column, LogColumns};
use std::path::{Path, PathBuf};

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
pub struct Row {
    /// The file.
    pub path: PathBuf,
    /// Line in the file, counted from 1; 0 in a JSON log.
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

impl Row {
    /// Sample `index` of a motion that came from no CSV.
    pub(super) fn of(motion: &super::Motion, index: usize) -> Row {
        let joints = motion.position_rad.len();
        let at = |series: &Option<Vec<f64>>| series.as_ref().map(|values| values[index]);
        Row {
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
            ..Row::default()
        }
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
pub(super) struct Reader<'a> {
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

impl<'a> Reader<'a> {
    /// Finds every column the model names.
    ///
    /// # Errors
    /// A column that is missing or ambiguous.
    pub fn new(path: &'a Path, columns: &'a LogColumns, header: &Header) -> Result<Self> {
        let cell = |column: &Column| header.cell(&column.name);
        let maybe = |column: &Option<Column>| column.as_ref().map(cell).transpose();
        let flag = |name: &Option<String>| name.as_ref().map(|n| header.cell(n)).transpose();
        let joints = &columns.joints;
        Ok(Reader {
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
    pub fn fill(&self, line: &str, at: usize, row: &mut Row) -> Result<()> {
        let fields = fields(line, self.separator);
        if fields.len() != self.names.len() {
            let column = fields.len().min(self.names.len()) + 1;
            return Err(Error::data(
                Place::at(self.path, at, column),
                format!(
                    "{} fields where the header has {}",
                    fields.len(),
                    self.names.len()
                ),
                "the line is broken off or joined with another: delete it, or record again",
            ));
        }
        let line = Line {
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

struct Line<'a> {
    reader: &'a Reader<'a>,
    fields: &'a [std::borrow::Cow<'a, str>],
    at: usize,
}

impl Line<'_> {
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

    fn refuse(&self, cell: &Cell, wanted: &str) -> Error {
        let (line, name) = match cell {
            Cell::Field(index) => (self.at, self.reader.names[*index].as_str()),
            Cell::Constant(_, line) => (*line, "a constant"),
        };
        let text: String = self.text(cell).chars().take(40).collect();
        let found = match text.as_str() {
            "" => "nothing".to_string(),
            text => format!("'{text}'"),
        };
        Error::data(
            Place::at(self.reader.path, line, cell.column()),
            format!("{name}: {found} is not {wanted}"),
            "the model reads this column: delete the line, or leave it out by a row range such as log.csv:26-139",
        )
    }
}
