//! Why a text is no address of a number.

use super::suggest::suggest;
use crate::error::Reason;
use std::borrow::Cow;

/// Why a text is no address of a number: see [`ParameterPath`](super::ParameterPath).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PathReason {
    /// It has no key.
    #[error("`{text}` names no parameter")]
    NoParameter {
        /// The text.
        text: String,
    },
    /// Its owner or key is unknown.
    #[error("`{text}`: unknown name `{name}`")]
    UnknownName {
        /// The text.
        text: String,
        /// The part that is unknown.
        name: String,
        /// The names known there.
        known: Vec<&'static str>,
    },
    /// What follows the `@` is neither a count from 1 nor `all`.
    #[error("`{text}`: `{joint}` is no joint")]
    NoJoint {
        /// The text.
        text: String,
        /// What follows the `@`.
        joint: String,
    },
    /// It names a joint for an effect of the whole rig.
    #[error("`{text}`: `{id}` acts on the whole rig, not on one joint")]
    WholeRig {
        /// The text.
        text: String,
        /// The effect.
        id: &'static str,
    },
    /// The robot in space has no such link or joint.
    #[error("`{text}`: the robot has no {what} `{name}`")]
    NotOfRobot {
        /// The text.
        text: String,
        /// `link` or `joint`.
        what: &'static str,
        /// The name.
        name: String,
        /// Those that it has.
        known: Vec<String>,
    },
    /// It names no joint for an effect of one joint.
    #[error("`{text}` does not say at which joint")]
    MissingJoint {
        /// The text.
        text: String,
        /// The effect.
        id: &'static str,
    },
}

impl Reason for PathReason {
    fn remedy(&self) -> Cow<'_, str> {
        let key = |text: &'_ String| text.split_once('.').map_or("", |(_, key)| key).to_string();
        Cow::Owned(match self {
            PathReason::NoParameter { .. } => {
                "write it as `link1.mass_kg`, `joint1.gain_per_rad` or `coulomb@1.torque_nm`".into()
            }
            PathReason::UnknownName { name, known, .. } => suggest(name, known),
            PathReason::NotOfRobot { name, known, .. } => suggest(name, known),
            PathReason::NoJoint { .. } => "joints count from 1; `all` are the driven ones".into(),
            PathReason::WholeRig { text, id } => format!("write `{id}.{}`", key(text)),
            PathReason::MissingJoint { text, id } => {
                format!("write `{id}@1.{}` for the first joint", key(text))
            }
        })
    }
}
