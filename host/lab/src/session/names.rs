//! Effects and values by names for people: "Coulomb friction at joint 1", "mass of link 1".

pub use crate::diagnose::names::listed;
use crate::effects::split_unit;
use crate::effects::{Effect, named};
use crate::model::ParameterPath;

/// An effect and its joint, counted from 0, of an address such as `coulomb@1`.
pub fn effect_of(address: &str) -> Option<(Effect, Option<usize>)> {
    let (id, joint) = match address.split_once('@') {
        Some((id, "all")) => (id, None),
        Some((id, joint)) => (id, Some(joint.parse::<usize>().ok()?.checked_sub(1)?)),
        None => (address, None),
    };
    Some((named(id)?, joint))
}

/// "Coulomb friction at joint 1"; the address itself where it is of no known effect.
pub fn effect_name(address: &str) -> String {
    match effect_of(address) {
        Some((effect, Some(joint))) => format!("{} at joint {}", effect.info().title, joint + 1),
        Some((effect, None)) => effect.info().title.to_string(),
        None => address.to_string(),
    }
}

/// "mass of link 1", "torque of Coulomb friction at joint 1"; the address itself where it is none.
pub fn value_name(address: &str) -> String {
    let Ok(path) = address.parse::<ParameterPath>() else {
        return address.to_string();
    };
    let key = path.key();
    let stem = split_unit(key).map_or(key, |(stem, _)| stem);
    let stem = match stem {
        "com" => "centre of mass".to_string(),
        stem => stem.replace('_', " "),
    };
    match path {
        ParameterPath::Link { index, .. } => format!("{stem} of link {}", index + 1),
        ParameterPath::Joint { index, .. } => format!("{stem} of joint {}", index + 1),
        ParameterPath::Effect { .. } => {
            let effect = address
                .split_once('.')
                .map_or(address, |(effect, _)| effect);
            format!("{stem} of {}", effect_name(effect))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_become_names() {
        for (address, name) in [
            ("link1.mass_kg", "mass of link 1"),
            ("link2.com_m", "centre of mass of link 2"),
            ("joint1.stall_torque_nm", "stall torque of joint 1"),
            (
                "coulomb@1.torque_nm",
                "torque of Coulomb friction at joint 1",
            ),
            ("no such thing", "no such thing"),
        ] {
            assert_eq!(value_name(address), name, "{address}");
        }
        assert_eq!(effect_name("coulomb@2"), "Coulomb friction at joint 2");
        assert_eq!(effect_name("steam@1"), "steam@1");
    }
}
