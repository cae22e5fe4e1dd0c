//! A log's columns as guessed.

use crate::RawLog;
use crate::model::Unit;

/// A column, and how it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnGuess {
    /// Index in the log.
    pub index: usize,
    /// The header's name.
    pub name: String,
    /// Unit, by its name in model files.
    pub unit: &'static str,
    /// Counts per turn, where the unit is `ticks`, or of the full scale, where it is `counts`.
    pub scale: Option<f64>,
    /// Whether it counts the other way round.
    pub reversed: bool,
    /// Added to an angle, rad.
    pub offset_rad: f64,
}

impl ColumnGuess {
    /// Its values in SI.
    pub fn si(&self, log: &RawLog) -> Vec<f64> {
        let sign = if self.reversed { -1.0 } else { 1.0 };
        let factor = Unit::named(self.unit, self.scale).map_or(1.0, |unit| unit.si);
        let values = log.columns[self.index].iter();
        values
            .map(|value| sign * factor * value + self.offset_rad)
            .collect()
    }

    /// Its unit in a sentence.
    pub fn unit_words(&self) -> String {
        match (self.unit, self.scale) {
            ("counts", Some(full)) => format!("counts of {full}"),
            (unit, Some(ticks)) => format!("{unit}, {ticks} per turn"),
            (unit, None) => unit.to_string(),
        }
    }

    /// Name and unit as in a model file.
    pub fn toml(&self) -> String {
        let name = toml_edit::Value::from(self.name.as_str());
        let mut text = format!("{{ column = {name}, unit = \"{}\"", self.unit);
        let dimension = Unit::named(self.unit, self.scale).map(|unit| unit.dimension);
        let key = dimension.and_then(|dimension| Unit::scale_key(self.unit, dimension));
        if let (Some(key), Some(scale)) = (key, self.scale) {
            text += &format!(", {key} = {scale}");
        }
        if self.offset_rad != 0.0 {
            text += &format!(", offset_rad = {:?}", self.offset_rad);
        }
        if self.reversed {
            text += ", reversed = true";
        }
        text + " }"
    }
}

/// The columns of one joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointGuess {
    /// What the names call it; empty where there is one joint.
    pub name: String,
    /// Measured angle.
    pub position: Option<ColumnGuess>,
    /// Measured speed.
    pub velocity: Option<ColumnGuess>,
    /// `passive`, `torque`, `duty`, `position` or `speed`.
    pub drive: &'static str,
    /// The drive's input.
    pub input: Option<ColumnGuess>,
}

/// Every column that a model needs.
#[derive(Debug, Clone, PartialEq)]
pub struct LogGuess {
    /// Time.
    pub time: ColumnGuess,
    /// Name of the column that marks motions.
    pub segment: Option<String>,
    /// Supply.
    pub supply: Option<ColumnGuess>,
    /// Name of the column that says whether drives are energised.
    pub torque_on: Option<String>,
    /// From the base outwards.
    pub joints: Vec<JointGuess>,
    /// What each log says that it carries.
    pub payload: Option<PayloadGuess>,
    /// Whether the log says what the links are.
    pub knows_links: bool,
}

/// A weight that each log names, kg, and where it is bolted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PayloadGuess {
    /// Its key in the log.
    pub key: &'static str,
    /// From the last joint, m.
    pub at_m: f64,
}

impl LogGuess {
    /// Names of all columns that it takes.
    pub fn names(&self) -> Vec<&str> {
        let joints = self.joints.iter();
        let joints = joints.flat_map(|j| [&j.position, &j.velocity, &j.input]);
        let columns = joints.flatten().chain(&self.supply).chain([&self.time]);
        let names = columns.map(|column| column.name.as_str());
        let marks = self
            .segment
            .as_deref()
            .into_iter()
            .chain(self.torque_on.as_deref());
        names.chain(marks).collect()
    }
}
