//! Writes how a model reads its logs into its file's text: columns, angles, drives.

use super::{checked, document, misfit, number, put, tables};
use crate::error::Result;
use crate::model::{Angles, Column, Drive, Model, Motor, Unit};
use std::path::Path;
use toml_edit::{DocumentMut, Item, TableLike, Value};

/// The text with everything of how logs are read that differs between the models `old`, which it
/// holds, and `new`: units, signs, offsets and shifts of columns, the angles' zero and what they
/// are measured from, and the drives.
///
/// # Errors
/// The text is no model, or not `old`.
pub fn set_reading(text: &str, path: &Path, old: &Model, new: &Model) -> Result<String> {
    let mut document = document(text, path)?;
    set_rig(&mut document, old, new)
        .and_then(|()| set_drives(&mut document, old, new))
        .and_then(|()| set_columns(&mut document, old, new))
        .ok_or_else(|| misfit(path, "the file is not this model's"))?;
    checked(document, path)
}

fn set_rig(document: &mut DocumentMut, old: &Model, new: &Model) -> Option<()> {
    let rig = document.get_mut("rig")?.as_table_like_mut()?;
    if old.angle_zero != new.angle_zero {
        put(rig, "angle_zero", new.angle_zero.name().into());
    }
    if old.angles != new.angles {
        let name = match new.angles {
            Angles::Relative => "relative",
            Angles::Absolute => "absolute",
        };
        put(rig, "angles", name.into());
    }
    Some(())
}

fn set_drives(document: &mut DocumentMut, old: &Model, new: &Model) -> Option<()> {
    for (index, (old, new)) in old.joints.iter().zip(&new.joints).enumerate() {
        if old.drive == new.drive {
            continue;
        }
        let joint = tables(document.get_mut("joint")?).nth(index)?;
        put(joint, "drive", new.drive.name().into());
        let values = values(&new.drive);
        for (key, value) in values {
            match value {
                Some(value) => put(joint, key, number(value)),
                None => drop(joint.remove(key)),
            }
        }
    }
    Some(())
}

/// Every key of a drive, with its value if the drive has one.
fn values(drive: &Drive) -> [(&'static str, Option<f64>); 5] {
    let motor = |value: fn(&Motor) -> Option<f64>| drive.motor().and_then(value);
    let per_rad = match drive {
        Drive::Position { gain_per_rad, .. } => Some(*gain_per_rad),
        _ => None,
    };
    let per_rad_s = match drive {
        Drive::Speed { gain_s_per_rad, .. } => Some(*gain_s_per_rad),
        _ => None,
    };
    let no_load = |m: &Motor| Some(m.no_load_speed_rad_s).filter(|speed| speed.is_finite());
    [
        ("gain_per_rad", per_rad),
        ("gain_s_per_rad", per_rad_s),
        ("stall_torque_nm", motor(|m| Some(m.stall_torque_nm))),
        ("no_load_speed_rad_s", motor(no_load)),
        ("nominal_supply_v", motor(|m| m.nominal_supply_v)),
    ]
}

fn set_columns(document: &mut DocumentMut, old: &Model, new: &Model) -> Option<()> {
    let log = document.get_mut("log")?;
    let times = std::slice::from_ref(&old.log.time);
    set_columns_of(
        log.get_mut("time")?,
        times,
        std::slice::from_ref(&new.log.time),
    )?;
    for (index, (old, new)) in old.log.joints.iter().zip(&new.log.joints).enumerate() {
        let joint = tables(log.get_mut("joint")?).nth(index)?;
        let pairs = [
            ("position", &old.position, &new.position),
            ("velocity", &old.velocity, &new.velocity),
            (old.rate_sensor.key(), &old.rate, &new.rate),
            ("input", &old.input, &new.input),
        ];
        for (key, old, new) in pairs {
            if let (Some(old), Some(new)) = (old, new) {
                set_columns_of(joint.get_mut(key)?, old.columns(), new.columns())?;
            }
        }
    }
    Some(())
}

/// The columns of one quantity: a table, or a list of tables.
fn set_columns_of(item: &mut Item, old: &[Column], new: &[Column]) -> Option<()> {
    if old == new {
        return Some(());
    }
    if let Item::Value(Value::InlineTable(table)) = item {
        set_column(table, old.first()?, new.first()?);
        table.fmt();
        return Some(());
    }
    if let Item::Table(table) = item {
        set_column(table, old.first()?, new.first()?);
        return Some(());
    }
    for (table, (old, new)) in tables(item).zip(old.iter().zip(new)) {
        set_column(table, old, new);
    }
    Some(())
}

fn set_column(table: &mut dyn TableLike, old: &Column, new: &Column) {
    if old.unit != new.unit {
        put(table, "unit", new.unit.name.into());
        for unit in ["ticks", "A"] {
            let dimension = new.unit.dimension;
            let key = Unit::scale_key(unit, dimension);
            let own = new
                .unit
                .scale()
                .filter(|_| Unit::scale_key(new.unit.name, dimension) == key);
            if let Some(key) = key {
                put_or_remove(table, key, own.map(number));
            }
        }
    }
    if old.reversed != new.reversed {
        put_or_remove(table, "reversed", new.reversed.then(|| true.into()));
    }
    let suffix = new.unit.dimension.suffix();
    if old.unit.dimension != new.unit.dimension {
        // Keys of the old dimension mean nothing in the new one.
        for key in ["offset", "resolution"] {
            table.remove(&format!("{key}{}", old.unit.dimension.suffix()));
        }
    }
    let offset = (new.offset != 0.0).then(|| number(new.offset));
    if old.offset != new.offset {
        put_or_remove(table, &format!("offset{suffix}"), offset);
    }
    if old.shift_s != new.shift_s {
        let shift = (new.shift_s != 0.0).then(|| number(new.shift_s));
        put_or_remove(table, "shift_s", shift);
    }
}

fn put_or_remove(table: &mut dyn TableLike, key: &str, value: Option<Value>) {
    match value {
        Some(value) => put(table, key, value),
        None => drop(table.remove(key)),
    }
}

/// The lines of `new` that differ from `old`, each with its number in `old` where both have as many
/// lines, as an editor counts.
pub fn changed_lines(old: &str, new: &str) -> Vec<(Option<usize>, String)> {
    let (before, after): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
    if before.len() == after.len() {
        let pairs = before.iter().zip(&after).enumerate();
        let changed = pairs.filter(|(_, (before, after))| before != after);
        return changed
            .map(|(index, (_, line))| (Some(index + 1), line.trim().to_string()))
            .collect();
    }
    let new = after.iter().filter(|line| !before.contains(line));
    new.map(|line| (None, line.trim().to_string())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::AngleZero;

    const TEXT: &str = "[rig]\nname = \"a\"\nangle_zero = \"hanging\"\n[[link]]\ncom_m = 0.1\n\
        mass_kg = 1.0\ninertia_kg_m2 = 1e-3\n[[joint]]\ndrive = \"torque\" # geared\n[log]\n\
        time = { column = \"t\", unit = \"s\" }\n[[log.joint]]\n\
        position = { column = \"q\", unit = \"rad\", resolution_rad = 0.001 } # counts\n\
        input = { column = \"u\", unit = \"N m\" }\n";

    #[track_caller]
    fn written(change: impl Fn(&mut Model)) -> Vec<(Option<usize>, String)> {
        let path = Path::new("a.toml");
        let old = Model::parse(TEXT, path).unwrap();
        let mut new = old.clone();
        change(&mut new);
        let text = set_reading(TEXT, path, &old, &new).unwrap();
        assert_eq!(Model::parse(&text, path).unwrap(), new);
        changed_lines(TEXT, &text)
    }

    #[test]
    fn a_change_of_reading_is_one_of_lines() {
        let lines = written(|m| {
            m.log.joints[0].position.as_mut().unwrap().columns_mut()[0].reversed = true
        });
        let position = "position = { column = \"q\", unit = \"rad\", resolution_rad = 0.001, \
                        reversed = true } # counts";
        assert_eq!(lines, [(Some(13), position.to_string())]);
        let lines = written(|m| m.angle_zero = AngleZero::Upright);
        assert_eq!(lines, [(Some(3), "angle_zero = \"upright\"".to_string())]);
        let lines =
            written(|m| m.log.joints[0].input.as_mut().unwrap().columns_mut()[0].shift_s = -0.03);
        let input = "input = { column = \"u\", unit = \"N m\", shift_s = -0.03 }";
        assert_eq!(lines, [(Some(14), input.to_string())]);
        assert_eq!(written(|_| ()), []);
    }

    #[test]
    fn another_drive_brings_its_values_and_its_unit() {
        let lines = written(|m| {
            m.joints[0].drive = Drive::Position {
                gain_per_rad: 5.0,
                motor: Motor {
                    stall_torque_nm: 2.0,
                    no_load_speed_rad_s: f64::INFINITY,
                    nominal_supply_v: None,
                },
            };
            let unit = crate::model::Unit::named("rad", None).unwrap();
            m.log.joints[0].input.as_mut().unwrap().columns_mut()[0].unit = unit;
        });
        let lines: Vec<String> = lines.into_iter().map(|(_, line)| line).collect();
        assert_eq!(
            lines,
            [
                "drive = \"position\" # geared",
                "gain_per_rad = 5.0",
                "stall_torque_nm = 2.0",
                "input = { column = \"u\", unit = \"rad\" }"
            ]
        );
    }
}
