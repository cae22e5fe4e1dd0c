use super::super::NotCarried;
use super::crane::{Crane, MJCF, URDF};
use super::robot_file;
use crate::dynamics::{SpatialEquations, SpatialWorkspace};
use crate::model::Model;
use std::path::Path;

/// The largest difference of accelerations at states that a sine draws, as a share of the largest.
fn off(own: &Model, other: &Model) -> f64 {
    let accelerations = |model: &Model, number: usize| {
        let tree = model.rig(false).tree.unwrap();
        let n = tree.len();
        let many = |size: f64, from: usize| -> Vec<f64> {
            let at = |joint: usize| (7.3 * (joint + n * (from + 3 * number)) as f64).sin();
            (0..n).map(|joint| size * at(joint)).collect()
        };
        let (q, dq, tau) = (many(3.0, 0), many(5.0, 1), many(4.0, 2));
        let mut out = vec![0.0; n];
        let mut work = SpatialWorkspace::default();
        let held = vec![false; n];
        SpatialEquations::new(&tree).forward(&mut work, [&q, &dq, &tau], &held, &mut out);
        out
    };
    let mut worst = 0.0f64;
    for number in 0..20 {
        let (own, other) = (accelerations(own, number), accelerations(other, number));
        let size = own.iter().fold(1.0, |most: f64, a| most.max(a.abs()));
        let off = own.iter().zip(&other).map(|(a, b)| (a - b).abs() / size);
        worst = off.fold(worst, f64::max);
    }
    worst
}

fn parts(missing: &[NotCarried]) -> Vec<&str> {
    missing.iter().map(|part| part.part.as_str()).collect()
}

#[test]
fn an_unchanged_import_is_its_own_file_byte_for_byte() {
    for (text, driven) in [(URDF, false), (URDF, true), (MJCF, false), (MJCF, true)] {
        let locked = [("grip", 0.5)];
        let locked = if text == URDF { &locked[..] } else { &[] };
        let crane = Crane::of(text, locked, driven);
        let model = crane.model();
        let (exported, missing, read) = crane.exported(&model);
        assert_eq!(exported, text);
        assert_eq!(read.links, model.links);
        assert_eq!(read.joints, model.joints);
        assert_eq!(read.effects, model.effects);
        let worst = off(&model, &read);
        assert!(worst < 1e-12, "{worst}");
        let told = parts(&missing);
        match text {
            URDF => assert_eq!(told, ["lock of grip"]),
            _ => assert_eq!(told, ["position", "speed"]),
        }
    }
}

#[test]
fn changed_masses_of_links_of_several_bodies_are_those_of_a_fresh_import() {
    for (text, locked) in [(URDF, &[("grip", 0.5)][..]), (MJCF, &[])] {
        let crane = Crane::of(text, locked, true);
        let mut model = crane.model();
        let last = model.links.len() - 1;
        model.links[0].mass_kg *= 1.7;
        model.links[1].com_m *= -0.8;
        model.links[last].inertia_kg_m2 *= 1.3;
        model.links[last].mass_kg *= 0.6;
        model.links[last].com_m *= 1.4;
        model.add_effect("mass", last, vec![0.2]);
        model.add_effect("armature", 0, vec![0.03]);
        model
            .effects
            .retain(|e| e.name() != "armature@1" || e.values == [0.03]);
        model.gravity_m_s2 = if text == URDF { 9.81 } else { 3.7 };
        let (exported, missing, read) = crane.exported(&model);
        assert_ne!(exported, text);
        let mut wanted = model.clone();
        if text == URDF {
            wanted
                .effects
                .retain(|effect| effect.effect.info().id != "armature");
            assert_eq!(parts(&missing), ["lock of grip", "armature"]);
        }
        let worst = off(&wanted, &read);
        assert!(worst < 1e-9, "{worst}");
        assert!(off(&crane.model(), &read) > 1e-3);
    }
}

/// An effect's values at a joint, none where it is not there.
fn values<'a>(model: &'a Model, id: &str, joint: usize) -> Option<&'a [f64]> {
    let mut here = model.effects_at(joint);
    let found = here.find(|effect| effect.effect.info().id == id)?;
    Some(&found.values)
}

fn set(model: &mut Model, id: &str, joint: usize, values: Vec<f64>) {
    let is_own = |effect: &crate::model::EffectInstance| {
        effect.joint == Some(joint) && effect.effect.info().id == id
    };
    model.effects.retain(|effect| !is_own(effect));
    model.add_effect(id, joint, values);
}

#[test]
fn urdf_takes_damping_friction_and_effort_where_they_stand_or_are_to_stand() {
    let crane = Crane::of(URDF, &[("grip", 0.5)], true);
    let mut model = crane.model();
    set(&mut model, "viscous", 0, vec![0.25]);
    set(&mut model, "coulomb", 1, vec![0.125]);
    set(&mut model, "torque_saturation", 2, vec![6.5]);
    set(&mut model, "torque_saturation", 0, vec![2.0]);
    set(&mut model, "backlash", 1, vec![0.01]);
    model.gravity_m_s2 = 1.62;
    let (text, missing, read) = crane.exported(&model);
    let lines = |text: &str| text.lines().map(str::to_string).collect::<Vec<_>>();
    let changed: Vec<String> = (lines(&text).into_iter())
        .filter(|line| !lines(URDF).contains(line))
        .collect();
    assert_eq!(
        changed,
        [
            "  <axis xyz=\"0 0 1\"/><dynamics friction=\"0.2\" damping=\"0.25\"/></joint>",
            "  <dynamics friction=\"0.125\"/>",
            "  <axis xyz=\"1 0 0\"/><limit lower=\"0\" upper=\"1\" effort=\"6.5\" \
             velocity=\"0\"/></joint>",
        ]
    );
    assert_eq!(values(&read, "viscous", 0), Some(&[0.25][..]));
    assert_eq!(values(&read, "coulomb", 1), Some(&[0.125][..]));
    assert_eq!(values(&read, "torque_saturation", 2), Some(&[6.5][..]));
    let told: Vec<String> = (missing.iter())
        .map(|part| format!("{} {:?} {}", part.part, part.joint_name, part.why))
        .collect();
    assert_eq!(
        told,
        [
            "lock of grip None it is held at 0.5 here and stays a joint of the file",
            "gravity_m_s2 None gravity is the simulator's",
            "torque_saturation Some(\"slew\") its joint has no <limit> in the robot's file",
            "backlash Some(\"luff\") URDF has no place for it",
        ]
    );
}

#[test]
fn mjcf_takes_joints_actuators_and_gravity() {
    let crane = Crane::of(MJCF, &[], true);
    let mut model = crane.model();
    set(&mut model, "viscous", 0, vec![0.25]);
    set(&mut model, "cable_spring", 1, vec![3.0, 0.5]);
    set(&mut model, "armature", 2, vec![0.02]);
    set(&mut model, "torque_saturation", 3, vec![4.0]);
    for field in ["gain_per_rad", "stall_torque_nm", "no_load_speed_rad_s"] {
        change(&mut model, &format!("joint1.{field}"), 1.5);
    }
    let gain: crate::model::ParameterPath = "joint2.gain_s_per_rad".parse().unwrap();
    assert!(gain.set(&mut model, 0.0625));
    change(&mut model, "joint4.no_load_speed_m_s", 2.0);
    let (text, missing, read) = crane.exported(&model);
    for part in [
        "<joint name=\"slew\" axis=\"0 0 1\" armature=\"0.01\" damping=\"0.25\"/>",
        "class=\"arm\" kv=\"0.5\" kp=\"18.0\" forcerange=\"-3.0 3.0\"/>",
        "<velocity name='b' joint='luff' kv='0.1875' forcerange='-3 3'/>",
        "ctrlrange=\"-1 1\" forcerange=\"-4.0 4.0\"/>",
        "gainprm=\"5\" biastype=\"affine\" biasprm=\"0.0 0.0 -1.0\"",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(read.joints, model.joints);
    for joint in 0..4 {
        for id in [
            "viscous",
            "coulomb",
            "cable_spring",
            "armature",
            "torque_saturation",
        ] {
            let (own, read) = (values(&model, id, joint), values(&read, id, joint));
            let near = |a: &f64, b: &f64| (a - b).abs() < 1e-11;
            let same = match (own, read) {
                (Some(own), Some(read)) => own.iter().zip(read).all(|(a, b)| near(a, b)),
                (own, read) => own == read,
            };
            assert!(same, "{id} of {joint}: {own:?} {read:?}");
        }
    }
    assert_eq!(parts(&missing), ["position", "speed"]);
}

fn change(model: &mut Model, path: &str, by: f64) {
    let path: crate::model::ParameterPath = path.parse().unwrap();
    let value = path.get(model).unwrap();
    assert!(path.set(model, value * by));
}

/// A servo at a joint that the file does not drive becomes an actuator, the first of the file.
#[test]
fn a_joint_that_the_file_does_not_drive_gets_an_actuator() {
    let start = MJCF.find("  <actuator>").unwrap();
    let bare = format!("{}</mujoco>", &MJCF[..start]);
    for text in [bare.as_str(), MJCF] {
        let crane = Crane::of(text, &[], true);
        let mut model = crane.model();
        let motor = crate::model::Motor {
            stall_torque_nm: 2.5,
            no_load_speed_rad_s: 5.0,
            nominal_supply_v: Some(12.0),
        };
        model.joints[2].drive = crate::model::Drive::Position {
            gain_per_rad: 4.0,
            motor,
        };
        let (_, missing, read) = crane.exported(&model);
        let drive = &read.joints[2].drive;
        let motor = drive.motor().unwrap();
        assert_eq!(drive.name(), "position");
        assert_eq!(
            (motor.stall_torque_nm, motor.no_load_speed_rad_s),
            (2.5, 5.0)
        );
        assert!(parts(&missing).contains(&"nominal_supply_v"));
    }
}

#[test]
fn what_the_robots_file_sets_in_another_way_is_listed() {
    let from_shapes = MJCF.replace("<option", "<compiler inertiafromgeom=\"true\"/><option");
    let shapes = "<geom size=\".1\"/></body>".to_string();
    let from_shapes = from_shapes.replace("</body></body></body></body>", &shapes.repeat(4));
    let from_shapes = from_shapes.replace(
        "<inertial mass=\"0.5\"",
        "<geom size=\".1\"/><inertial mass=\"1\"",
    );
    let from_shapes = from_shapes.replace(
        "<inertial mass=\"2\"",
        "<geom size=\".1\"/><inertial mass=\"2\"",
    );
    let no_dampers = MJCF.replace(
        "<option gravity=\"0 0.5 -9.7\"/>",
        "<option><flag damper=\"disable\"/></option>",
    );
    for (text, path, wanted) in [
        (from_shapes.as_str(), "link1.mass_kg", "mass_kg"),
        (
            no_dampers.as_str(),
            "viscous@1.coefficient_nm_s_rad",
            "viscous",
        ),
    ] {
        let crane = Crane::of(text, &[], true);
        let mut model = crane.model();
        if wanted == "viscous" {
            model.add_effect("viscous", 0, vec![0.1]);
        }
        change(&mut model, path, 1.5);
        let (_, missing, _) = crane.exported(&model);
        let found = missing.iter().find(|part| part.part == wanted);
        let found = found.unwrap_or_else(|| panic!("{missing:?}"));
        assert_eq!(found.why, super::lacking::OTHERWISE);
        assert_eq!(found.joint_name.as_deref(), Some("slew"));
    }
    // An actuator that stays though the model has none, and one of another kind.
    let crane = Crane::of(MJCF, &[], true);
    let mut model = crane.model();
    model.joints[0].drive = crate::model::Drive::Passive;
    model.joints[1].drive = crate::model::Drive::Torque;
    let (text, missing, _) = crane.exported(&model);
    let told = parts(&missing);
    assert!(
        told.contains(&"passive") && told.contains(&"torque"),
        "{told:?}"
    );
    assert_eq!(text, MJCF);
}

/// Without mass the distances of bodies give no moments: what is lost is listed, nothing is NaN.
#[test]
fn a_link_whose_mass_is_taken_away_loses_what_its_bodies_distances_gave() {
    let crane = Crane::of(URDF, &[("grip", 0.5)], true);
    let mut model = crane.model();
    model.links[1].mass_kg = 0.0;
    let (text, missing, _) = crane.exported(&model);
    assert!(
        text.contains("<mass value='0.0'/>") && !text.contains("NaN"),
        "{text}"
    );
    assert_eq!(parts(&missing), ["lock of grip", "com_m", "inertia_kg_m2"]);
}

#[test]
fn another_format_and_a_planar_chain_are_refused() {
    let crane = Crane::of(URDF, &[], false);
    let error = robot_file(&crane.model(), &crane.path(), "mjcf").unwrap_err();
    assert_eq!(error.to_string(), "crane.xml is URDF, not MJCF");
    let remedy = error.remedy().unwrap();
    assert!(remedy.ends_with("--to urdf"), "{remedy}");
    let planar = include_str!("../../testdata/full.toml");
    let planar = Model::parse(planar, Path::new("full.toml")).unwrap();
    assert!(robot_file(&planar, Path::new("full.toml"), "urdf").is_err());
}

#[test]
fn files_that_a_robot_names_relative_to_its_folder_are_listed() {
    let text = URDF.replace(
        "</robot>",
        "<a filename=\"package://b\"/><c filename=\"/d\"/></robot>",
    );
    let crane = Crane::of(&text, &[], false);
    let exported = robot_file(&crane.model(), &crane.path(), "urdf").unwrap();
    assert_eq!(exported.relative_files, ["meshes/mast.stl"]);
}
