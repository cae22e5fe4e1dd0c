//! What an effect sees, and what it may change.

use super::{BaseSpring, MemoryCell};
use crate::dynamics::{Chain, SpatialTree};

/// A joint at rest, about which an effect's law is linearised.
#[derive(Debug, Clone, Copy)]
pub struct AtRest {
    /// Angle from the previous link, rad; of the first joint from the model's zero.
    pub angle_rad: f64,
    /// Duty, -1 to 1; of a torque drive, its torque in N m.
    pub duty: f64,
    /// Torque of the drive before this effect, N m.
    pub torque_nm: f64,
    /// Torque at full duty and standstill, N m.
    pub full_torque_nm: f64,
}

/// How an effect's output changes: `gain` times its input's change (of duty, torque or angle, as
/// its site has it), and what it adds of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// Per unit of what passes through.
    pub gain: f64,
    /// Torque per duty, N m.
    pub per_duty: f64,
    /// Torque per joint angle, N m/rad.
    pub per_rad: f64,
    /// Torque per joint speed, N m s/rad.
    pub per_rad_s: f64,
}

impl Slope {
    /// An effect that changes nothing to first order.
    pub const NONE: Slope = Slope {
        gain: 1.0,
        per_duty: 0.0,
        per_rad: 0.0,
        per_rad_s: 0.0,
    };
}

/// What body effects may change.
#[derive(Debug, Clone)]
pub struct Rig {
    /// The rigid chain; without links where the robot is one in space.
    pub chain: Chain,
    /// A robot in space.
    pub tree: Option<SpatialTree>,
    /// Angle by which gravity is turned in the rig's plane, rad, counter-clockwise.
    pub gravity_turn_rad: f64,
    /// Whether the rig stands turned by 180 degrees about the vertical, which flips a tilt's sign.
    pub turned: bool,
    /// What the base stands on, where it gives way.
    pub base_spring: Option<BaseSpring>,
}

impl Rig {
    /// Adds to the inertia of a joint's rotor, kg m^2, or kg.
    pub fn add_armature(&mut self, joint: usize, inertia_kg_m2: f64) {
        match &mut self.tree {
            Some(tree) => tree.links[joint].armature_kg_m2 += inertia_kg_m2,
            None => self.chain.links[joint].armature_kg_m2 += inertia_kg_m2,
        }
    }

    /// Mass of the link behind a joint, kg.
    pub fn mass_kg(&mut self, joint: usize) -> &mut f64 {
        match &mut self.tree {
            Some(tree) => &mut tree.links[joint].mass_kg,
            None => &mut self.chain.links[joint].mass_kg,
        }
    }

    /// Makes a link heavier by this factor, its inertia about the centre of mass too.
    pub fn scale_mass(&mut self, joint: usize, factor: f64) {
        *self.mass_kg(joint) *= factor;
        match &mut self.tree {
            Some(tree) => tree.links[joint].inertia_kg_m2 *= factor,
            None => self.chain.links[joint].inertia_kg_m2 *= factor,
        }
    }
}

/// The motor at an instant.
#[derive(Debug, Clone, Copy)]
pub struct DriveState {
    /// Joint speed, rad/s.
    pub speed_rad_s: f64,
    /// Duty after the command effects, -1 to 1.
    pub duty: f64,
    /// Torque at full duty and standstill, N m.
    pub full_torque_nm: f64,
    /// Supply over nominal supply; 1 where either is unknown.
    pub supply_ratio: f64,
    /// What the effect remembers, if it does.
    pub memory: MemoryCell,
}

/// What the log says of a joint's drive at an instant, and when that is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signals {
    /// Input of the drive in SI of its kind, after delays: goal, rad or rad/s; duty; torque, N m.
    pub input: f64,
    /// Supply over nominal supply; 1 where either is unknown.
    pub supply_ratio: f64,
    /// Time of the motion, s, as its rows have it: steps of the log.
    pub time_s: f64,
}

impl Signals {
    /// No input, the nominal supply, at the beginning.
    pub const NONE: Signals = Signals {
        input: 0.0,
        supply_ratio: 1.0,
        time_s: 0.0,
    };
}

/// A joint at an instant.
#[derive(Debug, Clone, Copy)]
pub struct JointState {
    /// Angle from the previous link, rad; of the first joint from the model's zero.
    pub angle_rad: f64,
    /// Speed relative to the previous link, rad/s.
    pub speed_rad_s: f64,
    /// Torque of the drive, N m.
    pub drive_nm: f64,
    /// What is commanded and supplied, and when.
    pub signals: Signals,
    /// Measured speed of another moment, rad/s: what a placebo acts on.
    pub shuffled_rad_s: f64,
    /// What the effect remembers, if it does.
    pub memory: MemoryCell,
}

impl JointState {
    /// Without a drive.
    pub fn undriven(angle_rad: f64, speed_rad_s: f64) -> Self {
        JointState {
            angle_rad,
            speed_rad_s,
            drive_nm: 0.0,
            signals: Signals::NONE,
            shuffled_rad_s: 0.0,
            memory: MemoryCell::EMPTY,
        }
    }
}

/// The shaft of an encoder at an instant, zero and scale of the encoder included; or, of a sensor
/// of rates, the rate.
#[derive(Debug, Clone, Copy)]
pub struct Encoded {
    /// rad.
    pub angle_rad: f64,
    /// rad/s.
    pub speed_rad_s: f64,
    /// Mean over the step that ends here; unknown of an angle, whose course is nearly straight.
    pub mean: Option<f64>,
}

impl Encoded {
    /// A shaft that stands still.
    pub fn still(angle_rad: f64) -> Self {
        Encoded {
            angle_rad,
            speed_rad_s: 0.0,
            mean: None,
        }
    }
}

/// A joint and its drive at the end of a step, for an effect to remember.
#[derive(Debug, Clone, Copy)]
pub struct StepState {
    /// Input that arrived at the drive during the step, in SI of its kind.
    pub input: f64,
    /// Duty after the command effects, -1 to 1; 0 while the drive is not energised.
    pub duty: f64,
    /// Whether the drive is energised.
    pub energised: bool,
    /// Angle from the previous link, rad; of the first joint from the model's zero.
    pub angle_rad: f64,
    /// Speed relative to the previous link, rad/s.
    pub speed_rad_s: f64,
}

impl StepState {
    /// An energised drive without input, and its joint at rest.
    pub fn at_rest(angle_rad: f64) -> Self {
        StepState {
            input: 0.0,
            duty: 0.0,
            energised: true,
            angle_rad,
            speed_rad_s: 0.0,
        }
    }
}

/// What an effect remembers, or waits for, where a simulation begins, and no reading tells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StartUnknown {
    /// Nothing: the start state tells what it remembers.
    Nothing,
    /// Wherever a window begins: how far it has displaced something, at most so far either way,
    /// rad (m); a sensor's displacement has a rate that is unknown, too.
    Displacement {
        /// rad (m).
        most: f64,
    },
    /// Where a motion begins: the input that the drive was given before the log.
    Input {
        /// Whether the drive gets from that to its input slowly, not only late.
        is_slow: bool,
    },
    /// Where a motion begins: where the motor is that turns apart from its joint, and how fast it
    /// moves.
    Body,
    /// Where a motion begins: how much has come together before, from nothing, as in a drive that
    /// has rested, to this.
    Amount {
        /// In the unit of what it remembers.
        most: f64,
    },
}

/// A joint that slides, or is about to.
#[derive(Debug, Clone, Copy)]
pub struct FrictionState {
    /// Angle from the previous link, rad; of the first joint from the model's zero.
    pub angle_rad: f64,
    /// Magnitude of the joint speed, rad/s; 0 asks for breakaway.
    pub speed_rad_s: f64,
    /// +1 or -1: the direction of motion, or of the push at rest.
    pub direction: f64,
    /// Magnitude of motor torque minus outside torque (gravity, coupling), N m: what the gear
    /// transmits.
    pub gear_load_nm: f64,
    /// Torque of the motor, N m.
    pub motor_nm: f64,
    /// Torque from outside (gravity, coupling), N m.
    pub outside_nm: f64,
    /// Magnitude of the force in the bearing, N.
    pub bearing_load_n: f64,
    /// What is commanded and supplied, and when.
    pub signals: Signals,
}
