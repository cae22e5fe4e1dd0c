//! A log's columns as guessed.

use crate::log::RawLog;
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
    /// Counts per turn, where the unit is `ticks`.
    pub ticks_per_turn: Option<f64>,
    /// Whether it counts the other way round.
    pub reversed: bool,
}

impl ColumnGuess {
    /// Its values in SI.
    pub fn si(&self, log: &RawLog) -> Vec<f64> {
        let sign = if self.reversed { -1.0 } else { 1.0 };
        let factor = Unit::named(self.unit, self.ticks_per_turn).map_or(1.0, |unit| unit.si);
        let values = log.columns[self.index].iter();
        values.map(|value| sign * factor * value).collect()
    }

    /// Its unit in a sentence.
    pub fn unit_words(&self) -> String {
        match self.ticks_per_turn {
            Some(ticks) => format!("{}, {ticks} per turn", self.unit),
            None => self.unit.to_string(),
        }
    }

    /// Name and unit as in a model file.
    pub fn toml(&self) -> String {
        let name = toml_edit::Value::from(self.name.as_str());
        let mut text = format!("{{ column = {name}, unit = \"{}\"", self.unit);
        if let Some(ticks) = self.ticks_per_turn {
            text += &format!(", ticks_per_turn = {ticks}");
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
