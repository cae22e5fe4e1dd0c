//! What may be wrong with how a model reads the motion of one joint.

use super::correction::{Correction, LogColumn, is_regulated, other_units};
use super::travel::travel_rad;
use crate::model::{Model, Unit};
use crate::motion::Motion;
use std::f64::consts::PI;

/// Travel of a joint that a unit may make plausible, rad or m.
const PLAUSIBLE_RAD: std::ops::Range<f64> = 0.01..60.0;

/// Other signs, units and half turns of what is measured of a joint: its angle, or its rate where
/// that alone is.
pub(super) fn of_motion(model: &Model, motions: &[Motion], joint: usize) -> Vec<Correction> {
    let (position, velocity) = (LogColumn::Position(joint), LogColumn::Velocity(joint));
    let Some(column) = position.column(model) else {
        return of_speed(model, motions, velocity);
    };
    let slope = speed_slope(motions, joint, |motion| {
        motion.velocity_rad_s[joint].as_deref()
    });
    let rate_slope = speed_slope(motions, joint, |motion| motion.rate(joint));
    let agree = [(velocity, slope), (LogColumn::Rate(joint), rate_slope)].into_iter();
    let along = agree.filter_map(|(speed, slope)| slope.filter(|s| *s > 0.0).map(|_| speed));
    let reversed: Vec<LogColumn> = [position].into_iter().chain(along).collect();
    let goal = is_regulated(model, joint).then_some(LogColumn::Input(joint));
    let with_goal = |columns: &[LogColumn]| goal.map(|goal| [columns, &[goal]].concat());
    let mut all: Vec<Correction> = with_goal(&reversed)
        .into_iter()
        .map(Correction::Reverse)
        .collect();
    all.push(Correction::Reverse(reversed));
    let travel_rad = travel_rad(motions, joint);
    let plausible = |unit: &Unit| PLAUSIBLE_RAD.contains(&(travel_rad * unit.si / column.unit.si));
    let units = other_units(model, motions, position)
        .into_iter()
        .filter(plausible);
    let goals_unit = goal
        .and_then(|goal| goal.column(model))
        .map(|goal| goal.unit);
    for unit in units {
        let columns = position_unit(model, joint, unit, slope);
        if let Some(goal) = goal.filter(|_| goals_unit == Some(column.unit)) {
            let with_goal = columns.iter().copied().chain([(goal, unit)]);
            all.push(Correction::Unit(with_goal.collect()));
        }
        all.push(Correction::Unit(columns));
    }
    if joint > 0 && model.joints[joint].slide.is_none() {
        let turned = with_goal(&[position]).into_iter().chain([vec![position]]);
        all.extend(turned.map(|columns| Correction::Offset(columns, PI)));
    }
    all
}

/// Other signs and units of a speed, if the logs have it.
pub(super) fn of_speed(model: &Model, motions: &[Motion], speed: LogColumn) -> Vec<Correction> {
    if speed.column(model).is_none() {
        return Vec::new();
    }
    let units = other_units(model, motions, speed).into_iter();
    let units = units.map(|unit| Correction::Unit(vec![(speed, unit)]));
    units.chain([Correction::Reverse(vec![speed])]).collect()
}

/// The position in another unit; a speed that agreed with it goes along.
fn position_unit(
    model: &Model,
    joint: usize,
    unit: Unit,
    slope: Option<f64>,
) -> Vec<(LogColumn, Unit)> {
    let mut columns = vec![(LogColumn::Position(joint), unit)];
    let velocity = LogColumn::Velocity(joint);
    let agreed = slope.is_some_and(|slope| (0.8..1.25).contains(&slope));
    let name = match unit.name {
        "deg" => Some("deg/s"),
        "rad" => Some("rad/s"),
        "m" => Some("m/s"),
        "cm" => Some("cm/s"),
        "mm" => Some("mm/s"),
        _ => None,
    };
    let other = name.and_then(|name| Unit::named(name, None));
    if let (true, Some(unit), Some(column)) = (agreed, other, velocity.column(model))
        && column.unit.name != unit.name
    {
        columns.push((velocity, unit));
    }
    columns
}

/// A logged speed per speed of the angle, by least squares; none where no speed is logged.
fn speed_slope<'a>(
    motions: &'a [Motion],
    joint: usize,
    logged: impl Fn(&'a Motion) -> Option<&'a [f64]>,
) -> Option<f64> {
    let (mut product, mut square) = (0.0, 0.0);
    for motion in motions {
        let logged = logged(motion)?;
        let angle = &motion.position_rad[joint];
        let (time_s, last) = (&motion.time_s, motion.len().saturating_sub(1));
        for k in 3..last.saturating_sub(3) {
            let speed = (angle[k + 3] - angle[k - 3]) / (time_s[k + 3] - time_s[k - 3]);
            if speed.is_finite() && logged[k].is_finite() {
                product += speed * logged[k];
                square += speed * speed;
            }
        }
    }
    (square > 0.0).then(|| product / square)
}
