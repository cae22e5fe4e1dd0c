//! The `[log]` table: what the rig's columns are called and what they are written in.

use super::super::limits::Limits;
use super::super::reader::Table;
use super::super::{
    ArmFigures, Column, ColumnMean, Dimension, Joint, JointColumns, Link, LinkPlace, LogColumns,
    RateSensor, Robot, Unit,
};
use super::{ABOVE_ZERO, EITHER_SIGN, NOT_NEGATIVE};
use crate::effects::Axis;
use crate::error::Result;

/// Counts per turn; more than 2^32 is no encoder.
const TICKS: Limits = Limits::within(1.0, 4_294_967_296.0);
/// Counts that are the full voltage.
const FULL_SCALE: Limits = Limits::within(1.0, 4_294_967_296.0);
/// Counts of a linear encoder per metre; 10 to the 12th are counts of a picometre.
const TICKS_PER_M: Limits = Limits::within(1.0, 1e12);
/// Torque, or force, of a drive per ampere of its motor, gear included, N m/A or N/A.
const MOTOR_CONSTANT: Limits = Limits::within(1e-6, 1e4);

/// Columns whose samples may have been taken at another time than the row's.
const MOVABLE: [&str; 5] = ["position", "velocity", "gyro", "tachometer", "input"];
/// Further apart, two columns are no one row.
const SHIFT_S: Limits = Limits::within(-10.0, 10.0);

pub(super) fn read(
    root: &Table,
    links: &[Link],
    joints: &[Joint],
    robot: Option<&Robot>,
) -> Result<LogColumns> {
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
    let (at_m, on) = match (&payload, robot) {
        (None, _) => (0.0, None),
        (Some(table), None) if table.has("link") => {
            return Err(table.bad_key(
                "link",
                "a planar chain carries its payload on the last link",
                "remove it; `at_m` is the distance from the last joint",
            ));
        }
        (Some(table), None) => (table.required_number("at_m", EITHER_SIGN)?, None),
        (Some(table), Some(robot)) => (0.0, Some(place_on(table, robot)?)),
    };
    Ok(LogColumns {
        time: column(&log.required_table("time")?, "time", Dimension::Time)?,
        segment: name("segment")?,
        supply: optional(&log, "supply", Dimension::Voltage)?,
        torque_on: name("torque_on")?,
        payload_at_m: at_m,
        payload_on: on,
        payload: optional(&log, "payload", Dimension::Mass)?,
        turned: name("turned")?,
        joints: joint_columns(&log, joints)?,
        arm: match links {
            [link] if robot.is_none() => Some(ArmFigures {
                mass_kg: link.mass_kg,
                com_m: link.com_m,
            }),
            _ => None,
        },
        split_at_gap_s: log.number("split_at_gap_s", ABOVE_ZERO)?,
    })
}

/// Where a payload sits on a robot in space.
fn place_on(payload: &Table, robot: &Robot) -> Result<LinkPlace> {
    let name = payload.required_text("link")?;
    let link = robot.links.iter().position(|link| link == name);
    let link = link.ok_or_else(|| {
        payload.bad(
            "link",
            format!("the robot has no link `{name}`"),
            format!("name one of: {}", robot.links.join(", ")),
        )
    })?;
    let rows = payload.rows("at_m")?;
    let rows = payload.required("at_m", rows)?;
    let at_m = match rows.as_slice() {
        [row] => <[f64; 3]>::try_from(row.as_slice()).ok(),
        _ => None,
    };
    let at_m = at_m.filter(|at_m| at_m.iter().all(|m| EITHER_SIGN.allow(*m)));
    let at_m = at_m.ok_or_else(|| {
        payload.bad(
            "at_m",
            "no place in the link's frame",
            "write three distances, m: at_m = [0.0, 0.0, -0.08]",
        )
    })?;
    Ok(LinkPlace { link, at_m })
}

fn joint_columns(log: &Table, joints: &[Joint]) -> Result<Vec<JointColumns>> {
    let tables = log.tables("joint")?;
    let (named, known) = (tables.len(), joints.len());
    if let Some(extra) = tables.get(known) {
        return Err(extra.bad_table(
            format!(
                "[[log.joint]] {} is one too many for {known} joint(s)",
                known + 1
            ),
            "give one `[[log.joint]]` for each `[[joint]]`, in order",
        ));
    }
    if named < known {
        return Err(log.bad_table(
            format!("[log] names the columns of {named} joint(s) out of {known}"),
            "add one `[[log.joint]]` for each `[[joint]]`, in order",
        ));
    }
    let pairs = tables.iter().zip(joints);
    let columns = pairs.map(|(table, joint)| of_joint(table, joint));
    let columns: Vec<JointColumns> = columns.collect::<Result<_>>()?;
    if columns.iter().any(|joint| joint.measured().is_some()) {
        Ok(columns)
    } else {
        Err(log.bad_table(
            "[log] names neither a position nor a velocity of any joint",
            "name the column of an angle, or of a rate: `velocity`",
        ))
    }
}

fn of_joint(table: &Table, joint: &Joint) -> Result<JointColumns> {
    table.only(&["position", "velocity", "gyro", "tachometer", "input"])?;
    let axis = joint.axis();
    let position = mean(table, "position", Dimension::Angle.on(axis))?;
    let velocity = mean(table, "velocity", Dimension::Speed.on(axis))?;
    if axis == Axis::Slide && position.is_none() {
        return Err(table.bad_table(
            "[[log.joint]] of a joint that slides lacks `position`",
            "name the column of its displacement: a slide's speed alone will not do",
        ));
    }
    let (rate_sensor, rate) = rate(table, axis, position.is_some())?;
    let wanted = Dimension::of_input(joint.drive.name(), axis);
    let input = match (wanted, table.has("input")) {
        (None, false) => None,
        (Some(wanted), true) => mean(table, "input", wanted)?,
        (None, true) => {
            return Err(table.bad_key(
                "input",
                "a passive joint has no input",
                "remove `input`, or say what drives the joint",
            ));
        }
        (Some(wanted), false) => {
            let unit = wanted.unit_names().next().unwrap_or("1");
            return Err(table.bad_table(
                format!(
                    "{} lacks `input`, and its joint is driven by `{}`",
                    table.name,
                    joint.drive.name()
                ),
                format!("add `input = {{ column = \"...\", unit = \"{unit}\" }}`"),
            ));
        }
    };
    Ok(JointColumns {
        position,
        velocity,
        rate,
        rate_sensor,
        input,
    })
}

/// The rate sensor that a joint has beside the one of its angle, if it has one.
fn rate(table: &Table, axis: Axis, has_position: bool) -> Result<(RateSensor, Option<ColumnMean>)> {
    let mut found = (RateSensor::default(), None);
    for sensor in RateSensor::ALL {
        let key = sensor.key();
        let Some(rate) = mean(table, key, Dimension::Speed)? else {
            continue;
        };
        if axis == Axis::Slide {
            return Err(table.bad_key(
                key,
                format!("a joint that slides has no `{key}`"),
                "remove it; a slide's `velocity` helps to guess start states",
            ));
        }
        if !has_position {
            return Err(table.bad_key(
                key,
                format!(
                    "`{key}` is a rate sensor beside an angle, and this joint has no `position`"
                ),
                "call it `velocity`: the joint is then compared by its rate",
            ));
        }
        if found.1.is_some() {
            return Err(table.bad_key(
                key,
                "a joint has one rate sensor: `gyro` or `tachometer`",
                "keep the one that reads more finely",
            ));
        }
        found = (sensor, Some(rate));
    }
    Ok(found)
}

/// The columns under `key`, if there are any: a table, or a list of tables whose mean counts.
fn mean(table: &Table, key: &'static str, dimension: Dimension) -> Result<Option<ColumnMean>> {
    let tables = if table.is_list(key) {
        table.tables(key)?
    } else {
        table.table(key)?.into_iter().collect()
    };
    if table.has(key) && tables.is_empty() {
        return Err(table.bad(
            key,
            format!("`{key}` names no column"),
            "name one, such as { column = \"q_rad\", unit = \"rad\" }",
        ));
    }
    let columns = tables.iter().map(|found| column(found, key, dimension));
    Ok(ColumnMean::of(columns.collect::<Result<_>>()?))
}

/// The column under `key`, if there is one.
fn optional(table: &Table, key: &'static str, dimension: Dimension) -> Result<Option<Column>> {
    let found = table.table(key)?;
    found
        .map(|found| column(&found, key, dimension))
        .transpose()
}

fn column(table: &Table, quantity: &'static str, dimension: Dimension) -> Result<Column> {
    let offset = format!("offset{}", dimension.suffix());
    let resolution = format!("resolution{}", dimension.suffix());
    let mut known = vec!["column", "unit", offset.as_str(), resolution.as_str()];
    if dimension != Dimension::Time {
        known.push("reversed");
    }
    if MOVABLE.contains(&quantity) {
        known.push("shift_s");
    }
    let scale_key = |unit| Unit::scale_key(unit, dimension);
    known.extend(table.text("unit")?.and_then(scale_key));
    if quantity == "payload" {
        known.extend(["at_m", "link"]);
    }
    table.only(&known)?;
    let unit = unit(table, quantity, dimension)?;
    let one_tick = (unit.name == "ticks").then_some(unit.si);
    let offset = table.number(&offset, Limits::within(-1e9, 1e9))?;
    let shift_s = table.number("shift_s", SHIFT_S)?;
    Ok(Column {
        name: table.required_text("column")?.to_string(),
        unit,
        offset: offset.unwrap_or(0.0),
        reversed: table.flag("reversed")?,
        resolution: table.number(&resolution, NOT_NEGATIVE)?.or(one_tick),
        shift_s: shift_s.unwrap_or(0.0),
    })
}

fn unit(table: &Table, quantity: &'static str, wanted: Dimension) -> Result<Unit> {
    let name = table.required_text("unit")?;
    let scale = match Unit::scale_key(name, wanted) {
        Some(key @ "ticks_per_turn") => table.number(key, TICKS)?,
        Some(key @ "full_scale") => table.number(key, FULL_SCALE)?,
        Some(key @ "ticks_per_m") => table.number(key, TICKS_PER_M)?,
        Some(key) => table.number(key, MOTOR_CONSTANT)?,
        None => None,
    };
    let unit = Unit::of(name, wanted, scale).or_else(|| Unit::named(name, scale));
    let wrong = |what: String| {
        let units: Vec<&str> = wanted.unit_names().collect();
        table.bad("unit", what, format!("write one of: {}", units.join(", ")))
    };
    let Some(unit) = unit else {
        return Err(wrong(format!("unknown unit `{name}`")));
    };
    if unit.dimension != wanted {
        return Err(wrong(format!(
            "unit `{}` measures {}, and `{quantity}` is {wanted}",
            unit.name, unit.dimension
        )));
    }
    match Unit::scale_key(name, wanted).filter(|_| unit.si.is_nan()) {
        Some(key) => Err(table.lacks(key)),
        None => Ok(unit),
    }
}
