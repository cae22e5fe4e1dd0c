//! The changes of model and motions by which logs are spoiled.

use handstand::Model;
use handstand::model::{Drive, Motor, Unit};
use handstand::motion::Motion;
use std::f64::consts::PI;

/// Time for which a joint stands still, s.
const STILL_S: f64 = 25.0;

/// Torques are written in mN m, goals in degrees, shares in percent.
pub(super) fn input_factor(model: &Model, joint: usize) -> f64 {
    match model.joints[joint].drive {
        Drive::Torque | Drive::Passive => 1e3,
        Drive::Duty(_) => 100.0,
        Drive::Position { .. } | Drive::Speed { .. } => 180.0 / PI,
    }
}

pub(super) fn declare(model: &mut Model, joint: usize, unit: &str, ticks: Option<f64>) {
    let position = model.log.joints[joint].position.as_mut();
    if let (Some(position), Some(unit)) = (position, Unit::named(unit, ticks)) {
        position.columns_mut()[0].unit = unit;
    }
}

/// Gives the columns of joints names that say no unit.
pub(super) fn anonymise(model: &mut Model) {
    for (joint, columns) in model.log.joints.iter_mut().enumerate() {
        let named = [
            (&mut columns.position, "place"),
            (&mut columns.velocity, "quickness"),
            (&mut columns.rate, "turning"),
            (&mut columns.input, "asked"),
        ];
        for (mean, name) in named {
            for (servo, column) in mean
                .iter_mut()
                .flat_map(|mean| mean.columns_mut())
                .enumerate()
            {
                column.name = format!("{name} {joint} {servo}");
            }
        }
    }
}

/// Rounds the angles to whole numbers as they are written, as encoders count.
pub(super) fn count_whole(model: &Model, motions: &mut [Motion], joint: usize) {
    let position = model.log.joints[joint].position.as_ref();
    let Some(column) = position.and_then(|mean| mean.columns().first()) else {
        return;
    };
    let (unit, zero) = (column.unit.si, column.offset);
    for motion in motions {
        let whole = |q: &mut f64| *q = zero + ((*q - zero) / unit).round() * unit;
        motion.position_rad[joint].iter_mut().for_each(whole);
    }
}

pub(super) fn scale_position(motions: &mut [Motion], joint: usize, factor: f64) {
    for motion in motions {
        motion.position_rad[joint]
            .iter_mut()
            .for_each(|q| *q *= factor);
        let speeds = motion.velocity_rad_s[joint].iter_mut().flatten();
        speeds.for_each(|v| *v *= factor);
    }
}

pub(super) fn scale_input(motions: &mut [Motion], joint: usize, factor: f64) {
    let inputs = motions
        .iter_mut()
        .filter_map(|motion| motion.input[joint].as_mut());
    inputs.flatten().for_each(|u| *u *= factor);
}

/// The last sample of the motion again and again, while time and inputs go on.
pub(super) fn stall(motion: &mut Motion) {
    let count = motion.len();
    let period_s = motion.duration_s() / (count - 1).max(1) as f64;
    let more = (STILL_S / period_s).ceil() as usize;
    let last_s = motion.time_s[count - 1];
    let again = |values: &mut Vec<f64>| {
        let cycle = values.clone();
        values.extend((0..more).map(|k| cycle[k % count]));
    };
    motion
        .time_s
        .extend((1..=more).map(|k| last_s + k as f64 * period_s));
    // Half way up or down its travel: no joint rests there by itself.
    let stopped = count / 2;
    for angle in &mut motion.position_rad {
        let still = angle[stopped];
        angle[stopped..].fill(still);
        angle.extend(std::iter::repeat_n(still, more));
    }
    for speed in motion.velocity_rad_s.iter_mut().flatten() {
        speed[stopped..].fill(0.0);
        speed.extend(std::iter::repeat_n(0.0, more));
    }
    motion.input.iter_mut().flatten().for_each(again);
    motion.supply_v.iter_mut().for_each(again);
    if let Some(on) = &mut motion.torque_on {
        let cycle = on.clone();
        on.extend((0..more).map(|k| cycle[k % count]));
    }
}

pub(super) fn clip(motions: &mut [Motion], joint: usize) {
    let inputs = || {
        motions
            .iter()
            .filter_map(|motion| motion.input[joint].as_ref())
    };
    let most = inputs()
        .flatten()
        .fold(0.0_f64, |most, u| most.max(u.abs()));
    let limit = 0.5 * most;
    let inputs = motions
        .iter_mut()
        .filter_map(|motion| motion.input[joint].as_mut());
    inputs.flatten().for_each(|u| *u = u.clamp(-limit, limit));
}

/// The model with another drive at the joint, and the column as declared in that drive's unit.
pub(super) fn another_drive(model: &mut Model, motions: &mut [Motion], joint: usize, name: &str) {
    let motor = model.joints[joint].drive.motor().cloned().unwrap_or(Motor {
        stall_torque_nm: 5.0,
        no_load_speed_rad_s: f64::INFINITY,
        nominal_supply_v: None,
    });
    let (drive, unit) = match name {
        "torque" => (Drive::Torque, "N m"),
        "duty" => (Drive::Duty(motor), "1"),
        "position" => (
            Drive::Position {
                gain_per_rad: 10.0,
                motor,
            },
            "rad",
        ),
        _ => (
            Drive::Speed {
                gain_s_per_rad: 1.0,
                motor,
            },
            "rad/s",
        ),
    };
    model.joints[joint].drive = drive;
    // A file of this drive has no values of another.
    let free = std::mem::take(&mut model.free);
    model.free = free
        .into_iter()
        .filter(|path| path.get(model).is_some())
        .collect();
    if let (Some(column), Some(unit)) =
        (&mut model.log.joints[joint].input, Unit::named(unit, None))
    {
        let column = &mut column.columns_mut()[0];
        // The written numbers stay what they are.
        let written = 1.0 / column.unit.si;
        column.unit = unit;
        scale_input(motions, joint, written * unit.si);
    }
}
