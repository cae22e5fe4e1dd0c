//! The `[log]` table: what the rig's columns are called and what they are written in.

use super::super::limits::Limits;
use super::super::reader::Table;
use super::super::{Column, Dimension, Drive, Joint, JointColumns, LogColumns, Unit};
use super::{ABOVE_ZERO, EITHER_SIGN, NOT_NEGATIVE};
use crate::error::Result;

/// Counts per turn; more than 2^32 is no encoder.
const TICKS: Limits = Limits::within(1.0, 4_294_967_296.0);

pub(super) fn read(root: &Table, joints: &[Joint]) -> Result<LogColumns> {
    let log = root.required_table("log")?;
    log.only(&[
        "time",
        "segment",
        "supply",
        "torque_on",
        "payload",
        "turned",
        "split_at_gap_s",
        "joint",
    ])?;
    let name = |key: &str| -> Result<_> { Ok(log.text(key)?.map(str::to_string)) };
    let payload = log.table("payload")?;
    Ok(LogColumns {
        time: column(&log.required_table("time")?, "time", Dimension::Time)?,
        segment: name("segment")?,
        supply: match log.table("supply")? {
            Some(table) => Some(column(&table, "supply", Dimension::Voltage)?),
            None => None,
        },
        torque_on: name("torque_on")?,
        payload_at_m: match &payload {
            Some(table) => table.required_number("at_m", EITHER_SIGN)?,
            None => 0.0,
        },
        payload: match &payload {
            Some(table) => Some(column(table, "payload", Dimension::Mass)?),
            None => None,
        },
        turned: name("turned")?,
        joints: joint_columns(&log, joints)?,
        split_at_gap_s: log.number("split_at_gap_s", ABOVE_ZERO)?,
    })
}

fn joint_columns(log: &Table, joints: &[Joint]) -> Result<Vec<JointColumns>> {
    let tables = log.tables("joint")?;
    if let Some(extra) = tables.get(joints.len()) {
        return Err(extra.bad_table(
            format!("is one too many for {} joint(s)", joints.len()),
            "give one `[[log.joint]]` for each `[[joint]]`, in order",
        ));
    }
    if tables.len() < joints.len() {
        return Err(log.bad_table(
            format!(
                "names the columns of {} joint(s) out of {}",
                tables.len(),
                joints.len()
            ),
            "add one `[[log.joint]]` for each `[[joint]]`, in order",
        ));
    }
    let pairs = tables.iter().zip(joints);
    pairs.map(|(table, joint)| of_joint(table, joint)).collect()
}

fn of_joint(table: &Table, joint: &Joint) -> Result<JointColumns> {
    table.only(&["position", "velocity", "input"])?;
    let position = table.required_table("position")?;
    let velocity = match table.table("velocity")? {
        Some(velocity) => Some(column(&velocity, "velocity", Dimension::Speed)?),
        None => None,
    };
    let drive = joint.drive.name();
    let dimension = match joint.drive {
        Drive::Passive => None,
        Drive::Torque => Some(Dimension::Torque),
        Drive::Duty(_) => Some(Dimension::Ratio),
        Drive::Position { .. } => Some(Dimension::Angle),
        Drive::Speed { .. } => Some(Dimension::Speed),
    };
    let input = match (dimension, table.table("input")?) {
        (None, None) => None,
        (Some(dimension), Some(input)) => Some(column(&input, "input", dimension)?),
        (None, Some(_)) => {
            return Err(table.bad_key(
                "input",
                "a passive joint has no input",
                "remove `input`, or say what drives the joint",
            ));
        }
        (Some(dimension), None) => {
            return Err(table.bad_table(
                format!("lacks `input`, and its joint is driven by `{drive}`"),
                format!(
                    "add `input = {{ column = \"...\", unit = \"{}\" }}`",
                    dimension.unit_names().next().unwrap_or("1")
                ),
            ));
        }
    };
    Ok(JointColumns {
        position: column(&position, "position", Dimension::Angle)?,
        velocity,
        input,
    })
}

fn column(table: &Table, quantity: &str, dimension: Dimension) -> Result<Column> {
    let (offset, resolution) = (key("offset", dimension), key("resolution", dimension));
    let mut known = vec!["column", "unit", offset.as_str(), resolution.as_str()];
    if dimension != Dimension::Time {
        known.push("reversed");
    }
    if table.text("unit")? == Some("ticks") {
        known.push("ticks_per_turn");
    }
    if quantity == "payload" {
        known.push("at_m");
    }
    table.only(&known)?;
    let unit = unit(table, quantity, dimension)?;
    let one_tick = (unit.name == "ticks").then_some(unit.si);
    Ok(Column {
        name: table.required_text("column")?.to_string(),
        unit,
        offset: table
            .number(&offset, Limits::within(-1e9, 1e9))?
            .unwrap_or(0.0),
        reversed: table.flag("reversed")?,
        resolution: table.number(&resolution, NOT_NEGATIVE)?.or(one_tick),
    })
}

fn unit(table: &Table, quantity: &str, dimension: Dimension) -> Result<Unit> {
    let name = table.required_text("unit")?;
    let wanted = || {
        let names: Vec<_> = dimension.unit_names().collect();
        format!("write one of: {}", names.join(", "))
    };
    let ticks = table.number("ticks_per_turn", TICKS)?;
    let Some(unit) = Unit::named(name, ticks) else {
        return Err(table.bad("unit", format!("unknown unit `{name}`"), wanted()));
    };
    if unit.dimension != dimension {
        let what = format!(
            "unit `{name}` measures {}, and `{quantity}` is {}",
            said(unit.dimension),
            said(dimension)
        );
        return Err(table.bad("unit", what, wanted()));
    }
    if unit.si.is_nan() {
        return Err(table.lacks("ticks_per_turn"));
    }
    Ok(unit)
}

/// `offset_rad`, `resolution_nm`: the stem with the suffix of the SI unit.
fn key(stem: &str, dimension: Dimension) -> String {
    let suffix = match dimension {
        Dimension::Time => "_s",
        Dimension::Angle => "_rad",
        Dimension::Speed => "_rad_s",
        Dimension::Torque => "_nm",
        Dimension::Voltage => "_v",
        Dimension::Mass => "_kg",
        Dimension::Ratio => "",
    };
    format!("{stem}{suffix}")
}

fn said(dimension: Dimension) -> &'static str {
    match dimension {
        Dimension::Time => "a time",
        Dimension::Angle => "an angle",
        Dimension::Speed => "an angular speed",
        Dimension::Torque => "a torque",
        Dimension::Voltage => "a voltage",
        Dimension::Mass => "a mass",
        Dimension::Ratio => "a share",
    }
}
