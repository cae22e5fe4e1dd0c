//! What effects are called in sentences.

use super::findings::FittedEffect;
use crate::effects;

/// "Coulomb friction at joint 1".
pub(crate) fn effect_name(effect: &FittedEffect) -> String {
    at_joint(&effect.kind, &effect.title, effect.joint)
}

/// "Coulomb friction at joint 1", "delay of the drive at all driven joints", "tilt of the base".
pub(crate) fn at_joint(kind: &str, title: &str, joint: Option<usize>) -> String {
    match (joint, effects::at_all(kind)) {
        (Some(joint), _) => format!("{title} at joint {joint}"),
        (None, "") => title.to_string(),
        (None, _) => format!("{title} at all driven joints"),
    }
}

/// Effects in a row: "A at joint 1, B and C".
pub(crate) fn joined(effects: &[FittedEffect]) -> String {
    listed(effects.iter().map(effect_name).collect())
}

pub(crate) fn listed(mut names: Vec<String>) -> String {
    match (names.pop(), names.as_slice()) {
        (None, _) => "nothing".into(),
        (Some(last), []) => last,
        (Some(last), rest) => format!("{} and {last}", rest.join(", ")),
    }
}
