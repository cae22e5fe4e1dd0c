//! The curve an effect leaves, computed from its own law: what a student should look for in a plot.

mod bodies;
mod remembered;
#[cfg(test)]
mod tests;

use super::{
    DriveState, Effect, Encoded, FrictionState, JointState, MemoryCell, Needs, Parameter, Signals,
    Site,
};
use bodies::{arm, gives_way_m, gravity_nm, inertia_nm, wound_nm};
use std::ops::Range;

/// Points of a curve: x and y in the units of the labels.
type Points = Vec<(f64, f64)>;

/// One curve with the effect and one without it.
#[derive(Debug, Clone, PartialEq)]
pub struct Signature {
    /// What runs to the right, with its unit.
    pub x_label: &'static str,
    /// What runs upward, with its unit.
    pub y_label: &'static str,
    /// The curve without the effect.
    pub without: Points,
    /// The curve with it.
    pub with: Points,
    /// Values it is drawn for, in the order of the effect's parameters.
    pub values: Vec<f64>,
}

/// Torque of the drawn motor at full duty and standstill, N m: an AX-12's.
const FULL_TORQUE_NM: f64 = 1.5;
/// Points of a curve.
const POINTS: usize = 241;
/// Share of the picture's height by which the curves must part to be seen.
const VISIBLE_SHARE: f64 = 0.065;

/// The signature of an effect at the far end of its typical range; where that is too small to be
/// seen, at up to nine times as much.
pub fn signature(effect: Effect) -> Signature {
    let drawn = |stretch| drawn_for(effect, shown_values(effect, stretch));
    let mut seen = drawn(1.0);
    for stretch in [3.0, 9.0] {
        if parted(&seen) < VISIBLE_SHARE {
            seen = drawn(stretch);
        }
    }
    seen
}

/// Values at which the effect vanishes; the default for a shape parameter.
pub fn off_values(effect: Effect) -> Vec<f64> {
    let off = |parameter: &Parameter| parameter.off.unwrap_or(parameter.starts[0]);
    effect.info().parameters.iter().map(off).collect()
}

/// For each parameter the end of its typical range farther from off, `stretch` times as far.
fn shown_values(effect: Effect, stretch: f64) -> Vec<f64> {
    let shown = |parameter: &Parameter| {
        let (low, high) = parameter.typical;
        match parameter.off {
            None => parameter.starts[0],
            Some(off) if off.is_infinite() => low,
            Some(off) => {
                let low_is_far = (low - off).abs() > (high - off).abs();
                let far = if low_is_far { low } else { high };
                (off + stretch * (far - off)).clamp(parameter.bounds.0, parameter.bounds.1)
            }
        }
    };
    effect.info().parameters.iter().map(shown).collect()
}

/// Largest distance of the two curves over the height of the picture.
fn parted(signature: &Signature) -> f64 {
    let points = || signature.without.iter().chain(&signature.with);
    let highest = points().map(|point| point.1).fold(f64::MIN, f64::max);
    let height = highest - points().map(|point| point.1).fold(f64::MAX, f64::min);
    let pairs = signature.without.iter().zip(&signature.with);
    let distance = pairs.map(|(a, b)| (a.1 - b.1).abs()).fold(0.0, f64::max);
    if height > 0.0 { distance / height } else { 0.0 }
}

fn drawn_for(effect: Effect, values: Vec<f64>) -> Signature {
    let off = off_values(effect);
    if effect.remembers() {
        let (x_label, y_label) = remembered::labels(effect.info().site);
        let span_s = remembered::span_s(effect, &values);
        return Signature {
            x_label,
            y_label,
            without: remembered::curve(effect, &off, span_s),
            with: remembered::curve(effect, &values, span_s),
            values,
        };
    }
    let (x_label, y_label, range, y) = law(effect, &values, &off);
    let points = |values: &[f64]| match effect.info().site {
        Site::Encoder | Site::Sensor => reading(effect, values),
        Site::Rate if effect.trail_rad(values, 1.0).is_some() => reading(effect, values),
        _ => over(&range, |x| y(effect, values, x)),
    };
    Signature {
        x_label,
        y_label,
        without: points(&off),
        with: points(&values),
        values,
    }
}

/// `y` at evenly spaced places.
fn over(range: &Range<f64>, y: impl Fn(f64) -> f64) -> Points {
    let (wide, last) = (range.end - range.start, (POINTS - 1) as f64);
    let places = (0..POINTS).map(|index| range.start + wide * index as f64 / last);
    places.map(|x| (x, y(x))).collect()
}

/// What to plot over what: labels of x and y, range of x, and y of the effect with its values at
/// an x.
type PlotLaw = (&'static str, &'static str, Range<f64>, Height);
type Height = fn(Effect, &[f64], f64) -> f64;

/// Each site has its plot; where a law may depend on more than one quantity, the law itself is
/// asked.
fn law(effect: Effect, values: &[f64], off: &[f64]) -> PlotLaw {
    let over_delay: Height = |e, v, time_s| f64::from(time_s >= e.delay_s(v));
    let over_supply: Height = |e, v, supply| drive(e, v, 1.0, 0.0, supply);
    let over_speed: Height = |e, v, speed| drive(e, v, 1.0, speed, 1.0);
    let over_duty: Height = |e, v, duty| drive(e, v, duty, 0.0, 1.0);
    let at_angle: Height = |e, v, x| e.torque(v, &JointState::undriven(x, 0.0));
    let at_speed: Height = |e, v, x| e.torque(v, &JointState::undriven(0.0, x));
    let wound: Height = wound_nm;
    let command: Height = |e, v, duty| e.command(v, duty);
    let encode: Height = |e, v, angle_rad| e.encode(v, angle_rad);
    let varies = |y: Height, a: f64, b: f64| y(effect, values, a) != y(effect, values, b);
    let weightless = gravity_nm(effect, values, 1.0) == gravity_nm(effect, off, 1.0);
    let (at_full, joint) = ("torque at full duty, N m", "torque on the joint, N m");
    match (effect.info().site, effect.info().needs) {
        (Site::Timing, _) => ("time, s", "input that acts, 1", -0.1..0.3, over_delay),
        (Site::Command, _) => ("commanded duty, 1", "applied duty, 1", -0.5..0.5, command),
        (Site::Drive, Needs::Supply) => ("supply over nominal, 1", at_full, 0.7..1.3, over_supply),
        (Site::Drive, _) if varies(over_speed, 0.0, 1.0) => {
            ("speed, rad/s", at_full, 0.0..4.0, over_speed)
        }
        (Site::Drive, _) => ("duty, 1", "torque at rest, N m", -1.0..1.0, over_duty),
        (Site::Gear, _) => ("motor ahead of the joint, rad", joint, -0.15..0.15, wound),
        (Site::Friction, _) => friction_law(effect, values),
        (Site::Joint, _) if varies(at_angle, 0.1, 0.2) => {
            ("angle, rad", joint, -1.6..1.6, at_angle)
        }
        (Site::Joint, _) => ("speed, rad/s", joint, -6.0..6.0, at_speed),
        (Site::Body, _) if arm(effect, values).base_spring.is_some() => (
            "force on the base, N",
            "its displacement, m",
            -20.0..20.0,
            gives_way_m,
        ),
        (Site::Body, _) if weightless => (
            "acceleration, rad/s^2",
            "torque it takes, N m",
            -50.0..50.0,
            inertia_nm,
        ),
        (Site::Body, _) => (
            "angle from hanging, rad",
            "torque of gravity, N m",
            -1.6..1.6,
            gravity_nm,
        ),
        (Site::Rate, _) if effect.trail_rad(values, 1.0).is_some() => (
            "rate, to and fro, rad/s",
            "rate that is read, rad/s",
            -0.2..0.2,
            encode,
        ),
        (Site::Rate, _) => (
            "rate, rad/s",
            "rate that is read, rad/s",
            -0.2..0.2,
            |e, v, rate| e.rate_scale(v) * rate + e.rate_bias_rad_s(v),
        ),
        (Site::Encoder | Site::Sensor, _) => {
            ("angle, to and fro, rad", "reading, rad", -0.2..0.2, encode)
        }
    }
}

fn friction_law(effect: Effect, values: &[f64]) -> PlotLaw {
    let by_gear: Height = |e, v, load_nm| friction(e, v, [0.0, 1.0], [load_nm, 0.0]);
    let by_bearing: Height = |e, v, load_n| friction(e, v, [0.0, 1.0], [0.0, load_n]);
    let by_speed: Height = |e, v, speed| friction(e, v, [0.0, speed], [0.0, 0.0]);
    let by_angle: Height = |e, v, angle| friction(e, v, [angle, 1.0], [0.0, 0.0]);
    let full = 0.0..FULL_TORQUE_NM;
    match effect.info().needs {
        Needs::GearLoad => (
            "torque through the gear, N m",
            "friction, N m",
            full,
            by_gear,
        ),
        Needs::BearingLoad => (
            "force in the bearing, N",
            "friction, N m",
            0.0..30.0,
            by_bearing,
        ),
        _ if by_angle(effect, values, 0.1) != by_angle(effect, values, 0.2) => {
            ("angle, rad", "friction, N m", -1.6..1.6, by_angle)
        }
        _ => ("speed, rad/s", "resisting torque, N m", -2.0..2.0, by_speed),
    }
}

fn drive(effect: Effect, values: &[f64], duty: f64, speed: f64, supply: f64) -> f64 {
    let at = DriveState {
        speed_rad_s: speed,
        duty,
        full_torque_nm: FULL_TORQUE_NM,
        supply_ratio: supply,
        memory: MemoryCell::EMPTY,
    };
    effect.drive(values, FULL_TORQUE_NM * duty, &at)
}

/// The hook's answer with the sign of the speed, so that what resists forwards is drawn upward.
fn friction(
    effect: Effect,
    values: &[f64],
    [angle_rad, speed]: [f64; 2],
    [gear_nm, bearing_n]: [f64; 2],
) -> f64 {
    let direction = if speed < 0.0 { -1.0 } else { 1.0 };
    let slide = FrictionState {
        angle_rad,
        speed_rad_s: speed.abs(),
        direction,
        gear_load_nm: gear_nm,
        motor_nm: gear_nm,
        outside_nm: 0.0,
        bearing_load_n: bearing_n,
        signals: Signals::NONE,
    };
    direction * effect.friction(values, &slide)
}

/// Angle of a triangle of 0.2 rad at a point of a curve, or between two; a period is a curve.
fn triangle(point: f64) -> f64 {
    let phase = (point / (POINTS - 1) as f64).rem_euclid(1.0);
    0.2 * (1.0 - 4.0 * (phase - 0.5).abs())
}

/// Two periods of the triangle, 2 s each, of which the second is drawn.
fn reading(effect: Effect, values: &[f64]) -> Points {
    let step_s = 2.0 / (POINTS - 1) as f64;
    let ago = effect.reading_offset_s(values).unwrap_or(0.0) / step_s;
    let mut memory = None;
    let read = (0..2 * POINTS - 1).map(|index| {
        let taken = index as f64 - ago;
        let (angle_rad, before_rad) = (triangle(taken), triangle(taken - 1.0));
        let encoded = Encoded {
            angle_rad: effect.encode(values, angle_rad),
            speed_rad_s: (angle_rad - before_rad) / step_s,
            mean: None,
        };
        let reading_rad = effect.sense(values, &mut memory, encoded, step_s);
        (triangle(index as f64), reading_rad)
    });
    read.skip(POINTS - 1).collect()
}
