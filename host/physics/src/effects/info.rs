//! What an effect says of itself.

use super::unit_suffix::unit_of;
use serde::{Serialize, Serializer};

/// Where in the chain command -> drive -> joint -> body -> sensor an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Site {
    /// On the way to the drive.
    Timing,
    /// On the duty.
    Command,
    /// On the torque the drive makes.
    Drive,
    /// Between the motor and the joint.
    Gear,
    /// On the joint, as friction.
    Friction,
    /// On the joint, as any other torque.
    Joint,
    /// On masses and gravity.
    Body,
    /// On what is read, at once.
    Encoder,
    /// On what is read, with memory.
    Sensor,
    /// On a rate that is read.
    Rate,
}

/// How a joint moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// It turns: rad, N m.
    Hinge,
    /// It slides: m, N.
    Slide,
}

/// Which joints an effect can act on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Scope {
    /// Every joint.
    AnyJoint,
    /// Joints that are driven.
    DrivenJoint,
    /// Joints that swing freely.
    PassiveJoint,
    /// Once for the whole rig.
    WholeRig,
}

/// A value of the model that an effect may change and do nothing else.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueBehind {
    /// The drive's torque (force of a slide) at standstill.
    StallTorque,
    /// The mass of the joint's link.
    LinkMass,
}

/// What an effect is at a joint that slides.
#[derive(Debug, Clone, Copy)]
pub enum OnSlide {
    /// No unit of its values is one of angles: the same.
    Same,
    /// Its values have other keys and units, in m and N.
    Own(&'static EffectInfo),
    /// It cannot act there.
    Never,
}

/// What must be logged or known for an effect to be a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// Nothing beyond angles and inputs.
    Nothing,
    /// The supply, logged and varying, and the motor's nominal supply.
    Supply,
    /// The torque through the gear, computed along with the dynamics.
    GearLoad,
    /// The force in the bearing, computed along with the dynamics.
    BearingLoad,
    /// A rate sensor that the joint has beside the one of its angle.
    RateSensor,
}

/// One value of an effect.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Parameter {
    /// Key in model files, with its unit: `torque_nm`.
    pub key: &'static str,
    /// Unit as shown to people: `N m`.
    pub unit: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// Value at which the effect vanishes; `None` for a shape parameter, which has none. JSON
    /// knows no infinity: an effect that is off at infinity has `null` there as well.
    pub off: Option<f64>,
    /// Range met in practice on servo arms of this size.
    pub typical: (f64, f64),
    /// Physically possible range: signs are enforced by it.
    pub bounds: (f64, f64),
    /// Values to start a fit from, the first being the default.
    #[serde(skip)]
    pub starts: &'static [f64],
}

impl Parameter {
    /// A value of this key, whose suffix says its unit, without its numbers.
    pub const fn of(key: &'static str, meaning: &'static str) -> Parameter {
        Parameter {
            key,
            unit: unit_of(key),
            meaning,
            off: None,
            typical: (0.0, 0.0),
            bounds: (0.0, 0.0),
            starts: &[],
        }
    }

    /// It vanishing at this value.
    #[must_use]
    pub const fn off(self, at: f64) -> Parameter {
        Parameter {
            off: Some(at),
            ..self
        }
    }

    /// It with the range met in practice.
    #[must_use]
    pub const fn typical(self, low: f64, high: f64) -> Parameter {
        Parameter {
            typical: (low, high),
            ..self
        }
    }

    /// It with its physically possible range.
    #[must_use]
    pub const fn bounds(self, low: f64, high: f64) -> Parameter {
        Parameter {
            bounds: (low, high),
            ..self
        }
    }

    /// It with the values to start a fit from.
    #[must_use]
    pub const fn starts(self, starts: &'static [f64]) -> Parameter {
        Parameter { starts, ..self }
    }
}

/// Another effect that looks alike.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Confusion {
    /// Its id.
    pub with: &'static str,
    /// Why they look alike and what tells them apart.
    pub why: &'static str,
}

/// The whole description of an effect.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct EffectInfo {
    /// Name in commands and model files: `coulomb`.
    pub id: &'static str,
    /// Name for people.
    pub title: &'static str,
    /// What else people call it; several effects may share a word, as `friction`.
    pub aliases: &'static [&'static str],
    /// The law in one line.
    pub law: &'static str,
    /// Which joints it can act on.
    pub scope: Scope,
    /// Where it acts.
    #[serde(skip)]
    pub site: Site,
    /// What it takes to be a candidate.
    #[serde(skip)]
    pub needs: Needs,
    /// What it is at a joint that slides.
    #[serde(skip)]
    pub on_slide: OnSlide,
    /// Its values.
    pub parameters: &'static [Parameter],
    /// What a log shows.
    pub looks_like: &'static str,
    /// What it is taken for: `id: why they look alike; what tells them apart`.
    #[serde(serialize_with = "as_confusions")]
    pub confused_with: &'static [&'static str],
    /// The experiment that reveals it.
    pub experiment: &'static str,
    /// Where the law comes from.
    pub reference: &'static str,
}

impl EffectInfo {
    /// What it is taken for.
    pub fn confusions(&self) -> impl Iterator<Item = Confusion> {
        confusions(self.confused_with)
    }
}

fn confusions(texts: &[&'static str]) -> impl Iterator<Item = Confusion> {
    let parts = texts.iter().filter_map(|text| text.split_once(": "));
    parts.map(|(with, why)| Confusion { with, why })
}

fn as_confusions<S: Serializer>(texts: &[&'static str], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(confusions(texts))
}
