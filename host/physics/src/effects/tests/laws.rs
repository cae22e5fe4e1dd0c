//! Laws of drives, friction, joints and bodies.

use super::*;

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
fn the_mean_over_a_dead_zones_edge_is_that_of_its_law() {
    let zone = effect("dead_zone");
    for punch in [-0.05, 0.0, 0.03] {
        for (duty, spread) in [
            (0.1, 0.02),
            (-0.12, 0.05),
            (0.03, 0.3),
            (0.5, 0.1),
            (0.05, 0.01),
        ] {
            let at = |k: i32| duty + spread * (f64::from(2 * k + 1) / 1e4 - 1.0);
            let law = (0..10_000).map(|k| zone.command(&[0.1, punch], at(k)));
            let mean = zone.mean_command(&[0.1, punch], duty, spread);
            let off = mean - law.sum::<f64>() / 1e4;
            assert!(off.abs() < 1e-4, "{punch} {duty} {spread}: {off}");
        }
        let jump = zone.command_jump(&[0.1, punch]);
        let above = zone.command(&[0.1, punch], 0.1 + 1e-12);
        assert!((jump - above).abs() < 1e-9, "{punch}: {jump} {above}");
    }
}

#[test]
fn drives_weaken_as_their_laws_say() {
    let at = DriveState {
        speed_rad_s: 3.0,
        duty: 0.5,
        full_torque_nm: 1.5,
        supply_ratio: 0.9,
        memory: MemoryCell::EMPTY,
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
        effect("drive_asymmetry").friction(&[0.1, 0.4], &slide(1.0, 1.0)),
        0.11,
    );
    near(
        effect("drive_asymmetry").friction(&[0.1, 0.1], &slide(1.0, 1.0)),
        effect("load_friction").friction(&[0.1], &slide(1.0, 1.0)),
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
    let joint = JointState::undriven(0.5, 9.0);
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
    let mut yielding = rig();
    effect("base_compliance").body(&[800.0, 2.0, 0.1], 0, &mut yielding);
    let base = yielding.base_spring.unwrap();
    near(base.natural_rad_s(), 20.0);
    // 800 * 0.01 + 2 * 0.1 * 2 * 20 * 0.5
    near(base.force_n(0.01, 0.5), -12.0);
    let stiff = BaseSpring::new(2.0, 1e7, 0.1).unwrap();
    near(stiff.natural_rad_s(), 400.0);
    let mut turned = Rig {
        turned: true,
        ..rig()
    };
    effect("base_tilt").body(&[0.1], 0, &mut turned);
    near(turned.gravity_turn_rad, -0.1);
}

#[test]
fn friction_called_constant_is_that_and_no_other() {
    for effect in EFFECTS.iter().filter(|e| e.info().site == Site::Friction) {
        let values: Vec<f64> = effect
            .info()
            .parameters
            .iter()
            .map(|p| p.typical.1)
            .collect();
        let at = |angle_rad, speed_rad_s, gear_load_nm, bearing_load_n| {
            let slide = FrictionState {
                angle_rad,
                speed_rad_s,
                direction: 1.0,
                gear_load_nm,
                motor_nm: gear_load_nm,
                outside_nm: 0.0,
                bearing_load_n,
                signals: Signals::NONE,
            };
            effect.friction(&values, &slide)
        };
        let rest = at(0.0, 0.0, 0.0, 0.0);
        let changes = [
            (0.3, 0.0, 0.0, 0.0),
            (0.0, 0.05, 0.0, 0.0),
            (0.0, 3.0, 0.0, 0.0),
            (0.0, 0.0, 1.0, 0.0),
            (0.0, 0.0, 0.0, 1.0),
        ]
        .into_iter()
        .any(|(angle, speed, gear, bearing)| at(angle, speed, gear, bearing) != rest);
        assert_eq!(
            effect.friction_is_constant(),
            !changes,
            "{}",
            effect.info().id
        );
    }
}
