//! What of a robot is not known exactly, and how it is drawn.

use super::case::Case;
use crate::closed_loop::normal;
use crate::effects;
use crate::model::EffectInstance;
use rand::Rng as _;
use rand_chacha::ChaCha8Rng;

/// Every quantity that can be uncertain.
pub const QUANTITIES: &[Quantity] = &[
    Quantity {
        id: "mass",
        unit: "1",
        meaning: "relative error of a link's mass",
        place: Place::Link,
        apply: |case, link, error| case.robot.links[link].mass_kg *= factor(error),
    },
    Quantity {
        id: "inertia",
        unit: "1",
        meaning: "relative error of a link's inertia about its centre of mass",
        place: Place::Link,
        apply: |case, link, error| case.robot.links[link].inertia_kg_m2 *= factor(error),
    },
    Quantity {
        id: "com",
        unit: "m",
        meaning: "error of a centre of mass along its link",
        place: Place::Link,
        apply: |case, link, error| case.robot.links[link].com_m += error,
    },
    Quantity {
        id: "com_angle",
        unit: "rad",
        meaning: "angle of a centre of mass off its link's line",
        place: Place::Link,
        apply: |case, link, angle| effect(case, "com_angle", Some(link), angle),
    },
    Quantity {
        id: "length",
        unit: "1",
        meaning: "relative error of a link's length",
        place: Place::Link,
        apply: |case, link, error| case.robot.links[link].length_m *= factor(error),
    },
    Quantity {
        id: "base_tilt",
        unit: "rad",
        meaning: "angle by which gravity is turned in the robot's plane",
        place: Place::Whole,
        apply: |case, _, angle| effect(case, "base_tilt", None, angle),
    },
    Quantity {
        id: "disturbance",
        unit: "N m",
        meaning: "constant torque from outside on a joint",
        place: Place::Link,
        apply: |case, joint, torque| case.disturbance_nm[joint] += torque,
    },
    Quantity {
        id: "supply",
        unit: "1",
        meaning: "relative error of the supply, which every torque follows",
        place: Place::Whole,
        apply: |case, _, error| case.conditions.actuator.supply *= factor(error),
    },
    Quantity {
        id: "delay",
        unit: "periods",
        meaning: "change of the delay, which stays 0 or above",
        place: Place::Whole,
        apply: |case, _, change| {
            let delay = &mut case.conditions.actuator.delay_periods;
            *delay = (*delay + change).max(0.0);
        },
    },
    Quantity {
        id: "dead_zone",
        unit: "1",
        meaning: "change of the dead zone as a share of the full torque, which stays 0 or above",
        place: Place::Whole,
        apply: |case, _, change| {
            let dead_zone = &mut case.conditions.actuator.dead_zone;
            *dead_zone = (*dead_zone + change).max(0.0);
        },
    },
];

/// Something that can be uncertain.
#[derive(Debug)]
pub struct Quantity {
    /// Name in study files.
    pub id: &'static str,
    /// Unit of its size.
    pub unit: &'static str,
    /// What is drawn.
    pub meaning: &'static str,
    /// What has it.
    pub place: Place,
    apply: fn(&mut Case, usize, f64),
}

/// What has a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Every link, or the joint before it, its own.
    Link,
    /// The robot.
    Whole,
}

/// 1 + a relative error; nothing shrinks below a hundredth.
fn factor(error: f64) -> f64 {
    (1.0 + error).max(0.01)
}

fn effect(case: &mut Case, id: &str, joint: Option<usize>, value: f64) {
    if let Some(effect) = effects::named(id) {
        case.robot.effects.push(EffectInstance {
            effect,
            joint,
            values: vec![value],
        });
    }
}

/// How a value is distributed about nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distribution {
    /// Evenly within the size to either side.
    Uniform,
    /// Normal, the size being the standard deviation.
    Normal,
}

/// One quantity, drawn anew for every run.
#[derive(Debug, Clone, Copy)]
pub struct Uncertain {
    /// What.
    pub quantity: &'static Quantity,
    /// Of which link, from 0.
    pub link: Option<usize>,
    /// How it is distributed.
    pub distribution: Distribution,
    /// How widely, in the quantity's unit.
    pub size: f64,
}

impl Uncertain {
    /// Its column: `mass:1`, `supply:all`.
    pub fn column(&self) -> String {
        match self.link {
            Some(link) => format!("{}:{}", self.quantity.id, link + 1),
            None => format!("{}:all", self.quantity.id),
        }
    }

    /// Draws a value.
    pub fn draw(&self, rng: &mut ChaCha8Rng) -> f64 {
        self.size
            * match self.distribution {
                Distribution::Uniform => rng.random_range(-1.0..=1.0),
                Distribution::Normal => normal(rng),
            }
    }

    /// Gives the case this value.
    pub fn apply(&self, case: &mut Case, value: f64) {
        (self.quantity.apply)(case, self.link.unwrap_or(0), value);
    }
}
