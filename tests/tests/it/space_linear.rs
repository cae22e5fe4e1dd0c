//! The linear models of robots in space are those of planar chains, of Pinocchio and of MuJoCo.

use crate::import::Draws;
use crate::simulators::{answers, python};
use crate::space::{mjcf, model, urdf};
use handstand::Model;
use handstand::model::Drive;
use handstand::synth::{Linearisation, linearise};
use nalgebra::DMatrix;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;

const TREES: u64 = 60;

/// What both kinds of model hold beside their shape.
const DRIVES: [&str; 3] = [
    "drive = \"torque\"",
    "drive = \"position\"\ngain_per_rad = 5\nstall_torque_nm = 3\nno_load_speed_rad_s = 6",
    "drive = \"speed\"\ngain_s_per_rad = 0.3\nstall_torque_nm = 2\nno_load_speed_rad_s = 5",
];
const EFFECTS: &str = r#"
[[effect]]
kind = "viscous"
joint = 1
coefficient_nm_s_rad = 0.02
[[effect]]
kind = "cable_spring"
joint = 2
stiffness_nm_rad = 0.3
rest_angle_rad = 0.1
[[effect]]
kind = "armature"
joint = 3
inertia_kg_m2 = 1e-3
[[effect]]
kind = "mass"
joint = 2
added_kg = 0.1
"#;

fn log() -> String {
    let joint = |joint: usize| {
        let unit = ["N m", "rad", "rad/s"][joint];
        format!(
            "[[log.joint]]\nposition = {{ column = \"q{joint}\", unit = \"rad\" }}\n\
             input = {{ column = \"u{joint}\", unit = \"{unit}\" }}\n"
        )
    };
    let joints: String = (0..3).map(joint).collect();
    format!("[log]\ntime = {{ column = \"t\", unit = \"s\" }}\n{joints}")
}

/// Lengths, levers, masses and moments of three links.
const LINKS: [[f64; 4]; 3] = [
    [0.2, 0.12, 0.5, 2e-3],
    [0.15, 0.07, 0.3, 1e-3],
    [0.1, 0.05, 0.2, 5e-4],
];

fn planar() -> Model {
    let mut text = String::from("[rig]\nname = \"arm\"\nangle_zero = \"hanging\"\n");
    for [length, com, mass, inertia] in LINKS {
        let _ = write!(
            text,
            "[[link]]\nlength_m = {length}\ncom_m = {com}\nmass_kg = {mass}\n\
             inertia_kg_m2 = {inertia}\n"
        );
    }
    for drive in DRIVES {
        let _ = writeln!(text, "[[joint]]\n{drive}");
    }
    let text = text + EFFECTS + &log();
    Model::parse(&text, Path::new("arm.toml")).unwrap()
}

/// The same arm as a tree: its plane is that of x and z, its angles grow about -y.
fn spatial(folder: &Path) -> Model {
    let mut text = String::from("<robot name=\"arm\"><link name=\"base\"/>");
    let (mut parent, mut before) = ("base".to_string(), 0.0);
    for (index, [length, com, mass, inertia]) in LINKS.into_iter().enumerate() {
        let _ = write!(
            text,
            "<link name=\"link{index}\"><inertial><origin xyz=\"0 0 {}\"/><mass value=\"{mass}\"/>\
             <inertia ixx=\"1e-3\" iyy=\"{inertia}\" izz=\"1e-3\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>\
             </inertial></link><joint name=\"joint{index}\" type=\"continuous\">\
             <parent link=\"{parent}\"/><child link=\"link{index}\"/><origin xyz=\"0 0 {}\"/>\
             <axis xyz=\"0 -1 0\"/></joint>",
            -com, -before
        );
        (parent, before) = (format!("link{index}"), length);
    }
    std::fs::write(folder.join("arm.urdf"), text + "</robot>").unwrap();
    let mut text = String::from("[rig]\nname = \"arm\"\nrobot = \"arm.urdf\"\n");
    for (index, drive) in DRIVES.iter().enumerate() {
        let _ = writeln!(text, "[[joint]]\nname = \"joint{index}\"\n{drive}");
    }
    let text = text + EFFECTS + &log();
    Model::parse(&text, &folder.join("arm.toml")).unwrap()
}

fn off(found: &DMatrix<f64>, wanted: &DMatrix<f64>) -> f64 {
    (found - wanted).amax() / wanted.amax().max(1.0)
}

#[test]
fn a_planar_chain_has_the_same_linear_model_as_a_tree() {
    let folder = tempfile::tempdir().unwrap();
    let (planar, spatial) = (planar(), spatial(folder.path()));
    for pose in [[0.0; 3], [0.4, -0.9, 0.7], [3.0, 0.3, -1.2]] {
        let [chain, tree] = [&planar, &spatial].map(|model| linearise(model, &pose).unwrap());
        assert!(
            off(&tree.plant.a, &chain.plant.a) < 1e-9,
            "{}",
            tree.plant.a
        );
        assert!(
            off(&tree.plant.b, &chain.plant.b) < 1e-9,
            "{}",
            tree.plant.b
        );
        assert_eq!(tree.plant.c, chain.plant.c);
        for (tree, chain) in tree.inputs.iter().zip(&chain.inputs) {
            assert!((tree - chain).abs() < 1e-9, "{tree} {chain}");
        }
    }
}

/// The slopes that a peer finds, a row per joint.
fn slope(theirs: &Value, key: &str) -> DMatrix<f64> {
    let rows: Vec<Vec<f64>> = serde_json::from_value(theirs[key].clone()).unwrap();
    DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

/// How far linear models are off those of the peers, the farthest.
fn off_peers(models: &[(Value, Model, Vec<f64>)], within: f64) -> Option<f64> {
    let python = python()?;
    let linear: Vec<Linearisation> = models
        .iter()
        .map(|(case, model, pose)| {
            linearise(model, pose).unwrap_or_else(|error| panic!("{case}: {error}"))
        })
        .collect();
    let cases: Vec<Value> = models
        .iter()
        .zip(&linear)
        .map(|((case, _, pose), linear)| {
            let mut case = case.clone();
            (case["q"], case["ctrl"]) = (json!(pose), json!(linear.inputs));
            case
        })
        .collect();
    let mut worst = 0.0f64;
    for ((case, linear), theirs) in
        cases
            .iter()
            .zip(&linear)
            .zip(answers(&python, "linearise.py", &cases))
    {
        let n = linear.plant.a.nrows() / 2;
        let of = |place| linear.plant.a.view((n, place), (n, n)).into_owned();
        let per_input = linear.plant.b.rows(n, n).into_owned();
        for (key, ours) in [("q", of(0)), ("dq", of(n)), ("u", per_input)] {
            let found = off(&ours, &slope(&theirs, key));
            assert!(
                found < within,
                "{case}, {key}: {found:.1e}: {ours} {theirs}"
            );
            worst = worst.max(found);
        }
        let rest: Vec<f64> = serde_json::from_value(theirs["rest"].clone()).unwrap();
        assert!(rest.iter().all(|a| a.abs() < 1e-6), "{case} {theirs}");
    }
    Some(worst)
}

/// A robot's file as a model whose joints all take torques.
pub(crate) fn with_torques(text: &str, file: &Path) -> (Model, Vec<String>) {
    std::fs::write(file, text).unwrap();
    let (mut model, joints) = model(text, file, &[]);
    for joint in &mut model.joints {
        joint.drive = Drive::Torque;
    }
    (model, joints)
}

#[test]
fn trees_have_the_linear_models_of_pinocchio_and_mujoco() {
    let folder = tempfile::tempdir().unwrap();
    for (of, ending, within) in [
        (urdf as fn(&mut Draws) -> _, "urdf", 1e-9),
        (mjcf, "xml", 1e-5),
    ] {
        let models = (0..TREES).map(|number| {
            let mut draws = Draws(1000 + number);
            let (text, _): (String, Vec<String>) = of(&mut draws);
            let file = folder.path().join(format!("{number}.{ending}"));
            let (model, joints) = with_torques(&text, &file);
            let pose = joints.iter().map(|_| 3.0 * draws.next()).collect();
            (json!({ "file": file, "joints": joints }), model, pose)
        });
        let models: Vec<_> = models.collect();
        if let Some(worst) = off_peers(&models, within) {
            println!("{TREES} trees of {ending}, largest difference {worst:.1e}");
        }
    }
}

#[test]
fn arms_of_their_owners_files_have_the_linear_models_of_pinocchio() {
    let Ok(data) = std::env::var("HANDSTAND_DATA") else {
        eprintln!("skipped: HANDSTAND_DATA names no folder of robots");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let models = ["so100", "so101_new_calib", "so101_old_calib"].map(|name| {
        let text = std::fs::read_to_string(format!("{data}/robots/so101/{name}.urdf")).unwrap();
        let file = folder.path().join(format!("{name}.urdf"));
        let (mut model, joints) = with_torques(&text, &file);
        // The files' limits of torque are left out, as Pinocchio leaves them out.
        model.effects.clear();
        let pose = (0..joints.len()).map(|joint| {
            let (low, high) = model.range(joint).unwrap();
            low + 0.6 * (high - low)
        });
        let pose = pose.collect();
        (json!({ "file": file, "joints": joints }), model, pose)
    });
    if let Some(worst) = off_peers(&models, 1e-9) {
        println!("largest difference {worst:.1e}");
    }
}

/// An arm with friction, springs, rotors and servos, as MuJoCo has them.
const SERVOS: &str = r#"<mujoco><compiler angle="radian"/><worldbody><body pos="0 0 0.1">
<joint name="pan" axis="0 0 1" damping="0.05" armature="0.01"/>
<inertial mass="0.4" pos="0.03 0 0.02" diaginertia="1e-3 1e-3 2e-3"/>
<body pos="0.05 0 0.05" euler="0.2 0 0.4">
<joint name="lift" axis="0 1 0.1" armature="0.02" stiffness="0.5" springref="0.3"/>
<inertial mass="0.3" pos="0.1 0.01 0" diaginertia="2e-3 2e-3 3e-4"/>
<body pos="0.2 0 0"><joint name="flex" axis="0 1 0" damping="0.02" armature="0.005"/>
<inertial mass="0.2" pos="0.08 0 0.01" diaginertia="1e-3 1e-3 2e-4"/>
<body pos="0.15 0 0"><joint name="reach" type="slide" axis="1 0 0.2" damping="0.3"/>
<inertial mass="0.1" pos="0.02 0 0" diaginertia="1e-4 1e-4 1e-4"/></body></body></body></body>
</worldbody><actuator><motor joint="pan" forcerange="-5 5"/>
<position joint="lift" kp="20" kv="1.5" forcerange="-9 9"/>
<position joint="flex" kp="12" kv="0.8" forcerange="-6 6"/></actuator></mujoco>"#;

#[test]
fn drives_and_effects_enter_as_in_mujoco() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("servos.xml");
    std::fs::write(&file, SERVOS).unwrap();
    let (mut model, joints) = model(SERVOS, &file, &[]);
    model.joints[3].drive = Drive::Torque;
    let models = [[0.3, 0.4, -0.7, 0.05], [-1.0, -0.5, 1.2, -0.1]].map(|pose| {
        (
            json!({ "file": file, "joints": joints }),
            model.clone(),
            pose.to_vec(),
        )
    });
    if let Some(worst) = off_peers(&models, 1e-5) {
        println!("largest difference {worst:.1e}");
    }
}
