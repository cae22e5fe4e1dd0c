//! Chains out of URDF and MJCF texts.

mod real_files;

use super::*;
use crate::Model;
use crate::model::export::{mjcf as to_mjcf, urdf as to_urdf};

fn imported(text: &str, joints: &[&str]) -> (Imported, Model) {
    let plan = ImportPlan {
        joints: joints.iter().map(ToString::to_string).collect(),
        drives: JointDrives::OfFile,
        space: None,
    };
    let imported = import(text, Path::new("robot.xml"), &plan).unwrap();
    let model = Model::parse(&imported.toml, Path::new("robot.toml")).unwrap();
    (imported, model)
}

fn refused(text: &str, joints: &[&str]) -> String {
    let joints = joints.iter().map(ToString::to_string).collect();
    let plan = ImportPlan {
        joints,
        drives: JointDrives::OfFile,
        space: None,
    };
    let error = import(text, Path::new("robot.xml"), &plan).unwrap_err();
    assert!(error.remedy().is_some());
    error.to_string()
}

/// What a model's chain does, whatever it is called.
fn assert_same(ours: &Model, theirs: &Model, drives: bool) {
    let (a, b) = (ours.rig(false), theirs.rig(false));
    assert_eq!(a.chain.links.len(), b.chain.links.len());
    let last = a.chain.links.len() - 1;
    for (index, (a, b)) in a.chain.links.iter().zip(&b.chain.links).enumerate() {
        let mut pairs = vec![
            (
                a.com_m * a.com_angle_rad.cos(),
                b.com_m * b.com_angle_rad.cos(),
            ),
            (
                a.com_m * a.com_angle_rad.sin(),
                b.com_m * b.com_angle_rad.sin(),
            ),
            (a.mass_kg, b.mass_kg),
            (a.inertia_kg_m2, b.inertia_kg_m2),
        ];
        if drives {
            pairs.push((a.armature_kg_m2, b.armature_kg_m2));
        }
        if index < last {
            pairs.push((a.length_m, b.length_m));
            for (a, b) in &pairs {
                assert!((a - b).abs() < 1e-12, "link {index}: {a} {b}");
            }
        } else {
            // The last link's line is that to its centre of mass.
            assert!((a.mass_kg - b.mass_kg).abs() < 1e-12);
            assert!((a.com_m.abs() - b.com_m.abs()).abs() < 1e-12);
            assert!((a.inertia_kg_m2 - b.inertia_kg_m2).abs() < 1e-12);
        }
    }
}

#[test]
fn exported_models_come_back() {
    for name in [
        "handstand",
        "dfki_double",
        "multiarm_triple",
        "bus_servo",
        "mx106_drop",
    ] {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../models/{name}.toml"));
        let model = Model::load(&file).unwrap();
        let (_, back) = imported(&to_mjcf(&model).text, &[]);
        assert_same(&model, &back, true);
        let drives = |m: &Model| m.joints.iter().map(|j| j.drive.name()).collect::<Vec<_>>();
        assert_eq!(drives(&model), drives(&back), "{name}");
        for (a, b) in model.joints.iter().zip(&back.joints) {
            if let (Some(a), Some(b)) = (a.drive.motor(), b.drive.motor()) {
                assert!(
                    (a.stall_torque_nm - b.stall_torque_nm).abs() < 1e-12,
                    "{name}"
                );
            }
        }
        assert_eq!(model.gravity_m_s2, back.gravity_m_s2);
        let (_, back) = imported(&to_urdf(&model).text, &[]);
        assert_same(&model, &back, false);
        for id in ["viscous", "coulomb"] {
            let value = |m: &Model| -> Vec<f64> {
                let own = m.effects.iter().filter(|e| e.effect.info().id == id);
                own.flat_map(|e| e.values.clone())
                    .filter(|v| *v != 0.0)
                    .collect()
            };
            assert_eq!(value(&model), value(&back), "{name} {id}");
        }
    }
}

const BRANCHES: &str = r#"<robot name="tree">
  <link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
  <link name="a"><inertial><origin xyz="0 0 -0.1"/><mass value="0.2"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3"/></inertial></link>
  <link name="b"><inertial><origin xyz="0 0 -0.2"/><mass value="0.3"/><inertia ixx="2e-3" iyy="2e-3" izz="2e-3"/></inertial></link>
  <link name="c"><inertial><origin xyz="0 0 0.1"/><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4"/></inertial></link>
  <link name="tool"><inertial><mass value="0.05"/><inertia ixx="0" iyy="0" izz="0"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="5" velocity="6"/><dynamics damping="0.01" friction="0.02"/></joint>
  <joint name="elbow" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0 0.3 -0.4"/><axis xyz="0 -1 0"/></joint>
  <joint name="wing" type="continuous"><parent link="a"/><child link="c"/><axis xyz="1 0 0"/></joint>
  <joint name="grip" type="fixed"><parent link="b"/><child link="tool"/><origin xyz="0 0 -0.5"/></joint>
</robot>"#;

#[test]
fn branches_are_held_and_fixed_links_are_one() {
    let (imported, model) = imported(BRANCHES, &[]);
    assert_eq!(imported.joints, ["shoulder", "elbow"]);
    let parts: Vec<(&str, Option<&str>)> = imported
        .left_out
        .iter()
        .map(|l| (l.part.as_str(), l.name.as_deref()))
        .collect();
    for part in [
        ("joint", Some("wing")),
        ("range", Some("shoulder")),
        ("velocity limit", Some("shoulder")),
        ("base", None),
    ] {
        assert!(parts.contains(&part), "{part:?} of {parts:?}");
    }
    let chain = model.rig(false).chain;
    // 0.2 kg at 0.1 m below and 0.1 kg at 0.1 m above the joint.
    assert!((chain.links[0].mass_kg - 0.3).abs() < 1e-12);
    assert!((chain.links[0].com_m - 0.1 / 3.0).abs() < 1e-12);
    let about = 1e-3 + 1e-4 + 0.2 * 0.01 + 0.1 * 0.01 - 0.3 * (0.1f64 / 3.0).powi(2);
    assert!((chain.links[0].inertia_kg_m2 - about).abs() < 1e-12);
    assert!((chain.links[0].length_m - 0.4).abs() < 1e-12);
    assert!((chain.links[1].mass_kg - 0.35).abs() < 1e-12);
    let drives: Vec<&str> = model.joints.iter().map(|j| j.drive.name()).collect();
    assert_eq!(drives, ["torque", "passive"]);
    let column =
        |joint: usize| model.log.joints[joint].position.as_ref().unwrap().columns()[0].clone();
    // The first axis is taken as towards the one who looks, so the other counts the other way.
    assert_eq!([column(0).reversed, column(1).reversed], [false, true]);
}

#[test]
fn mjcf_defaults_angles_and_shapes_are_understood() {
    let text = r#"<mujoco model="m"><compiler angle="degree"/>
      <default><joint damping="0.1"/><default class="arm"><joint armature="0.02" ref="90"/><geom density="500"/></default></default>
      <option gravity="0 0 -1.62"/>
      <worldbody><body name="a" pos="0 0 1" euler="0 90 0" childclass="arm">
        <joint name="j" axis="0 1 0" stiffness="2" springref="90"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.4" size="0.02"/>
        <geom type="box" size="0.01 0.02 0.03" pos="0 0 -0.4" mass="0.3"/>
      </body></worldbody>
      <actuator><motor joint="j" gear="5" ctrlrange="-2 2"/></actuator></mujoco>"#;
    let (imported, model) = imported(text, &[]);
    assert_eq!(model.gravity_m_s2, 1.62);
    assert_eq!(model.joints[0].drive.name(), "torque");
    let values = |id: &str| {
        let mut found = model.effects.iter().filter(|e| e.effect.info().id == id);
        found.next().map(|e| e.values.clone()).unwrap_or_default()
    };
    assert_eq!(values("viscous"), [0.1]);
    assert_eq!(values("armature"), [0.02]);
    assert_eq!(values("torque_saturation"), [10.0]);
    let (r, l) = (0.02f64, 0.4f64);
    let volume = std::f64::consts::PI * (r * r * l + 4.0 / 3.0 * r.powi(3));
    assert!((model.links[0].mass_kg - (0.3 + 500.0 * volume)).abs() < 1e-12);
    // Turned by a quarter about y, what hung points to -x; seen along +y, x is to the left... the
    // coordinate is 90 degrees there.
    let column = &model.log.joints[0].position.as_ref().unwrap().columns()[0];
    let hangs = column.to_si(90f64.to_radians());
    assert!(
        (hangs.abs() - std::f64::consts::FRAC_PI_2).abs() < 1e-9,
        "{hangs}"
    );
    let rest = values("cable_spring")[1];
    assert!((rest - hangs).abs() < 1e-9);
    assert!(imported.left_out.iter().any(|l| l.part == "motor"));
}

#[test]
fn what_makes_no_planar_chain_is_refused_with_its_place() {
    assert!(refused(BRANCHES, &["shoulder", "wing"]).contains("90.0 degrees"));
    assert!(refused(BRANCHES, &["elbow", "shoulder"]).contains("does not lie behind"));
    assert!(refused(BRANCHES, &["knee"]).contains("knee"));
    assert!(refused(BRANCHES, &["grip"]).contains("grip"));
    let broken = [
        ("", "robot.xml:1"),
        ("<robot", "robot.xml:1"),
        ("<sdf/>", "<sdf>"),
        ("<robot/>", "no <link>"),
        ("<robot><link name='a'/></robot>", "no joint turns"),
        (
            "<mujoco><worldbody><body><joint name='x'/><joint name='y'/></body></worldbody></mujoco>",
            "no joint turns or slides alone in its own body",
        ),
        ("<robot><link/></robot>", "lacks name"),
        ("<robot><link name='a'/><link name='b'/></robot>", "2 links"),
        (
            "<robot><link name='a'/><joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>",
            "no link \"b\"",
        ),
        (
            "<robot><link name='a'/><link name='b'/><joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>",
            "has no mass",
        ),
        ("<mujoco><include file='x'/></mujoco>", "<include>"),
        (
            "<mujoco><worldbody><body><joint/><geom type='mesh'/></body></worldbody></mujoco>",
            "mesh",
        ),
        (
            "<mujoco><worldbody><body><joint axis='0 0 0'/></body></worldbody></mujoco>",
            "axis",
        ),
        (
            "<mujoco><worldbody><body pos='1 x 2'><joint/></body></worldbody></mujoco>",
            "no number",
        ),
        (
            "<mujoco><worldbody><body><joint class='none'/></body></worldbody></mujoco>",
            "no class",
        ),
        ("<!DOCTYPE a [<!ENTITY b 'c'>]><robot/>", "DTD"),
    ];
    for (text, what) in broken {
        let said = refused(text, &[]);
        assert!(said.contains(what), "{text}: {said}");
    }
    let deep = format!(
        "<mujoco><worldbody>{}{}</worldbody></mujoco>",
        "<body>".repeat(1000),
        "</body>".repeat(1000)
    );
    assert!(refused(&deep, &[]).contains("too deep"));
}
