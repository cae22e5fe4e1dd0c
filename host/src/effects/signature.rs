//! The curve an effect leaves, computed from its own law: what a student should look for in a plot.

use super::{DriveState, Effect, JointState, Needs, Parameter, Rig, Site, Slide};
use crate::dynamics::{Chain, ChainLink};

/// One curve with the effect and one without it.
#[derive(Debug, Clone, PartialEq)]
pub struct Signature {
    /// What runs to the right, with its unit.
    pub x_label: &'static str,
    /// What runs upward, with its unit.
    pub y_label: &'static str,
    /// The curve without the effect.
    pub without: Vec<(f64, f64)>,
    /// The curve with it.
    pub with: Vec<(f64, f64)>,
    /// Values it is drawn for, in the order of the info's parameters.
    pub values: Vec<f64>,
}

/// Torque of the drawn motor at full duty and standstill, N m: an AX-12's.
const FULL_TORQUE_NM: f64 = 1.5;
/// Points of a curve.
const POINTS: usize = 241;
/// Share of the picture's height by which the curves must part to be seen.
const VISIBLE_SHARE: f64 = 0.065;

/// The signature of an effect at the far end of its typical range; where that is too small to be seen, at up
/// to nine times as much.
pub fn signature(effect: &dyn Effect) -> Signature {
    [1.0, 3.0, 9.0]
        .into_iter()
        .map(|stretch| drawn_for(effect, shown_values(effect, stretch)))
        .reduce(|seen, next| {
            if parted(&seen) < VISIBLE_SHARE {
                next
            } else {
                seen
            }
        })
        .expect("there are three of them")
}

/// Values at which the effect vanishes; the default for a shape parameter.
pub fn off_values(effect: &dyn Effect) -> Vec<f64> {
    let off = |parameter: &Parameter| parameter.off.unwrap_or(parameter.starts[0]);
    effect.info().parameters.iter().map(off).collect()
}

fn shown_values(effect: &dyn Effect, stretch: f64) -> Vec<f64> {
    effect
        .info()
        .parameters
        .iter()
        .map(|parameter| shown(parameter, stretch))
        .collect()
}

/// The end of the typical range farther from off, `stretch` times as far.
fn shown(parameter: &Parameter, stretch: f64) -> f64 {
    let (low, high) = parameter.typical;
    match parameter.off {
        None => parameter.starts[0],
        Some(off) if off.is_infinite() => low,
        Some(off) => {
            let far = if (low - off).abs() > (high - off).abs() {
                low
            } else {
                high
            };
            (off + stretch * (far - off)).clamp(parameter.bounds.0, parameter.bounds.1)
        }
    }
}

/// Largest distance of the two curves over the height of the picture.
fn parted(signature: &Signature) -> f64 {
    let heights = || {
        signature
            .without
            .iter()
            .chain(&signature.with)
            .map(|point| point.1)
    };
    let height = heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min);
    let pairs = signature.without.iter().zip(&signature.with);
    let distance = pairs.map(|(a, b)| (a.1 - b.1).abs()).fold(0.0, f64::max);
    if height > 0.0 { distance / height } else { 0.0 }
}

fn drawn_for(effect: &dyn Effect, values: Vec<f64>) -> Signature {
    let off = off_values(effect);
    let axes = axes(effect, &values, &off);
    Signature {
        x_label: axes.x_label,
        y_label: axes.y_label,
        without: (axes.curve)(effect, &off),
        with: (axes.curve)(effect, &values),
        values,
    }
}

/// Points of an effect with these values.
type Curve = fn(&dyn Effect, &[f64]) -> Vec<(f64, f64)>;

/// What to plot over what.
struct Axes {
    x_label: &'static str,
    y_label: &'static str,
    curve: Curve,
}

impl Axes {
    fn new(x_label: &'static str, y_label: &'static str, curve: Curve) -> Self {
        Self {
            x_label,
            y_label,
            curve,
        }
    }
}

/// Each site has its plot; where a law may depend on more than one quantity, the law itself is asked.
fn axes(effect: &dyn Effect, values: &[f64], off: &[f64]) -> Axes {
    let info = effect.info();
    match (info.site, info.needs) {
        (Site::Timing, _) => Axes::new("time, s", "input that acts, 1", step),
        (Site::Command, _) => Axes::new("commanded duty, 1", "applied duty, 1", command),
        (Site::Drive, Needs::Supply) => Axes::new(
            "supply over nominal, 1",
            "torque at full duty, N m",
            torque_over_supply,
        ),
        (Site::Drive, _) if depends_on_speed(effect, values) => Axes::new(
            "speed, rad/s",
            "torque at full duty, N m",
            torque_over_speed,
        ),
        (Site::Drive, _) => Axes::new("duty, 1", "torque at rest, N m", torque_over_duty),
        (Site::Friction, Needs::GearLoad) => Axes::new(
            "torque through the gear, N m",
            "friction, N m",
            friction_over_gear_load,
        ),
        (Site::Friction, Needs::BearingLoad) => Axes::new(
            "force in the bearing, N",
            "friction, N m",
            friction_over_bearing_load,
        ),
        (Site::Friction, _) => {
            Axes::new("speed, rad/s", "resisting torque, N m", friction_over_speed)
        }
        (Site::Joint, _) if depends_on_angle(effect, values) => {
            Axes::new("angle, rad", "torque on the joint, N m", joint_over_angle)
        }
        (Site::Joint, _) => Axes::new("speed, rad/s", "torque on the joint, N m", joint_over_speed),
        (Site::Body, _) if gravity(effect, values) == gravity(effect, off) => {
            Axes::new("acceleration, rad/s^2", "torque it takes, N m", inertia)
        }
        (Site::Body, _) => Axes::new("angle from hanging, rad", "torque of gravity, N m", gravity),
        (Site::Encoder | Site::Sensor, _) => {
            Axes::new("angle, to and fro, rad", "reading, rad", reading)
        }
    }
}

fn depends_on_speed(effect: &dyn Effect, values: &[f64]) -> bool {
    drive(effect, values, 1.0, 0.0, 1.0) != drive(effect, values, 1.0, 1.0, 1.0)
}

fn depends_on_angle(effect: &dyn Effect, values: &[f64]) -> bool {
    let at = |angle_rad| effect.torque(values, &JointState::undriven(angle_rad, 0.0));
    at(0.1) != at(0.2)
}

/// `y` at evenly spaced places.
fn over(low: f64, high: f64, y: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let last = (POINTS - 1) as f64;
    let place = |index| low + (high - low) * index as f64 / last;
    (0..POINTS).map(place).map(|x| (x, y(x))).collect()
}

fn step(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    let delay_s = effect.delay_s(values);
    over(-0.1, 0.3, |time_s| f64::from(time_s >= delay_s))
}

fn command(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    over(-0.5, 0.5, |duty| effect.command(values, duty))
}

fn drive(effect: &dyn Effect, values: &[f64], duty: f64, speed: f64, supply: f64) -> f64 {
    let at = DriveState {
        speed_rad_s: speed,
        duty,
        full_torque_nm: FULL_TORQUE_NM,
        supply_ratio: supply,
    };
    effect.drive(values, FULL_TORQUE_NM * duty, &at)
}

fn torque_over_duty(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    over(-1.0, 1.0, |duty| drive(effect, values, duty, 0.0, 1.0))
}

fn torque_over_speed(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    over(0.0, 4.0, |speed| drive(effect, values, 1.0, speed, 1.0))
}

fn torque_over_supply(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    over(0.7, 1.3, |supply| drive(effect, values, 1.0, 0.0, supply))
}

/// The hook's answer with the sign of the speed, so that what resists forwards is drawn upward.
fn friction_over_speed(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    over(-2.0, 2.0, |speed| {
        let direction = if speed < 0.0 { -1.0 } else { 1.0 };
        let slide = Slide {
            speed_rad_s: speed.abs(),
            direction,
            gear_load_nm: 0.0,
            bearing_load_n: 0.0,
        };
        direction * effect.friction(values, &slide)
    })
}

fn friction_over_gear_load(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    over(0.0, FULL_TORQUE_NM, |gear_load_nm| {
        let slide = Slide {
            speed_rad_s: 1.0,
            direction: 1.0,
            gear_load_nm,
            bearing_load_n: 0.0,
        };
        effect.friction(values, &slide)
    })
}

fn friction_over_bearing_load(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    over(0.0, 30.0, |bearing_load_n| {
        let slide = Slide {
            speed_rad_s: 1.0,
            direction: 1.0,
            gear_load_nm: 0.0,
            bearing_load_n,
        };
        effect.friction(values, &slide)
    })
}

fn joint_over_angle(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    over(-1.6, 1.6, |angle_rad| {
        effect.torque(values, &JointState::undriven(angle_rad, 0.0))
    })
}

fn joint_over_speed(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    over(-6.0, 6.0, |speed_rad_s| {
        effect.torque(values, &JointState::undriven(0.0, speed_rad_s))
    })
}

/// A bench arm, 0.3 kg at 0.12 m, as the effect changes it.
fn arm(effect: &dyn Effect, values: &[f64]) -> Rig {
    let link = ChainLink {
        length_m: 0.15,
        com_m: 0.12,
        com_angle_rad: 0.0,
        mass_kg: 0.3,
        inertia_kg_m2: 8e-4,
        armature_kg_m2: 2e-3,
    };
    let chain = Chain {
        links: vec![link],
        gravity_m_s2: 9.81,
    };
    let mut rig = Rig {
        chain,
        gravity_turn_rad: 0.0,
        turned: false,
    };
    effect.body(values, 0, &mut rig);
    rig
}

fn gravity(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    let rig = arm(effect, values);
    let link = &rig.chain.links[0];
    let peak_nm = link.mass_kg * rig.chain.gravity_m_s2 * link.com_m;
    let turn_rad = link.com_angle_rad - rig.gravity_turn_rad;
    over(-1.6, 1.6, |angle_rad| {
        -peak_nm * (angle_rad + turn_rad).sin()
    })
}

fn inertia(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    let rig = arm(effect, values);
    let link = &rig.chain.links[0];
    let about_joint = link.mass_kg * link.com_m.powi(2) + link.inertia_kg_m2 + link.armature_kg_m2;
    over(-50.0, 50.0, |acceleration| about_joint * acceleration)
}

/// Two periods of a triangle of 0.2 rad and 2 s, of which the second is drawn.
fn reading(effect: &dyn Effect, values: &[f64]) -> Vec<(f64, f64)> {
    let step_s = 2.0 / (POINTS - 1) as f64;
    let triangle = |time_s: f64| {
        let phase = (time_s / 2.0).rem_euclid(1.0);
        0.2 * (1.0 - 4.0 * (phase - 0.5).abs())
    };
    let mut memory = None;
    let mut points = Vec::new();
    for index in 0..2 * POINTS - 1 {
        let angle_rad = triangle(index as f64 * step_s);
        let encoded_rad = effect.encode(values, angle_rad);
        let read_rad = effect.sense(values, &mut memory, encoded_rad, step_s);
        points.push((angle_rad, read_rad));
    }
    points.split_off(POINTS - 1)
}

#[cfg(test)]
mod tests {
    use super::super::{EFFECTS, named};
    use super::*;

    #[test]
    fn every_effect_has_one_that_can_be_seen() {
        for effect in EFFECTS {
            let signature = signature(*effect);
            let id = effect.info().id;
            assert_eq!(signature.with.len(), signature.without.len(), "{id}");
            let finite = |point: &(f64, f64)| point.0.is_finite() && point.1.is_finite();
            assert!(
                signature.with.iter().chain(&signature.without).all(finite),
                "{id}"
            );
            assert!(
                parted(&signature) >= VISIBLE_SHARE,
                "{id}: {}",
                parted(&signature)
            );
        }
    }

    #[test]
    fn values_drawn_are_possible_ones() {
        for effect in EFFECTS {
            let values = signature(*effect).values;
            for (parameter, value) in effect.info().parameters.iter().zip(values) {
                let (low, high) = parameter.bounds;
                assert!(
                    (low..=high).contains(&value),
                    "{} {}",
                    effect.info().id,
                    parameter.key
                );
            }
        }
    }

    #[test]
    fn axes_follow_the_law() {
        let x_label = |id| signature(named(id).unwrap()).x_label;
        assert_eq!(x_label("cogging"), "angle, rad");
        assert_eq!(x_label("viscous"), "speed, rad/s");
        assert_eq!(x_label("speed_limit"), "speed, rad/s");
        assert_eq!(x_label("supply_sag"), "duty, 1");
        assert_eq!(x_label("armature"), "acceleration, rad/s^2");
        assert_eq!(x_label("mass"), "angle from hanging, rad");
    }
}
