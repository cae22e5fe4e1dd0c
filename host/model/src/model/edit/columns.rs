//! Columns of a model's logs, picked by hand: names, units, signs and zeros.

use super::{checked, document, misfit};
use crate::error::Result;
use crate::model::{Dimension, Model};
use serde::Deserialize;
use std::path::Path;
use toml_edit::{InlineTable, Item, TableLike, Value};

/// Where a model finds its quantities in a log.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ColumnChoice {
    /// The columns that were picked; what is not named stays as it is.
    pub columns: Vec<ChosenColumn>,
}

/// The column of a quantity.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ChosenColumn {
    /// `time`, `supply`, `joint1.position`, `joint1.velocity`, `joint1.gyro`,
    /// `joint1.tachometer`, `joint1.input`.
    pub quantity: String,
    /// The header's name; empty where the log has no such column.
    pub column: String,
    /// The unit it is written in.
    pub unit: String,
    /// Whether it counts the other way round.
    #[serde(default)]
    pub reversed: bool,
    /// Added after scaling, SI.
    #[serde(default)]
    pub offset: f64,
}

/// The text with these columns in its `[log]`; comments and layout stay.
///
/// # Errors
/// The text is no model, or cannot have such a column.
pub fn set_log_columns(text: &str, path: &Path, choice: &ColumnChoice) -> Result<String> {
    let model = Model::parse(text, path)?;
    let mut document = document(text, path)?;
    for chosen in &choice.columns {
        let unknown = || misfit(path, &format!("there is no quantity `{}`", chosen.quantity));
        let place = place(&model, &chosen.quantity).ok_or_else(unknown)?;
        let log = document.get_mut("log").and_then(Item::as_table_like_mut);
        let owner = match (log, place.joint) {
            (Some(log), None) => Some(log),
            (Some(log), Some(joint)) => {
                super::tables(log.get_mut("joint").ok_or_else(unknown)?).nth(joint)
            }
            (None, _) => None,
        };
        put(owner.ok_or_else(unknown)?, &place, chosen);
    }
    checked(document, path)
}

/// Where a quantity stands, and what it measures.
struct QuantityPlace {
    joint: Option<usize>,
    key: &'static str,
    dimension: Dimension,
}

fn place(model: &Model, quantity: &str) -> Option<QuantityPlace> {
    let (joint, name) = match quantity.split_once('.') {
        None => (None, quantity),
        Some((joint, name)) => {
            let number: usize = joint.strip_prefix("joint")?.parse().ok()?;
            (Some(number.checked_sub(1)?), name)
        }
    };
    let (key, dimension) = match (joint, name) {
        (None, "time") => ("time", Dimension::Time),
        (None, "supply") => ("supply", Dimension::Voltage),
        (Some(joint), name) => {
            let own = model.joints.get(joint)?;
            match name {
                "position" => ("position", Dimension::Angle.on(own.axis())),
                "velocity" => ("velocity", Dimension::Speed.on(own.axis())),
                "gyro" => ("gyro", Dimension::Speed),
                "tachometer" => ("tachometer", Dimension::Speed),
                "input" => ("input", Dimension::of_input(own.drive.name(), own.axis())?),
                _ => return None,
            }
        }
        _ => return None,
    };
    Some(QuantityPlace {
        joint,
        key,
        dimension,
    })
}

fn put(owner: &mut dyn TableLike, place: &QuantityPlace, chosen: &ChosenColumn) {
    if chosen.column.is_empty() {
        owner.remove(place.key);
        return;
    }
    if owner.get(place.key).and_then(Item::as_table_like).is_none() {
        owner.insert(
            place.key,
            Item::Value(Value::InlineTable(InlineTable::new())),
        );
    }
    let Some(table) = owner.get_mut(place.key).and_then(Item::as_table_like_mut) else {
        return;
    };
    table.insert("column", toml_edit::value(chosen.column.as_str()));
    table.insert("unit", toml_edit::value(chosen.unit.as_str()));
    let offset = format!("offset{}", place.dimension.suffix());
    set_or_remove(table, &offset, chosen.offset != 0.0, chosen.offset.into());
    set_or_remove(table, "reversed", chosen.reversed, true.into());
}

/// Writes a value that says something; one that says nothing is left out.
fn set_or_remove(table: &mut dyn TableLike, key: &str, says: bool, value: Value) {
    if says {
        table.insert(key, Item::Value(value));
    } else {
        table.remove(key);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARM: &str = r#"
[rig]
name = "arm" # the only one
angle_zero = "hanging"

[[link]]
com_m = 0.1
mass_kg = 0.2
inertia_kg_m2 = 1e-4

[[joint]]
drive = "torque"

[log]
time = { column = "t", unit = "s" }

[[log.joint]]
position = { column = "q", unit = "rad", resolution_rad = 0.001 } # encoder
input = { column = "u", unit = "N m" }
"#;

    fn chosen(quantity: &str, column: &str, unit: &str) -> ChosenColumn {
        ChosenColumn {
            quantity: quantity.into(),
            column: column.into(),
            unit: unit.into(),
            reversed: false,
            offset: 0.0,
        }
    }

    fn set(columns: Vec<ChosenColumn>) -> Result<String> {
        set_log_columns(ARM, Path::new("arm.toml"), &ColumnChoice { columns })
    }

    #[test]
    fn picked_columns_are_read_and_comments_stay() {
        let text = set(vec![
            ChosenColumn {
                reversed: true,
                offset: 0.5,
                ..chosen("joint1.position", "angle \"deg\"", "deg")
            },
            chosen("supply", "volts", "V"),
            chosen("joint1.velocity", "", ""),
        ])
        .unwrap();
        let model = Model::parse(&text, Path::new("arm.toml")).unwrap();
        let position = &model.log.joints[0].position.as_ref().unwrap().columns()[0];
        assert_eq!(position.name, "angle \"deg\"");
        assert!(position.reversed && position.offset == 0.5);
        assert_eq!(position.resolution, Some(0.001));
        assert!((position.to_si(180.0) + std::f64::consts::PI - 0.5).abs() < 1e-12);
        assert_eq!(model.log.supply.unwrap().name, "volts");
        assert!(text.contains("# the only one") && text.contains("# encoder"));
    }

    #[test]
    fn what_the_model_cannot_have_is_refused() {
        for wrong in [
            chosen("joint2.position", "q", "rad"),
            chosen("joint0.position", "q", "rad"),
            chosen("mood", "q", "rad"),
            chosen("time", "", ""),
            chosen("joint1.position", "q", "V"),
        ] {
            assert!(set(vec![wrong.clone()]).is_err(), "{wrong:?}");
        }
    }
}
