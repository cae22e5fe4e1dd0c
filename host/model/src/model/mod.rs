//! A robot or a bench arm as plain numbers: a planar chain of n links, or a tree of them in space.
//!
//! [`Model::load`] reads the TOML file, refusing what is unknown or impossible with its line;
//! [`edit`] writes effects and fitted values back without losing a comment.

mod address;
mod columns;
pub mod edit;
pub mod export;
mod field;
pub mod import;
mod joint;
mod joint_names;
mod limits;
pub mod new_model;
mod parse;
mod path;
mod pose;
mod rate_sensor;
pub mod reader;
mod rig;
mod robot;
pub mod shapes;
pub mod source;
pub mod suggest;
mod uncertain;
mod unit;

pub use columns::{
    ArmFigures, Column, ColumnMean, JointColumns, LinkPlace, LogColumns, MeasuredSignal,
};
pub use field::{JointField, LinkField};
pub use joint::{Drive, Joint, Motor, effect_on};
pub use joint_names::JointNames;
pub use limits::Limits;
pub use parse::STEP_S;
pub use path::ParameterPath;
pub use pose::{default_pose, hanging, upright};
pub use rate_sensor::RateSensor;
pub use robot::Robot;
pub use uncertain::{Prior, UncertainValue, typical};
pub use unit::{Dimension, Unit};

use crate::effects::{self, Effect, Scope};
use crate::error::Result;
use std::path::Path;

/// A planar chain of links hanging from, or standing on, a fixed base; or a robot in space.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// Name for reports.
    pub name: String,
    /// Where the log's angles are zero.
    pub angle_zero: AngleZero,
    /// Whether angle i is measured from the previous link or from the world.
    pub angles: Angles,
    /// Gravity, m/s^2, downwards.
    pub gravity_m_s2: f64,
    /// Longest integration step, s; jitter may stretch it by up to a tenth.
    pub step_s: f64,
    /// Whether masses, lengths and drives are guesses or rough estimates: what a simulation of them
    /// says of a log's signs and units is then a hint alone.
    pub guessed: bool,
    /// Links from the base outwards; link i follows joint i.
    pub links: Vec<Link>,
    /// Joints from the base outwards, as many as links.
    pub joints: Vec<Joint>,
    /// Where links and joints are those of a robot in space: its file. A link's `com_m` is then how
    /// far the centre of mass is from the origin of the joint's frame, its moment of inertia that
    /// about a line along the joint's axis.
    pub robot: Option<Robot>,
    /// Physical effects beyond the rigid chain and its ideal drives.
    pub effects: Vec<EffectInstance>,
    /// Effects that the file defines by an expression, whether they act or are candidates.
    pub laws: Vec<Effect>,
    /// Base parameters to refit along with every candidate effect.
    pub free: Vec<ParameterPath>,
    /// Values that a fit keeps from low to high, within what is possible: the user knows so much.
    pub bounds: Vec<(ParameterPath, (f64, f64))>,
    /// What is known beforehand of values that are free, but not exactly: a prior of every fit.
    pub uncertain: Vec<UncertainValue>,
    /// How this rig's logs name and scale their columns.
    pub log: LogColumns,
}

/// Where the log's absolute angles are zero; all grow counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AngleZero {
    /// Straight down.
    Hanging,
    /// Straight up.
    Upright,
    /// To the right of the base.
    Horizontal,
}

impl AngleZero {
    /// As model files write it.
    pub fn name(self) -> &'static str {
        match self {
            AngleZero::Hanging => "hanging",
            AngleZero::Upright => "upright",
            AngleZero::Horizontal => "horizontal",
        }
    }

    /// The log's zero as an angle from hanging, rad.
    pub fn from_hanging_rad(self) -> f64 {
        match self {
            AngleZero::Hanging => 0.0,
            AngleZero::Horizontal => std::f64::consts::FRAC_PI_2,
            AngleZero::Upright => std::f64::consts::PI,
        }
    }
}

/// What the log's angles are measured from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Angles {
    /// Each from the link before it.
    Relative,
    /// Each from the world.
    Absolute,
}

/// A rigid link.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Joint to next joint, m.
    pub length_m: f64,
    /// Joint to centre of mass, m, along the link.
    pub com_m: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Moment of inertia about the centre of mass, kg m^2.
    pub inertia_kg_m2: f64,
}

/// One effect of the library with its values: at a joint, at all driven joints, or on the whole
/// rig.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectInstance {
    /// Which effect.
    pub effect: Effect,
    /// Joint index from 0; `None` acts on the whole rig, and on every driven joint if the effect is
    /// one of joints.
    pub joint: Option<usize>,
    /// Values in the order of the effect's parameters.
    pub values: Vec<f64>,
}

/// An effect and its joint, by index from 0: `coulomb@2`, `delay@all`.
pub fn named_at(effect: Effect, joint: Option<usize>) -> String {
    let id = effect.info().id;
    match joint {
        Some(joint) => format!("{id}@{}", joint + 1),
        None => format!("{id}{}", effects::at_all(id)),
    }
}

impl EffectInstance {
    /// The effect and its joint: `coulomb@2`, `delay@all`.
    pub fn name(&self) -> String {
        named_at(self.effect, self.joint)
    }

    /// Whether it is the effect of this id at this joint.
    fn is(&self, id: &str, joint: Option<usize>) -> bool {
        self.joint == joint && self.effect.info().id == id
    }

    /// Whether it acts on a joint, given by index from 0.
    pub fn acts_on(&self, index: usize, joint: &Joint) -> bool {
        match self.joint {
            Some(own) => own == index,
            None => self.effect.info().scope != Scope::WholeRig && joint.drive.is_driven(),
        }
    }

    /// What is left of a gear that gives once it is rigid: the inertia of its motor. None of other
    /// effects.
    pub fn rigid(&self) -> Option<EffectInstance> {
        let mut gear = effects::Gear::RIGID;
        self.effect.gear(&self.values, &mut gear);
        let effect = effects::named("armature")?.on(self.effect.axis())?;
        (gear != effects::Gear::RIGID).then_some(EffectInstance {
            effect,
            joint: self.joint,
            values: vec![gear.inertia_kg_m2],
        })
    }

    /// Whether it and the effect of this id there would act on one place.
    fn meets(&self, id: &str, joint: Option<usize>, joints: &[Joint]) -> bool {
        let meet = match (self.joint, joint) {
            (Some(joint), None) | (None, Some(joint)) => joints
                .get(joint)
                .is_some_and(|joint| joint.drive.is_driven()),
            (own, other) => own == other,
        };
        meet && self.effect.info().id == id
    }
}

impl Model {
    /// Reads a model file.
    ///
    /// # Errors
    /// Unknown keys, wrong types and impossible values, each with file, line and remedy.
    pub fn load(path: &Path) -> Result<Model> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| crate::error::Error::file(path, "read", source))?;
        Model::parse(&text, path)
    }

    /// Reads a model from text; `path` only names it in errors.
    ///
    /// # Errors
    /// As [`Model::load`].
    pub fn parse(text: &str, path: &Path) -> Result<Model> {
        parse::model(text, path)
    }

    /// Number of links.
    pub fn link_count(&self) -> usize {
        self.links.len()
    }

    /// Joints that something drives, from the base outwards, counted from 0.
    pub fn driven_joints(&self) -> Vec<usize> {
        (0..self.joints.len())
            .filter(|&joint| self.joints[joint].drive.is_driven())
            .collect()
    }

    /// The coarsest step of its measured angles, rad; 0 where the log declares none.
    pub fn position_step_rad(&self) -> f64 {
        let joints = self.log.joints.iter();
        let steps = joints.filter_map(|joint| joint.position.as_ref()?.resolution());
        steps.fold(0.0, f64::max)
    }

    /// Whether any joint slides.
    pub fn slides(&self) -> bool {
        self.joints.iter().any(|joint| joint.slide.is_some())
    }

    /// Refuses a model with joints that slide; `why` reads on from "joint 1 slides, and".
    ///
    /// # Errors
    /// A joint that slides.
    pub fn hinges_only(&self, why: &str) -> Result<()> {
        match self.joints.iter().position(|joint| joint.slide.is_some()) {
            None => Ok(()),
            Some(joint) => Err(crate::Error::design(
                format!("joint {} of `{}` slides, and {why}", joint + 1, self.name),
                "give a model whose joints all turn",
            )),
        }
    }

    /// Angle from hanging at which the log's angle of a joint is zero, rad: what `angle_zero` says
    /// of the first joint that turns, else 0.
    pub fn zero_rad(&self, joint: usize) -> f64 {
        let first = self.joints.iter().position(|joint| joint.slide.is_none());
        if first == Some(joint) {
            self.angle_zero.from_hanging_rad()
        } else {
            0.0
        }
    }

    /// The hinges whose speeds add up to the rate that a sensor at a joint feels.
    pub fn turning(&self, sensor: RateSensor, joint: usize) -> Vec<usize> {
        let turns = |joint: &usize| self.joints[*joint].slide.is_none();
        match sensor {
            RateSensor::Tachometer => vec![joint],
            RateSensor::Gyro => (0..=joint).filter(turns).collect(),
        }
    }

    /// Whether a sensor's reading trails the motion, or a joint's column is off in time against
    /// others: the state of the joints then follows from how fast readings change.
    pub fn trails(&self) -> bool {
        let several = self.link_count() > 1 || !self.log.rate_joints().is_empty();
        let trails = |e: &EffectInstance| {
            let offset_s = e.effect.reading_offset_s(&e.values).filter(|_| several);
            offset_s.or(e.effect.trail_rad(&e.values, 1.0)).is_some()
        };
        self.effects.iter().any(trails)
    }

    /// Adds an effect of the library at a joint, if there is one of this id.
    pub fn add_effect(&mut self, id: &str, joint: usize, values: Vec<f64>) {
        let named = effects::named(id);
        let effect = named.and_then(|effect| effect_on(effect, Some(joint), &self.joints));
        self.effects.extend(effect.map(|effect| EffectInstance {
            effect,
            joint: Some(joint),
            values,
        }));
    }

    /// Effects that act on a joint, given by index from 0, in the order of the file; of the whole
    /// rig none.
    pub fn effects_at(&self, joint: usize) -> impl Iterator<Item = &EffectInstance> {
        let effects = self.effects.iter();
        effects.filter(move |effect| effect.acts_on(joint, &self.joints[joint]))
    }

    /// Whether the model already holds this effect at this joint; without one, on the whole rig or
    /// at any driven joint.
    pub fn has_effect(&self, id: &str, joint: Option<usize>) -> bool {
        self.effects
            .iter()
            .any(|effect| effect.meets(id, joint, &self.joints))
    }
}
