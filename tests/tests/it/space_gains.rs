//! Gains of robots in space: the loops hold what the designs promise, and poses are those of
//! joints.

use crate::space::CRANE;
use crate::space_linear::with_torques;
use handstand::Model;
use handstand::model::Drive;
use handstand::study::response;
use handstand::synth::{Design, DesignError, PoseText, Request, balanced};
use std::fmt::Write as _;
use std::path::Path;

/// The crane with these drives.
fn crane(folder: &Path, drives: [&str; 3], effects: &str) -> Model {
    std::fs::write(folder.join("crane.urdf"), CRANE).unwrap();
    let mut text = String::from("[rig]\nname = \"crane\"\nrobot = \"crane.urdf\"\n");
    let mut columns = String::from("[log]\ntime = { column = \"t\", unit = \"s\" }\n");
    for (name, drive) in ["slew", "luff", "roll"].into_iter().zip(drives) {
        let _ = writeln!(text, "[[joint]]\nname = \"{name}\"\n{drive}");
        let _ = write!(
            columns,
            "[[log.joint]]\nposition = {{ column = \"{name}\", unit = \"rad\" }}\n"
        );
        if !drive.contains("passive") {
            let unit = if drive.contains("position") {
                "rad"
            } else {
                "N m"
            };
            let _ = writeln!(
                columns,
                "input = {{ column = \"u_{name}\", unit = \"{unit}\" }}"
            );
        }
    }
    Model::parse(&(text + effects + &columns), &folder.join("crane.toml")).unwrap()
}

const TORQUE: &str = "drive = \"torque\"";
const SERVO: &str =
    "drive = \"position\"\ngain_per_rad = 5\nstall_torque_nm = 3\nno_load_speed_rad_s = 6";
const ROTORS: &str = "[[effect]]\nkind = \"armature\"\njoint = \"all\"\ninertia_kg_m2 = 0.01\n";

/// Largest departure of each joint over the last second of a run from here.
fn left(model: &Model, design: &Design, request: &Request, start: &[f64]) -> Vec<f64> {
    let found = response(model, design, request, start, 6.0).unwrap();
    let late = found.time_s.partition_point(|time| *time < 5.0);
    assert!((found.time_s.last().unwrap() - 6.0).abs() < 0.02, "it fell");
    let largest = |angles: &Vec<f64>| {
        angles[late..]
            .iter()
            .fold(0.0, |most: f64, angle| most.max(angle.abs()))
    };
    found.angle_rad.iter().map(largest).collect()
}

#[test]
fn a_loop_in_space_comes_back_and_holds_against_gravity() {
    let folder = tempfile::tempdir().unwrap();
    for (drive, effects) in [(TORQUE, ""), (SERVO, ROTORS)] {
        let model = crane(folder.path(), [drive; 3], effects);
        let pose = "luff=0.8,roll=-0.6".parse::<PoseText>().unwrap();
        let request = Request {
            pose_rad: pose.resolve(&model).unwrap(),
            ..Request::standard(&model)
        };
        assert_eq!(request.pose_rad, [0.0, 0.8, -0.6]);
        let design = Design::of(&model, &request).unwrap();
        assert!(design.gains.poles.iter().all(|pole| pole.norm() < 1.0));
        // Gravity pulls at the boom: the inputs carry it, of servos by goals off the pose.
        let held = design.u0[1] - if drive == SERVO { 0.8 } else { 0.0 };
        assert!(held.abs() > 0.03, "{:?}", design.u0);
        for start in [[0.0; 3], [0.1, -0.15, 0.1]] {
            let left = left(&model, &design, &request, &start);
            assert!(left.iter().all(|left| *left < 1e-3), "{drive}: {left:?}");
        }
    }
}

/// A rotary pendulum: an arm about a plumb axis, driven, and a rod at its end, which is not.
const PENDULUM: &str = r#"<robot name="pendulum"><link name="base"/>
<link name="arm"><inertial><origin xyz="0.08 0 0"/><mass value="0.1"/>
<inertia ixx="1e-5" iyy="3e-4" izz="3e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="rod"><inertial><origin xyz="0 0 -0.12"/><mass value="0.05"/>
<inertia ixx="2e-4" iyy="2e-4" izz="1e-6" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="bell"><inertial><origin xyz="0 0 -0.1"/><mass value="0.2"/>
<inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="turn" type="continuous"><parent link="base"/><child link="arm"/>
<axis xyz="0 0 1"/></joint>
<joint name="swing" type="continuous"><parent link="arm"/><child link="rod"/>
<origin xyz="0.2 0 0"/><axis xyz="1 0 0"/></joint>
<joint name="ring" type="continuous"><parent link="base"/><child link="bell"/>
<axis xyz="0 1 0"/></joint></robot>"#;

fn pendulum(folder: &Path, locked: &str) -> Model {
    std::fs::write(folder.join("pendulum.urdf"), PENDULUM).unwrap();
    let [ring, ringing] = if locked.is_empty() {
        [
            "[[joint]]\nname = \"ring\"\ndrive = \"passive\"\n",
            "[[log.joint]]\nposition = { column = \"ring\", unit = \"rad\" }\n",
        ]
    } else {
        ["", ""]
    };
    let text = format!(
        "[rig]\nname = \"pendulum\"\nrobot = \"pendulum.urdf\"\n{locked}\
         [[joint]]\nname = \"turn\"\ndrive = \"torque\"\n{ring}\
         [[joint]]\nname = \"swing\"\ndrive = \"passive\"\n\
         [log]\ntime = {{ column = \"t\", unit = \"s\" }}\n\
         [[log.joint]]\nposition = {{ column = \"turn\", unit = \"rad\" }}\n\
         input = {{ column = \"torque\", unit = \"N m\" }}\n{ringing}\
         [[log.joint]]\nposition = {{ column = \"swing\", unit = \"rad\" }}\n"
    );
    Model::parse(&text, &folder.join("pendulum.toml")).unwrap()
}

#[test]
fn a_rotary_pendulum_is_held_upright_by_its_arm() {
    let folder = tempfile::tempdir().unwrap();
    let model = pendulum(folder.path(), "locked = { ring = 0 }\n");
    let up = balanced(&model, &[0.0, 3.0]).unwrap();
    assert!((up[1] - std::f64::consts::PI).abs() < 1e-9, "{up:?}");
    let request = Request {
        pose_rad: up,
        ..Request::standard(&model)
    };
    let design = Design::of(&model, &request).unwrap();
    assert!(design.controllability.is_full());
    assert!(
        design.poles.iter().any(|pole| pole.re > 5.0),
        "{:?}",
        design.poles
    );
    let left = left(&model, &design, &request, &[0.0, 0.05]);
    assert!(left.iter().all(|left| *left < 5e-3), "{left:?}");
    let leaning = Request {
        pose_rad: vec![0.0, 1.0],
        ..request
    };
    let said = Design::of(&model, &leaning).unwrap_err().to_string();
    assert!(said.starts_with("joint swing is passive"), "{said}");
}

#[test]
fn a_branch_that_no_drive_reaches_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let model = pendulum(folder.path(), "");
    let request = Request {
        pose_rad: vec![0.0, std::f64::consts::PI, std::f64::consts::PI],
        ..Request::standard(&model)
    };
    let error = Design::of(&model, &request).unwrap_err();
    let said = error.to_string();
    assert!(
        matches!(&error, DesignError::Mode(stuck) if stuck.is_unreached),
        "{said}"
    );
    assert!(
        said.contains("q_ring") && said.contains("no input reaches it"),
        "{said}"
    );
    // A joint about a plumb axis balances anywhere, one that hangs where it hangs.
    let mut passive = pendulum(folder.path(), "");
    passive.joints[0].drive = Drive::Passive;
    let found = balanced(&passive, &[0.7, 0.2, -0.3]).unwrap();
    assert!(
        (found[0] - 0.7).abs() < 1e-9 && found[1].abs() + found[2].abs() < 1e-9,
        "{found:?}"
    );
}

#[test]
fn poses_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let ranged = CRANE
        .replacen("type=\"continuous\"", "type=\"revolute\"", 2)
        .replacen(
            "<axis xyz=\"0 1 0\"/>",
            "<axis xyz=\"0 1 0\"/><limit lower=\"0.5\" upper=\"1.5\" effort=\"3\" velocity=\"0\"/>",
            1,
        );
    let file = folder.path().join("crane.urdf");
    let (model, _) = with_torques(&ranged, &file);
    let resolve = |text: &str| text.parse::<PoseText>().unwrap().resolve(&model);
    assert_eq!(resolve("roll=0.2").unwrap(), [0.0, 1.0, 0.2]);
    assert_eq!(resolve("3=0.2, slew=1").unwrap(), [1.0, 1.0, 0.2]);
    let range = "beyond its range from 0.5 to 1.5 rad in the robot's file";
    for (text, said) in [
        ("rol=0.2", "has no joint `rol`"),
        ("4=0.2", "has no joint `4`"),
        ("roll=0.2,3=1", "the pose gives joint 3 twice"),
        ("0,1", "the pose has 2 angles, the model 3 joints"),
        ("luff=0.4", range),
        (
            "upright",
            "is a robot in space, and upright is a pose of planar chains",
        ),
        ("roll=inf", "the pose has an angle of inf"),
    ] {
        match resolve(text) {
            Err(DesignError::Request(problem)) => {
                assert!(problem.what.ends_with(said), "{text}: {problem}");
            }
            other => panic!("{text}: {other:?}"),
        }
    }
}
