//! The table `[conditions]` of a study: sensors, drives and clock that are not ideal.

use super::{NOT_NEGATIVE, POSITIVE, set};
use crate::case::Case;
use crate::conditions::CONDITIONS;
use crate::error::Result;
use crate::model::Limits;
use crate::model::reader::Table;
use crate::quantity::Uncertain;
use crate::sim::closed_loop::{Drives, Gyro, Sensor, Velocity};

/// Sets the conditions; what they draw for every robot comes back. The design counts on them, but
/// for their delay, which it counts on only where they are those of a named set.
pub(super) fn conditions(table: &Table<'_>, case: &mut Case) -> Result<Vec<Uncertain>> {
    table.only(&[
        "base",
        "position_resolution_rad",
        "position_noise_rad",
        "velocity",
        "gyro_resolution_rad_s",
        "gyro_noise_rad_s",
        "saturation_nm",
        "torque_resolution",
        "dead_zone",
        "supply",
        "delay_periods",
        "jitter",
        "loss",
    ])?;
    let designed_periods = case.control.drives.delay_periods;
    let mut drawn = Vec::new();
    let mut bases = vec![("measured", None)];
    bases.extend(
        CONDITIONS
            .iter()
            .map(|condition| (condition.id, Some(condition))),
    );
    match table.choice("base", &bases)? {
        Some(Some(condition)) => drawn = condition.apply(case),
        Some(None) => (case.sensor, case.drives) = (Sensor::PAPER, Drives::PAPER),
        None => {}
    }
    sensors(table, &mut case.sensor)?;
    drives(table, &mut case.drives)?;
    let clock = &mut case.clock;
    set(
        table,
        "jitter",
        Limits::within(0.0, 0.45),
        &mut clock.jitter,
    )?;
    set(table, "loss", Limits::within(0.0, 1.0), &mut clock.loss)?;
    let known_periods = if designed_periods > 0.0 {
        designed_periods
    } else {
        case.control.drives.delay_periods
    };
    case.control.sensor = case.sensor;
    case.control.drives = Drives {
        delay_periods: known_periods,
        ..case.drives
    };
    Ok(drawn)
}

fn sensors(table: &Table<'_>, sensor: &mut Sensor) -> Result<()> {
    let resolution = &mut sensor.position_resolution_rad;
    set(table, "position_resolution_rad", NOT_NEGATIVE, resolution)?;
    let noise = &mut sensor.position_noise_rad;
    set(table, "position_noise_rad", NOT_NEGATIVE, noise)?;
    let kinds = [
        ("direct", Velocity::Direct),
        ("difference", Velocity::Difference),
    ];
    if let Some(velocity) = table.choice("velocity", &kinds)? {
        sensor.velocity = velocity;
    }
    if table.has("gyro_resolution_rad_s") || table.has("gyro_noise_rad_s") {
        let mut gyro = sensor.gyro.unwrap_or(Gyro {
            resolution_rad_s: 0.0,
            noise_rad_s: 0.0,
        });
        let resolution = &mut gyro.resolution_rad_s;
        set(table, "gyro_resolution_rad_s", NOT_NEGATIVE, resolution)?;
        let noise = &mut gyro.noise_rad_s;
        set(table, "gyro_noise_rad_s", NOT_NEGATIVE, noise)?;
        sensor.gyro = Some(gyro);
    }
    Ok(())
}

fn drives(table: &Table<'_>, drives: &mut Drives) -> Result<()> {
    if let Some(limit) = table.number("saturation_nm", POSITIVE)? {
        drives.full_torque_nm = limit;
        drives.saturates = true;
    }
    let share = Limits::within(0.0, 0.99);
    set(table, "torque_resolution", share, &mut drives.resolution)?;
    set(table, "dead_zone", share, &mut drives.dead_zone)?;
    let supply = Limits::above(0.0, 100.0);
    set(table, "supply", supply, &mut drives.supply)?;
    let delay = &mut drives.delay_periods;
    set(table, "delay_periods", Limits::within(0.0, 100.0), delay)
}
