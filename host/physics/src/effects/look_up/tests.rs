use super::*;

fn ids(effects: &[Effect]) -> Vec<&'static str> {
    effects.iter().map(|effect| effect.info().id).collect()
}

/// Ids of the effects that bear the name.
fn called(name: &str) -> Vec<&'static str> {
    match look_up(name) {
        NameMatch::One(effect) => ids(&[effect]),
        NameMatch::Several(effects) => ids(&effects),
        NameMatch::Similar(_) => Vec::new(),
    }
}

/// What textbooks and data sheets call each effect (Armstrong-Helouvry, de Wit, Olsson, Spong,
/// Slotine; MuJoCo, MATLAB). Written down here apart from the aliases.
const TEXTBOOK: &[(&str, &[&str])] = &[
    ("delay", &["latency", "dead time", "lag", "time delay"]),
    ("slew_limit", &["slew rate", "rate limiter"]),
    ("drive_lag", &["current loop", "activation filter"]),
    ("dead_zone", &["deadband", "dead-zone", "dead band"]),
    ("supply_sensitivity", &["battery voltage"]),
    ("supply_sag", &["voltage drop"]),
    ("torque_scale", &["torque constant", "Kt"]),
    (
        "speed_limit",
        &["BackEMF", "back-emf", "back EMF", "no-load speed"],
    ),
    ("torque_saturation", &["saturation", "torque limit"]),
    ("thermal_drift", &["heating", "temperature"]),
    ("fold_back", &["foldback", "current limit"]),
    (
        "gear_compliance",
        &[
            "elasticity",
            "joint elasticity",
            "flexible joint",
            "stiffness",
        ],
    ),
    (
        "gear_backlash",
        &["play", "backlash of the gear", "lash", "hysteresis"],
    ),
    (
        "coulomb",
        &[
            "Coulomb friction",
            "dry friction",
            "frictionloss",
            "friction",
        ],
    ),
    (
        "stribeck",
        &[
            "stiction",
            "static friction",
            "Stribeck effect",
            "break-away",
        ],
    ),
    ("load_friction", &["gear friction", "efficiency"]),
    ("drive_asymmetry", &["backdrivability", "self-locking"]),
    ("bearing_friction", &["plain bearing", "friction"]),
    ("direction_asymmetry", &["asymmetric friction"]),
    ("position_friction", &["position-dependent friction"]),
    (
        "viscous",
        &["viscous damping", "damping", "viscous friction"],
    ),
    (
        "air_drag",
        &["drag", "air resistance", "aerodynamic drag", "damping"],
    ),
    ("cable_spring", &["spring", "cable"]),
    (
        "cogging",
        &["cogging torque", "torque ripple", "detent torque"],
    ),
    ("torque_offset", &["bias", "constant disturbance"]),
    (
        "pre_sliding",
        &["presliding", "Dahl", "LuGre", "bristle", "hysteresis"],
    ),
    ("com_angle", &["COM offset", "imbalance"]),
    ("mass", &["payload", "Mass"]),
    (
        "armature",
        &["rotor inertia", "reflected inertia", "Armature"],
    ),
    ("base_tilt", &["tilt", "gravity direction"]),
    ("base_compliance", &["compliance", "moving base"]),
    ("encoder_scale", &["sensor gain", "scale factor"]),
    (
        "encoder_zero",
        &["encoder offset", "calibration offset", "offset"],
    ),
    ("grip_slip", &["slip", "slippage"]),
    ("backlash", &["play", "lost motion", "hysteresis"]),
    ("sensor_lag", &["lag", "low-pass filter", "phase lag"]),
    ("time_offset", &["latency", "clock offset", "time shift"]),
    ("rate_scale", &["gyro scale"]),
    ("rate_bias", &["gyro bias", "gyro drift"]),
    ("rate_lag", &["gyro filter", "lag"]),
];

#[test]
fn textbook_names_find_every_effect() {
    for effect in EFFECTS {
        let id = effect.info().id;
        let known = TEXTBOOK.iter().find(|(known, _)| *known == id);
        let (_, names) = known.unwrap_or_else(|| panic!("{id} has no textbook name here"));
        for name in names.iter().chain([&id, &effect.info().title]) {
            let found = match look_up(name) {
                NameMatch::Similar(effects) => ids(&effects),
                _ => called(name),
            };
            assert!(found.contains(&id), "{name} finds {found:?}, not {id}");
        }
    }
}

#[test]
fn a_name_of_one_effect_means_it_and_a_word_of_several_lists_them() {
    for (name, meant) in [
        ("stiction", &["stribeck"][..]),
        ("drag", &["air_drag"]),
        ("BackEMF", &["speed_limit"]),
        ("deadband", &["dead_zone"]),
        ("rotor inertia", &["armature"]),
        ("rotor", &["armature"]),
        ("wind", &["air_drag"]),
        ("sag", &["supply_sag"]),
        ("elastic", &["gear_compliance"]),
        ("flex", &["gear_compliance"]),
        ("hose", &["cable_spring"]),
        ("play", &["gear_backlash", "backlash"]),
        ("damping", &["viscous", "air_drag"]),
        ("latency", &["delay", "time_offset"]),
        ("lag", &["delay", "drive_lag", "sensor_lag", "rate_lag"]),
    ] {
        assert_eq!(called(name), meant, "{name}");
    }
    assert!(called("friction").len() >= 8, "{:?}", called("friction"));
}

#[test]
fn an_id_is_never_another_effects_name() {
    // `backlash` is the id of one effect and a word in the title of another.
    for effect in EFFECTS {
        assert_eq!(called(effect.info().id), [effect.info().id]);
    }
}

#[test]
fn aliases_are_said_once_and_are_neither_id_nor_title() {
    for effect in EFFECTS {
        let info = effect.info();
        assert!(!info.aliases.is_empty(), "{} has no alias", info.id);
        let mut seen = vec![squeezed(info.id), squeezed(info.title)];
        for alias in info.aliases {
            let alias = squeezed(alias);
            assert!(!seen.contains(&alias), "{}: {alias} twice", info.id);
            seen.push(alias);
        }
    }
}

#[test]
fn what_no_effect_is_called_is_searched_and_nonsense_finds_nothing() {
    let similar = |name: &str| match look_up(name) {
        NameMatch::Similar(effects) => ids(&effects),
        found => panic!("{name}: {found:?}"),
    };
    // Words of titles and aliases, in any order and number.
    assert_eq!(similar("ripple of the gears"), ["cogging"]);
    assert!(similar("bearing").contains(&"bearing_friction"));
    // A word that only a law holds.
    assert_eq!(similar("clipped"), ["torque_saturation"]);
    // A slip of the keyboard.
    assert_eq!(similar("colomb"), ["coulomb"]);
    assert!(similar("frction").len() >= 8, "{:?}", similar("frction"));
    for nonsense in ["", "@", "xyzzy", "of the", "teleportation", "frobnicate"] {
        assert!(
            similar(nonsense).is_empty(),
            "{nonsense}: {:?}",
            similar(nonsense)
        );
    }
}
