//! Laws every effect must keep, and values of those with a corner or a memory.

use super::signature::off_values;
use super::*;
use crate::dynamics::ChainLink;
use std::collections::HashSet;

/// Units and what a key of that unit ends in.
const SUFFIXES: &[(&str, &str)] = &[
    ("s", "_s"),
    ("m", "_m"),
    ("kg", "_kg"),
    ("kg m^2", "_kg_m2"),
    ("rad", "_rad"),
    ("rad/s", "_rad_s"),
    ("N m", "_nm"),
    ("N m/rad", "_nm_rad"),
    ("N m s/rad", "_nm_s_rad"),
    ("N m s^2/rad^2", "_nm_s2_rad2"),
];

fn cards() -> impl Iterator<Item = &'static Card> {
    EFFECTS.iter().map(|effect| effect.card())
}

fn parameters() -> impl Iterator<Item = (&'static str, &'static Parameter)> {
    cards().flat_map(|card| card.parameters.iter().map(|parameter| (card.id, parameter)))
}

fn effect(id: &str) -> &'static dyn Effect {
    named(id).unwrap()
}

fn within((low, high): (f64, f64), value: f64) -> bool {
    (low..=high).contains(&value)
}

fn near(left: f64, right: f64) {
    assert!((left - right).abs() < 1e-12, "{left} is not {right}");
}

#[test]
fn ids_are_unique_and_snake_case() {
    let mut seen = HashSet::new();
    for card in cards() {
        assert!(seen.insert(card.id), "{} twice", card.id);
        let snake = |sign: char| sign.is_ascii_lowercase() || sign == '_';
        assert!(card.id.chars().all(snake), "{}", card.id);
    }
}

#[test]
fn sites_follow_the_chain_in_the_list() {
    let order = |card: &Card| card.site as usize;
    assert!(cards().is_sorted_by_key(order));
}

#[test]
fn keys_are_unique_and_say_their_unit() {
    for card in cards() {
        let keys: HashSet<_> = card
            .parameters
            .iter()
            .map(|parameter| parameter.key)
            .collect();
        assert_eq!(keys.len(), card.parameters.len(), "{}", card.id);
    }
    for (id, parameter) in parameters() {
        let ending = SUFFIXES
            .iter()
            .filter(|(_, suffix)| parameter.key.ends_with(suffix));
        let said = ending
            .max_by_key(|(_, suffix)| suffix.len())
            .map_or("1", |(unit, _)| *unit);
        assert_eq!(said, parameter.unit, "{id} {}", parameter.key);
    }
}

#[test]
fn values_lie_within_bounds() {
    for (id, parameter) in parameters() {
        let key = parameter.key;
        assert!(!parameter.starts.is_empty(), "{id} {key}");
        assert!(parameter.typical.0 < parameter.typical.1, "{id} {key}");
        let mut values = vec![parameter.typical.0, parameter.typical.1];
        values.extend(parameter.starts);
        values.extend(parameter.off.filter(|off| off.is_finite()));
        for value in values {
            assert!(within(parameter.bounds, value), "{id} {key}: {value}");
        }
    }
}

#[test]
fn every_effect_can_be_switched_off() {
    for card in cards() {
        assert!(
            card.parameters
                .iter()
                .any(|parameter| parameter.off.is_some()),
            "{}",
            card.id
        );
    }
}

#[test]
fn a_fit_does_not_start_at_off() {
    for card in cards() {
        let main = &card.parameters[0];
        assert!(
            main.starts.iter().all(|start| Some(*start) != main.off),
            "{}",
            card.id
        );
    }
}

#[test]
fn confusions_are_known_and_mutual() {
    for card in cards() {
        for confusion in card.confused_with {
            assert_ne!(confusion.with, card.id);
            let other = named(confusion.with).expect(confusion.with).card();
            let back = other
                .confused_with
                .iter()
                .any(|confusion| confusion.with == card.id);
            assert!(back, "{} names {}, not the reverse", card.id, other.id);
        }
    }
}

#[test]
fn every_text_is_filled_in() {
    for card in cards() {
        let texts = [
            card.title,
            card.law,
            card.looks_like,
            card.experiment,
            card.reference,
        ];
        assert!(texts.iter().all(|text| text.len() > 3), "{}", card.id);
        assert!(
            !texts.iter().any(|text| text.contains("  ")),
            "{}: two blanks",
            card.id
        );
    }
}

const SPEEDS_RAD_S: [f64; 5] = [-7.0, -0.3, 0.0, 0.01, 4.0];

#[test]
fn off_is_identity_for_commands_and_drives() {
    for effect in EFFECTS {
        let (id, off) = (effect.card().id, off_values(*effect));
        assert_eq!(effect.delay_s(&off), 0.0, "{id}");
        for duty in [-1.0, -0.2, 0.0, 0.001, 1.0] {
            assert_eq!(effect.command(&off, duty), duty, "{id}");
            for speed_rad_s in SPEEDS_RAD_S {
                let at = DriveState {
                    speed_rad_s,
                    duty,
                    full_torque_nm: 1.5,
                    supply_ratio: 0.8,
                };
                assert_eq!(effect.drive(&off, 1.5 * duty, &at), 1.5 * duty, "{id}");
            }
        }
    }
}

#[test]
fn off_leaves_no_torque() {
    for effect in EFFECTS {
        let (id, off) = (effect.card().id, off_values(*effect));
        for speed_rad_s in SPEEDS_RAD_S {
            let joint = JointState {
                angle_rad: 0.7,
                speed_rad_s,
                drive_nm: 0.0,
                shuffled_rad_s: 0.0,
            };
            assert_eq!(effect.torque(&off, &joint), 0.0, "{id}");
            assert_eq!(effect.friction(&off, &slide(speed_rad_s, 1.0)), 0.0, "{id}");
        }
    }
}

#[test]
fn off_reads_the_angle_itself() {
    for effect in EFFECTS {
        let (id, off) = (effect.card().id, off_values(*effect));
        let mut memory = None;
        for angle_rad in [0.3, 0.31, -1.0, -1.0, 2.0] {
            assert_eq!(effect.encode(&off, angle_rad), angle_rad, "{id}");
            assert_eq!(
                effect.sense(&off, &mut memory, angle_rad, 0.01),
                angle_rad,
                "{id}"
            );
        }
    }
}

#[test]
fn off_leaves_the_rig_alone() {
    for effect in EFFECTS {
        let mut changed = rig();
        effect.body(&off_values(*effect), 0, &mut changed);
        assert_eq!(
            format!("{changed:?}"),
            format!("{:?}", rig()),
            "{}",
            effect.card().id
        );
    }
}

#[test]
fn the_first_reading_is_the_angle() {
    for effect in EFFECTS.iter().filter(|effect| {
        effect.card().site != Site::Timing
            && matches!(effect.card().site, Site::Encoder | Site::Sensor)
    }) {
        let values: Vec<f64> = effect
            .card()
            .parameters
            .iter()
            .map(|p| p.typical.1)
            .collect();
        assert_eq!(
            effect.sense(&values, &mut None, 0.4, 0.01),
            0.4,
            "{}",
            effect.card().id
        );
    }
}

#[test]
fn friction_resists_except_for_the_asymmetry() {
    let frictions = EFFECTS
        .iter()
        .filter(|effect| effect.card().site == Site::Friction);
    for effect in frictions.filter(|effect| effect.card().id != "direction_asymmetry") {
        for end in [|p: &Parameter| p.typical.0, |p: &Parameter| p.typical.1] {
            let values: Vec<f64> = effect.card().parameters.iter().map(end).collect();
            for direction in [-1.0, 1.0] {
                for speed_rad_s in SPEEDS_RAD_S {
                    let friction_nm = effect.friction(&values, &slide(speed_rad_s, direction));
                    assert!(friction_nm >= 0.0, "{}", effect.card().id);
                }
            }
        }
    }
}

#[test]
fn passive_torques_take_energy() {
    for id in ["viscous", "air_drag"] {
        for speed_rad_s in SPEEDS_RAD_S {
            let joint = JointState {
                angle_rad: 0.7,
                speed_rad_s,
                drive_nm: 0.0,
                shuffled_rad_s: 0.0,
            };
            assert!(
                effect(id).torque(&[0.02], &joint) * speed_rad_s <= 0.0,
                "{id}"
            );
        }
    }
}

#[test]
fn the_dead_zone_swallows_and_punches() {
    let zone = |punch, duty| effect("dead_zone").command(&[0.1, punch], duty);
    assert_eq!(
        [zone(0.0, 0.1), zone(0.0, -0.05), zone(0.0, 0.2)],
        [0.0, 0.0, 0.2]
    );
    near(zone(0.05, -0.2), -0.25);
    assert_eq!(zone(-0.3, 0.2), 0.0, "never reversed");
    assert_eq!(zone(0.05, -1.0), -1.0, "never beyond full range");
}

#[test]
fn drives_weaken_as_their_laws_say() {
    let at = DriveState {
        speed_rad_s: 3.0,
        duty: 0.5,
        full_torque_nm: 1.5,
        supply_ratio: 0.9,
    };
    let drive = |id, value| effect(id).drive(&[value], 0.75, &at);
    near(drive("supply_sensitivity", 1.0), 0.675);
    near(drive("supply_sag", 0.2), 0.675);
    near(drive("torque_scale", 1.2), 0.9);
    near(drive("speed_limit", 6.0), 0.0);
    near(drive("torque_saturation", 0.3), 0.3);
    near(effect("torque_saturation").drive(&[0.3], -0.75, &at), -0.3);
}

#[test]
fn stiction_fades_with_speed() {
    let excess = |speed_rad_s| effect("stribeck").friction(&[0.1, 0.2], &slide(speed_rad_s, 1.0));
    near(excess(0.0), 0.1);
    near(excess(0.2), 0.1 * (-1.0_f64).exp());
}

#[test]
fn load_and_direction_set_friction() {
    near(
        effect("load_friction").friction(&[0.1], &slide(1.0, 1.0)),
        0.05,
    );
    near(
        effect("bearing_friction").friction(&[1e-3], &slide(1.0, 1.0)),
        4e-3,
    );
    near(
        effect("direction_asymmetry").friction(&[0.01], &slide(1.0, -1.0)),
        -0.01,
    );
}

#[test]
fn springs_and_ripples_depend_on_the_angle() {
    let joint = JointState {
        angle_rad: 0.5,
        speed_rad_s: 9.0,
        drive_nm: 0.0,
        shuffled_rad_s: 0.0,
    };
    near(effect("cable_spring").torque(&[0.2, 0.1], &joint), -0.08);
    near(
        effect("cogging").torque(&[0.2, 4.0, 0.1], &joint),
        0.2 * 2.1_f64.sin(),
    );
}

#[test]
fn bodies_change_as_their_laws_say() {
    let changed = |id, value: f64| {
        let mut rig = rig();
        effect(id).body(&[value], 0, &mut rig);
        rig
    };
    near(changed("com_angle", 0.1).chain.links[0].com_angle_rad, 0.15);
    near(
        changed("armature", 1e-3).chain.links[0].armature_kg_m2,
        3e-3,
    );
    let heavier = changed("mass", 0.2).chain.links.remove(0);
    near(heavier.mass_kg, 0.6);
    near(heavier.inertia_kg_m2, 1.2e-3);
    assert!(changed("mass", -1.0).chain.links[0].mass_kg > 0.0);
    near(changed("base_tilt", 0.1).gravity_turn_rad, 0.1);
    let mut turned = Rig {
        turned: true,
        ..rig()
    };
    effect("base_tilt").body(&[0.1], 0, &mut turned);
    near(turned.gravity_turn_rad, -0.1);
}

#[test]
fn encoders_read_scale_times_angle_plus_zero() {
    near(effect("encoder_scale").encode(&[1.02], 0.5), 0.51);
    near(effect("encoder_zero").encode(&[0.02], 0.5), 0.52);
}

#[test]
fn play_trails_by_half_the_gap_after_each_reversal() {
    let mut memory = None;
    let mut read = |angle_rad| effect("backlash").sense(&[0.1], &mut memory, angle_rad, 0.01);
    near(read(0.0), 0.0);
    near(read(0.04), 0.0);
    near(read(0.5), 0.45);
    near(read(0.41), 0.45);
    near(read(-0.5), -0.45);
    near(read(-0.42), -0.45);
    near(read(0.5), 0.45);
}

/// Readings of a lag of `constant_s` over a motion sampled `rate_hz` times a second.
fn lagged(constant_s: f64, rate_hz: usize, end_s: f64, angle: impl Fn(f64) -> f64) -> f64 {
    let step_s = 1.0 / rate_hz as f64;
    let steps = (end_s * rate_hz as f64).round() as usize;
    let mut memory = None;
    let read = |step| {
        effect("sensor_lag").sense(
            &[constant_s],
            &mut memory,
            angle(step as f64 * step_s),
            step_s,
        )
    };
    (0..=steps).map(read).last().unwrap()
}

#[test]
fn a_lag_trails_a_ramp_by_its_time_constant() {
    near(
        lagged(0.05, 100, 2.0, |time_s| 3.0 * time_s),
        3.0 * (2.0 - 0.05),
    );
}

#[test]
fn a_lag_of_a_ramp_is_exact_at_any_step() {
    let exact = 0.3 - 0.1 + 0.1 * (-3.0_f64).exp();
    for rate_hz in [10, 100, 1000] {
        near(lagged(0.1, rate_hz, 0.3, |time_s| time_s), exact);
    }
}

#[test]
fn a_lag_of_a_sine_is_second_order_accurate() {
    let sine = |time_s: f64| (10.0 * time_s).sin();
    let truth = lagged(0.05, 10_000, 1.0, sine);
    let error = |rate_hz| (lagged(0.05, rate_hz, 1.0, sine) - truth).abs();
    let ratio = error(50) / error(100);
    assert!(
        (3.5..4.5).contains(&ratio),
        "half the step leaves 1/{ratio} of the error"
    );
}

fn slide(speed_rad_s: f64, direction: f64) -> Slide {
    Slide {
        speed_rad_s: speed_rad_s.abs(),
        direction,
        gear_load_nm: 0.5,
        bearing_load_n: 4.0,
    }
}

fn rig() -> Rig {
    let link = ChainLink {
        length_m: 0.15,
        com_m: 0.12,
        com_angle_rad: 0.05,
        mass_kg: 0.4,
        inertia_kg_m2: 8e-4,
        armature_kg_m2: 2e-3,
    };
    let chain = Chain {
        links: vec![link],
        gravity_m_s2: 9.81,
    };
    Rig {
        chain,
        gravity_turn_rad: 0.0,
        turned: false,
    }
}
