//! An effect that is off changes nothing, and friction only resists.

use super::*;

const SPEEDS_RAD_S: [f64; 5] = [-7.0, -0.3, 0.0, 0.01, 4.0];

#[test]
fn off_is_identity_for_commands_and_drives() {
    for effect in EFFECTS {
        let (id, off) = (effect.info().id, off_values(*effect));
        assert_eq!(effect.delay_s(&off), 0.0, "{id}");
        for duty in [-1.0, -0.2, 0.0, 0.001, 1.0] {
            assert_eq!(effect.command(&off, duty), duty, "{id}");
            for speed_rad_s in SPEEDS_RAD_S {
                let at = DriveState {
                    speed_rad_s,
                    duty,
                    full_torque_nm: 1.5,
                    supply_ratio: 0.8,
                    memory: MemoryCell::EMPTY,
                };
                assert_eq!(effect.drive(&off, 1.5 * duty, &at), 1.5 * duty, "{id}");
            }
        }
    }
}

#[test]
fn off_leaves_no_torque() {
    for effect in EFFECTS {
        let (id, off) = (effect.info().id, off_values(*effect));
        for speed_rad_s in SPEEDS_RAD_S {
            let joint = JointState::undriven(0.7, speed_rad_s);
            assert_eq!(effect.torque(&off, &joint), 0.0, "{id}");
            assert_eq!(effect.friction(&off, &slide(speed_rad_s, 1.0)), 0.0, "{id}");
        }
    }
}

#[test]
fn off_reads_the_angle_itself() {
    for effect in EFFECTS {
        let (id, off) = (effect.info().id, off_values(*effect));
        assert_eq!(effect.reading_offset_s(&off).unwrap_or(0.0), 0.0, "{id}");
        let mut memory = None;
        for angle_rad in [0.3, 0.31, -1.0, -1.0, 2.0] {
            assert_eq!(effect.encode(&off, angle_rad), angle_rad, "{id}");
            assert_eq!(
                effect.sense(&off, &mut memory, Encoded::still(angle_rad), 0.01),
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
            effect.info().id
        );
    }
}

#[test]
fn the_first_reading_is_the_angle() {
    for effect in EFFECTS.iter().filter(|effect| {
        effect.info().site != Site::Timing
            && matches!(
                effect.info().site,
                Site::Encoder | Site::Sensor | Site::Rate
            )
    }) {
        let values: Vec<f64> = effect
            .info()
            .parameters
            .iter()
            .map(|p| p.typical.1)
            .collect();
        assert_eq!(
            effect.sense(&values, &mut None, Encoded::still(0.4), 0.01),
            0.4,
            "{}",
            effect.info().id
        );
    }
}

#[test]
fn friction_resists_except_for_the_asymmetry() {
    let frictions = EFFECTS
        .iter()
        .filter(|effect| effect.info().site == Site::Friction);
    for effect in frictions.filter(|effect| effect.info().id != "direction_asymmetry") {
        for end in [|p: &Parameter| p.typical.0, |p: &Parameter| p.typical.1] {
            let values: Vec<f64> = effect.info().parameters.iter().map(end).collect();
            for direction in [-1.0, 1.0] {
                for speed_rad_s in SPEEDS_RAD_S {
                    let friction_nm = effect.friction(&values, &slide(speed_rad_s, direction));
                    assert!(friction_nm >= 0.0, "{}", effect.info().id);
                }
            }
        }
    }
}

#[test]
fn passive_torques_take_energy() {
    for id in ["viscous", "air_drag"] {
        for speed_rad_s in SPEEDS_RAD_S {
            let joint = JointState::undriven(0.7, speed_rad_s);
            assert!(
                effect(id).torque(&[0.02], &joint) * speed_rad_s <= 0.0,
                "{id}"
            );
        }
    }
}
