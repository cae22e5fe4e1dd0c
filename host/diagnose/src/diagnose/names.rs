//! What effects and values are called in sentences.

use super::findings::FittedEffect;
use crate::effects;
use crate::model::{JointField, LinkField, ParameterPath};

/// "Coulomb friction at joint 1".
pub fn effect_name(effect: &FittedEffect) -> String {
    at_joint(&effect.kind, &effect.title, effect.joint)
}

/// "Coulomb friction at joint 1", "delay of the drive at all driven joints", "tilt of the base".
pub fn at_joint(kind: &str, title: &str, joint: Option<usize>) -> String {
    match (joint, effects::at_all(kind)) {
        (Some(joint), _) => format!("{title} at joint {joint}"),
        (None, "") => title.to_string(),
        (None, _) => format!("{title} at all driven joints"),
    }
}

/// A value of the model by its address, in words: "the inertia of link 1", "viscous friction at
/// joint 1", "gap_rad of backlash of the gear at joint 1"; the text itself where it is no address.
pub fn value_name(path: &str) -> String {
    match path.parse() {
        Ok(ParameterPath::Link { index, field }) => {
            let what = match field {
                LinkField::Length => "length",
                LinkField::Com => "centre-of-mass distance",
                LinkField::Mass => "mass",
                LinkField::Inertia => "inertia",
            };
            format!("the {what} of link {}", index + 1)
        }
        Ok(ParameterPath::Joint { index, field }) => {
            let what = match field {
                JointField::StallTorque => "stall torque",
                JointField::StallForce => "stall force",
                JointField::NoLoadSpeed | JointField::NoLoadLinearSpeed => "no-load speed",
                JointField::GainPerRad
                | JointField::GainSPerRad
                | JointField::GainPerM
                | JointField::GainSPerM => "gain",
            };
            format!("the {what} of joint {}", index + 1)
        }
        Ok(path @ ParameterPath::Effect { id, joint, .. }) => {
            let Some(info) = effects::named(id).map(|effect| effect.info()) else {
                return path.to_string();
            };
            let name = at_joint(id, info.title, joint.map(|joint| joint + 1));
            match info.parameters {
                [_] => name,
                _ => format!("{} of {name}", path.key()),
            }
        }
        Err(_) => path.to_string(),
    }
}

/// Effects in a row: "A at joint 1, B and C".
pub(crate) fn joined(effects: &[FittedEffect]) -> String {
    listed(effects.iter().map(effect_name).collect())
}

/// Names in a row: "A, B and C".
pub fn listed(mut names: Vec<String>) -> String {
    match (names.pop(), names.as_slice()) {
        (None, _) => "nothing".into(),
        (Some(last), []) => last,
        (Some(last), rest) => format!("{} and {last}", rest.join(", ")),
    }
}
