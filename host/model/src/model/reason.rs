//! Why a model is refused: data, sentence, remedy.

use super::{Dimension, Joint};
use crate::effects::{Effect, Scope};
use crate::error::Reason;
use std::borrow::Cow;

/// What is wrong with the content of a model file whose keys and values are well formed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelReason {
    /// More joints than links.
    #[error("[[joint]] {} is one joint too many for {links} link(s)", links + 1)]
    ExtraJoint {
        /// Number of links.
        links: usize,
    },
    /// Fewer joints than links.
    #[error("the file has {links} link(s) but {joints} joint(s)")]
    MissingJoint {
        /// Number of links.
        links: usize,
        /// Number of joints.
        joints: usize,
    },
    /// Moments of inertia about joint and centre of mass at once.
    #[error("the link has a moment of inertia about its centre of mass too")]
    TwoInertias,
    /// Less inertia about the joint than a point mass has.
    #[error(
        "{about_joint_kg_m2} kg m^2 about the joint is less than mass_kg com_m^2 = {steiner_kg_m2:.4e} kg m^2"
    )]
    LittleInertia {
        /// About the joint, kg m^2.
        about_joint_kg_m2: f64,
        /// Of the mass at its distance, kg m^2.
        steiner_kg_m2: f64,
    },
    /// Columns for more joints than the model has.
    #[error("[[log.joint]] {} is one too many for {joints} joint(s)", joints + 1)]
    ExtraColumns {
        /// Number of joints.
        joints: usize,
    },
    /// Columns for fewer joints than the model has.
    #[error("[log] names the columns of {named} joint(s) out of {joints}")]
    MissingColumns {
        /// Number of joints whose columns are named.
        named: usize,
        /// Number of joints.
        joints: usize,
    },
    /// An effect twice at one joint.
    #[error("`{id}` is there twice")]
    EffectTwice {
        /// The effect.
        id: &'static str,
    },
    /// A joint given for an effect of the whole rig.
    #[error("`{id}` acts on the whole rig, not on one joint")]
    WholeRig {
        /// The effect.
        id: &'static str,
    },
    /// An effect at all driven joints that acts on none of them.
    #[error("`{id}` acts on no driven joint of this model")]
    NoDrivenJoint {
        /// The effect.
        id: &'static str,
    },
    /// An effect at a joint that it cannot act on.
    #[error("`{id}` acts on {wanted} joints only, and joint {} is `{drive}`", joint + 1)]
    UnsuitedJoint {
        /// The effect.
        id: &'static str,
        /// `driven` or `passive`.
        wanted: &'static str,
        /// The joint, from 0.
        joint: usize,
        /// Its drive.
        drive: &'static str,
    },
    /// An effect that has no meaning where the joint slides.
    #[error("`{id}` does not act on joints that slide")]
    NotOnSlide {
        /// The effect.
        id: &'static str,
    },
    /// An effect that has no meaning for a robot in space.
    #[error("`{id}` is that of a planar chain, and this is a robot in space")]
    NotInSpace {
        /// The effect.
        id: &'static str,
    },
    /// A robot's file that cannot be read.
    #[error("cannot read the robot's file {file}: {source_text}")]
    RobotUnread {
        /// The file.
        file: String,
        /// Why.
        source_text: String,
    },
    /// A robot's file of which no model can be made.
    #[error("{why}")]
    RobotRefused {
        /// Why.
        why: String,
        /// What to do.
        remedy: String,
    },
    /// A robot's file that is not the one noted.
    #[error("the robot's file is another than the one noted: its SHA-256 is {found}")]
    RobotChanged {
        /// What was found.
        found: String,
    },
    /// A joint or link under a name that the robot's file does not have there.
    #[error("{what} `{name}` is not the robot's `{wanted}`")]
    OtherName {
        /// `joint` or `link`.
        what: &'static str,
        /// The name found.
        name: String,
        /// The name in the robot's file.
        wanted: String,
    },
    /// Another number of joints, or of links, than the robot has.
    #[error("{found} [[{what}]] tables for {wanted} joints of the robot")]
    RobotCount {
        /// `joint` or `link`.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many the robot has that move.
        wanted: usize,
        /// Their names.
        names: String,
    },
    /// A joint whose motor brakes it faster than a step can follow.
    #[error(
        "joint `{name}` meets {inertia:.1e} kg m^2, which its motor's back-EMF brakes within \
         {brakes_s:.1e} s: steps of {step_s} s cannot follow"
    )]
    StiffJoint {
        /// The joint.
        name: String,
        /// The inertia, kg m^2.
        inertia: f64,
        /// The time constant, s.
        brakes_s: f64,
        /// Longest integration step, s.
        step_s: f64,
    },
    /// A gyro of a robot in space.
    #[error("a gyro feels joints whose axes are parallel, and this is a robot in space")]
    GyroInSpace,
    /// A payload of a robot in space.
    #[error("a robot in space has no payload column yet")]
    PayloadInSpace,
    /// Joints that slide, and angles from the world.
    #[error("the model has joints that slide, and angles from the world")]
    AbsoluteSlides,
    /// A slide whose displacement no log holds.
    #[error("[[log.joint]] of a joint that slides lacks `position`")]
    SlideUnmeasured,
    /// A unit that there is not.
    #[error("unknown unit `{unit}`")]
    UnknownUnit {
        /// The unit found.
        unit: String,
        /// What the quantity measures.
        wanted: Dimension,
    },
    /// A unit that measures something else.
    #[error("unit `{unit}` measures {found}, and `{quantity}` is {wanted}")]
    OtherDimension {
        /// The unit found.
        unit: &'static str,
        /// What it measures.
        found: Dimension,
        /// The column's quantity.
        quantity: &'static str,
        /// What that measures.
        wanted: Dimension,
    },
    /// A log of which no joint is measured.
    #[error("[log] names neither a position nor a velocity of any joint")]
    NothingMeasured,
    /// A rate sensor at a joint that slides.
    #[error("a joint that slides has no `{key}`")]
    RateOfSlide {
        /// The sensor's key.
        key: &'static str,
    },
    /// A rate sensor beside no angle.
    #[error("`{key}` is a rate sensor beside an angle, and this joint has no `position`")]
    RateWithoutAngle {
        /// The sensor's key.
        key: &'static str,
    },
    /// Two rate sensors at one joint.
    #[error("a joint has one rate sensor: `gyro` or `tachometer`")]
    TwoRates,
    /// A list of columns without any.
    #[error("`{quantity}` names no column")]
    NoColumns {
        /// The quantity.
        quantity: &'static str,
    },
    /// An input column for a passive joint.
    #[error("a passive joint has no input")]
    PassiveInput,
    /// No input column for a driven joint.
    #[error("{table} lacks `input`, and its joint is driven by `{drive}`")]
    MissingInput {
        /// The table, as `[[log.joint]] 2`.
        table: String,
        /// The joint's drive.
        drive: &'static str,
        /// What its input measures.
        wanted: Dimension,
    },
    /// A free parameter that the model does not have.
    #[error("`{path}` is not in this model")]
    FreeAbsent {
        /// Its address.
        path: String,
    },
    /// A free parameter without a finite value.
    #[error("`{path}` is infinite, so nothing can be fitted")]
    FreeInfinite {
        /// Its address.
        path: String,
    },
    /// A free parameter named twice.
    #[error("`{path}` is named twice")]
    FreeTwice {
        /// Its address.
        path: String,
    },
    /// A value that the file frees and knows.
    #[error("`{path}` is free, and so it can have no uncertainty")]
    FreeAndUncertain {
        /// Its address.
        path: String,
    },
    /// Bounds that leave no room.
    #[error("from {low} to {high} `{path}` has no possible value")]
    NoBounds {
        /// Address of the value.
        path: String,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
        /// Lowest and highest possible value.
        possible: (f64, f64),
    },
    /// A value outside the bounds that it is to be fitted in.
    #[error("`{path}` = {value} lies outside its bounds, {low} to {high}")]
    OutsideBounds {
        /// Address of the value.
        path: String,
        /// The model's value.
        value: f64,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
}

use ModelReason::*;

impl ModelReason {
    /// Why the effect cannot act on this joint, if it cannot.
    pub fn unsuited(effect: Effect, index: usize, joint: &Joint) -> Option<ModelReason> {
        let wanted = match (effect.info().scope, joint.drive.is_driven()) {
            (Scope::DrivenJoint, false) => "driven",
            (Scope::PassiveJoint, true) => "passive",
            _ => return None,
        };
        Some(UnsuitedJoint {
            id: effect.info().id,
            wanted,
            joint: index,
            drive: joint.drive.name(),
        })
    }
}

impl Reason for ModelReason {
    fn remedy(&self) -> Cow<'_, str> {
        let units = |wanted: &Dimension| wanted.unit_names().collect::<Vec<_>>().join(", ");
        Cow::Borrowed(match self {
            ExtraJoint { .. } => {
                "every link follows one joint: add a `[[link]]` or remove the joint"
            }
            MissingJoint { .. } => "every link follows one joint: add a `[[joint]]` for each",
            TwoInertias => "keep inertia_kg_m2 or joint_inertia_kg_m2",
            LittleInertia { .. } => {
                "mend one of the three; about the centre of mass it is inertia_kg_m2"
            }
            ExtraColumns { .. } => "give one `[[log.joint]]` for each `[[joint]]`, in order",
            MissingColumns { .. } => "add one `[[log.joint]]` for each `[[joint]]`, in order",
            EffectTwice { .. } => "keep one of the two, or give it another joint",
            WholeRig { .. } => "leave the joint out",
            NoDrivenJoint { .. } => "name a joint, counted from 1",
            UnsuitedJoint { wanted, .. } => {
                return format!("name a {wanted} joint, or another effect").into();
            }
            NotOnSlide { .. } => "name a joint that turns, or another effect",
            NotInSpace { .. } => "remove it",
            RobotUnread { .. } => "name a URDF or MJCF file, relative to the model's",
            RobotRefused { remedy, .. } => return remedy.as_str().into(),
            RobotChanged { .. } => {
                "look what changed; if the model's values still hold, note the new one"
            }
            OtherName { .. } => "name joints and links in the order of the robot's file",
            RobotCount { names, .. } => {
                return format!("one each, in this order: {names}; hold others in [rig] locked")
                    .into();
            }
            StiffJoint { .. } => {
                "add the rotor's inertia, `kind = \"armature\"`, or write a shorter `step_s`"
            }
            GyroInSpace => "remove `gyro`; a joint's own rate is a `tachometer`",
            PayloadInSpace => "remove it; put the mass into a link of the robot's file",
            AbsoluteSlides => "write `angles = \"relative\"`: each from the link before",
            SlideUnmeasured => {
                "name the column of its displacement: a slide's speed alone will not do"
            }
            UnknownUnit { wanted, .. } | OtherDimension { wanted, .. } => {
                return format!("write one of: {}", units(wanted)).into();
            }
            NothingMeasured => "name the column of an angle, or of a rate: `velocity`",
            RateOfSlide { .. } => "remove it; a slide's `velocity` helps to guess start states",
            RateWithoutAngle { .. } => "call it `velocity`: the joint is then compared by its rate",
            TwoRates => "keep the one that reads more finely",
            NoColumns { .. } => "name one, such as { column = \"q_rad\", unit = \"rad\" }",
            PassiveInput => "remove `input`, or say what drives the joint",
            MissingInput { wanted, .. } => {
                let unit = wanted.unit_names().next().unwrap_or("1");
                return format!("add `input = {{ column = \"...\", unit = \"{unit}\" }}`").into();
            }
            FreeAbsent { .. } => "add its link, drive or effect, or remove it here",
            FreeInfinite { .. } => "give it a value to start from",
            FreeTwice { .. } => "remove one",
            FreeAndUncertain { .. } => {
                "free is what is not known beforehand: keep it under `[fit] free`, or here"
            }
            NoBounds {
                possible: (low, high),
                ..
            } => {
                return format!("write the lower one first; possible is {low} to {high}").into();
            }
            OutsideBounds { .. } => "a fit begins at the value: move it inside, or widen them",
        })
    }
}
