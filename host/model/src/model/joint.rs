//! A joint: whether it turns or slides, what drives it, and which effects can act on it.

use crate::dynamics::SlideAxis;
use crate::effects::{Axis, Effect, Scope};

/// A joint: what drives it, and whether it turns or slides.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// What moves it.
    pub drive: Drive,
    /// Along what it slides; none of a hinge. Of a joint that slides, what is said in rad, rad/s
    /// and N m is in m, m/s and N.
    pub slide: Option<SlideAxis>,
}

impl From<Drive> for Joint {
    /// A hinge.
    fn from(drive: Drive) -> Joint {
        Joint { drive, slide: None }
    }
}

impl Joint {
    /// How it moves.
    pub fn axis(&self) -> Axis {
        match self.slide {
            None => Axis::Hinge,
            Some(_) => Axis::Slide,
        }
    }

    /// SI units, as text, of its place, its speed and its torque or force.
    pub fn units(&self) -> [&'static str; 3] {
        match self.axis() {
            Axis::Hinge => ["rad", "rad/s", "N m"],
            Axis::Slide => ["m", "m/s", "N"],
        }
    }
}

/// An effect as it is at a joint, or at all driven ones; none where it cannot act, or where its
/// values had different units at different joints.
pub fn effect_on(effect: Effect, joint: Option<usize>, joints: &[Joint]) -> Option<Effect> {
    if effect.info().scope == Scope::WholeRig {
        return Some(effect);
    }
    let acts = |(index, own): &(usize, &Joint)| match joint {
        Some(joint) => joint == *index,
        None => own.drive.is_driven(),
    };
    let mut axes = joints
        .iter()
        .enumerate()
        .filter(acts)
        .map(|(_, own)| own.axis());
    let first = effect.on(axes.next()?)?;
    let same = |axis| {
        let other = effect.on(axis);
        other.is_some_and(|other| std::ptr::eq(other.info(), first.info()))
    };
    axes.all(same).then_some(first)
}

/// What moves a joint. Duty is the share of the full voltage, -1 to 1.
#[derive(Debug, Clone, PartialEq)]
pub enum Drive {
    /// Nothing: swings freely.
    Passive,
    /// The log's input is a torque, N m.
    Torque,
    /// The log's input is a duty; torque = stall torque * duty.
    Duty(Motor),
    /// The log's input is a goal angle, rad; duty = gain * error, clipped at 1.
    Position {
        /// Duty per rad of error.
        gain_per_rad: f64,
        /// The motor behind it.
        motor: Motor,
    },
    /// The log's input is a goal speed, rad/s; duty = goal / no-load speed + gain * error, clipped
    /// at 1.
    Speed {
        /// Duty per rad/s of error.
        gain_s_per_rad: f64,
        /// The motor behind it.
        motor: Motor,
    },
}

impl Drive {
    /// The motor, if there is one.
    pub fn motor(&self) -> Option<&Motor> {
        match self {
            Drive::Passive | Drive::Torque => None,
            Drive::Duty(motor) | Drive::Position { motor, .. } | Drive::Speed { motor, .. } => {
                Some(motor)
            }
        }
    }

    pub(super) fn motor_mut(&mut self) -> Option<&mut Motor> {
        match self {
            Drive::Passive | Drive::Torque => None,
            Drive::Duty(motor) | Drive::Position { motor, .. } | Drive::Speed { motor, .. } => {
                Some(motor)
            }
        }
    }

    /// Whether anything moves the joint.
    pub fn is_driven(&self) -> bool {
        !matches!(self, Drive::Passive)
    }

    /// The key that names it in a model file.
    pub fn name(&self) -> &'static str {
        match self {
            Drive::Passive => "passive",
            Drive::Torque => "torque",
            Drive::Duty(_) => "duty",
            Drive::Position { .. } => "position",
            Drive::Speed { .. } => "speed",
        }
    }
}

/// A direct-current motor with its gear, at the joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Motor {
    /// Torque at standstill and full duty at the nominal supply, N m.
    pub stall_torque_nm: f64,
    /// Speed without load at full duty at the nominal supply, rad/s; infinite when torque does not
    /// fall with speed.
    pub no_load_speed_rad_s: f64,
    /// Supply for which the figures hold, V.
    pub nominal_supply_v: Option<f64>,
}
