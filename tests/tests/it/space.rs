//! Robots in space accelerate as in Pinocchio and in MuJoCo: trees drawn at random, and the SO-100
//! and SO-101 of their owners' files.

use crate::import::Draws;
use crate::program;
use crate::simulators::{Case, State, largest_difference, python};
use handstand::Model;
use handstand::dynamics::{SpatialEquations, SpatialTree, SpatialWorkspace};
use handstand::model::import::{ImportPlan, SpacePlan, import};
use serde_json::Value;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

const TREES: u64 = 200;
const STATES: usize = 3;

/// For each joint, the one whose link carries it; none of the base.
fn parents(draws: &mut Draws) -> Vec<Option<usize>> {
    let count = 1 + draws.above(0.0, 29.999) as usize;
    (0..count)
        .map(|joint| (draws.above(0.0, joint as f64 + 0.999) as usize).checked_sub(1))
        .collect()
}

pub(crate) fn urdf(draws: &mut Draws) -> (String, Vec<String>) {
    let parents = parents(draws);
    let mut text = String::from("<robot name=\"drawn\"><link name=\"base\"/>");
    for (joint, parent) in parents.iter().enumerate() {
        let moments = [0; 3].map(|_| draws.above(1e-3, 2e-3));
        let parent = parent.map_or("base".to_string(), |parent| format!("link{parent}"));
        let kind = if draws.next() > 0.5 {
            "prismatic"
        } else {
            "revolute"
        };
        let _ = write!(
            text,
            "<link name=\"link{joint}\"><inertial><origin xyz=\"{}\" rpy=\"{}\"/>\
             <mass value=\"{}\"/><inertia ixx=\"{}\" iyy=\"{}\" izz=\"{}\" ixy=\"1e-4\" \
             ixz=\"-2e-4\" iyz=\"{}\"/></inertial></link>\
             <joint name=\"joint{joint}\" type=\"{kind}\"><parent link=\"{parent}\"/>\
             <child link=\"link{joint}\"/><origin xyz=\"{}\" rpy=\"{}\"/><axis xyz=\"{}\"/>\
             <limit lower=\"-9\" upper=\"9\" effort=\"0\" velocity=\"0\"/></joint>",
            draws.three(0.2),
            draws.three(1.0),
            draws.above(0.1, 1.0),
            moments[0],
            moments[1],
            moments[2],
            1e-4 * draws.next(),
            draws.three(0.4),
            draws.three(3.0),
            draws.three(1.0),
        );
    }
    let names = (0..parents.len()).map(|joint| format!("joint{joint}"));
    (text + "</robot>", names.collect())
}

/// Bodies lie within those that carry them, so that joints are numbered as they are met; some
/// bodies have two.
pub(crate) fn mjcf(draws: &mut Draws) -> (String, Vec<String>) {
    let parents = parents(draws);
    let mut names = Vec::new();
    let mut text = format!(
        "<mujoco><compiler angle=\"radian\"/><option gravity=\"{}\">\
         <flag contact=\"disable\"/></option><worldbody>",
        draws.three(9.81)
    );
    for root in (0..parents.len()).filter(|joint| parents[*joint].is_none()) {
        body(&mut text, &mut names, root, &parents, draws);
    }
    (text + "</worldbody></mujoco>", names)
}

fn body(
    text: &mut String,
    names: &mut Vec<String>,
    own: usize,
    parents: &[Option<usize>],
    draws: &mut Draws,
) {
    let _ = write!(
        text,
        "<body pos=\"{}\" euler=\"{}\">",
        draws.three(0.4),
        draws.three(3.0)
    );
    let joints = if draws.next() > 0.6 { 2 } else { 1 };
    for at in 0..joints {
        let name = format!("joint{own}_{at}");
        let kind = if draws.next() > 0.5 { "slide" } else { "hinge" };
        let _ = write!(
            text,
            "<joint name=\"{name}\" type=\"{kind}\" axis=\"{}\" pos=\"{}\" ref=\"{}\"/>",
            draws.three(1.0),
            draws.three(0.1),
            draws.next()
        );
        names.push(name);
    }
    let _ = write!(
        text,
        "<inertial mass=\"{}\" pos=\"{}\" fullinertia=\"2e-3 2e-3 2e-3 1e-4 2e-4 -3e-4\"/>",
        draws.above(0.1, 1.0),
        draws.three(0.2)
    );
    for child in (0..parents.len()).filter(|child| parents[*child] == Some(own)) {
        body(text, names, child, parents, draws);
    }
    text.push_str("</body>");
}

/// A model of a robot's file beside which it is, and its joints.
pub(crate) fn model(text: &str, file: &Path, locked: &[String]) -> (Model, Vec<String>) {
    let robot = file.file_name().unwrap().to_str().unwrap().to_string();
    let locked = locked.iter().map(|name| (name.clone(), 0.0)).collect();
    let plan = ImportPlan {
        space: Some(SpacePlan { robot, locked }),
        ..ImportPlan::default()
    };
    let name = file.display();
    let imported = import(text, file, &plan).unwrap_or_else(|error| panic!("{name}: {error}"));
    let model = Model::parse(&imported.toml, &file.with_file_name("model.toml"));
    let model = model.unwrap_or_else(|error| panic!("{name}: {error}"));
    (model, imported.joints)
}

/// Accelerations by the model's rig.
pub(crate) fn accelerations(model: &Model, [q, dq, tau]: &State) -> Vec<f64> {
    let tree = model.rig(false).tree.expect("a robot in space");
    let mut out = vec![0.0; q.len()];
    let held = vec![false; q.len()];
    let mut work = SpatialWorkspace::default();
    SpatialEquations::new(&tree).forward(&mut work, [q, dq, tau], &held, &mut out);
    out
}

/// Compares at states drawn; the largest difference, as a share of the largest acceleration.
fn compare(robots: Vec<(PathBuf, Model, Vec<String>)>, seed: u64) -> Option<f64> {
    let python = python()?;
    let mut draws = Draws(seed);
    let (mut cases, mut models) = (Vec::new(), Vec::new());
    for (file, model, joints) in robots {
        let mut many =
            |size: f64| -> Vec<f64> { joints.iter().map(|_| size * draws.next()).collect() };
        let states = (0..STATES).map(|_| [many(3.0), many(5.0), many(4.0)]);
        let states = states.collect();
        cases.push(Case {
            file,
            joints,
            states,
        });
        models.push(model);
    }
    let ours = |robot: usize, state: &State| accelerations(&models[robot], state);
    Some(largest_difference(&python, &cases, ours))
}

#[test]
fn random_trees_accelerate_as_in_pinocchio_and_mujoco() {
    let folder = tempfile::tempdir().unwrap();
    let mut cases = Vec::new();
    for number in 0..TREES {
        let mut draws = Draws(number);
        let ((text, mut names), ending) = match number % 2 {
            0 => (urdf(&mut draws), "urdf"),
            _ => (mjcf(&mut draws), "xml"),
        };
        let file = folder.path().join(format!("{number}.{ending}"));
        std::fs::write(&file, &text).unwrap();
        // Pinocchio holds joints, too; MuJoCo has them all.
        let held = |_: &&String| number % 2 == 0 && draws.next() > 0.6;
        let locked: Vec<String> = names[1..].iter().filter(held).cloned().collect();
        let (model, joints) = model(&text, &file, &locked);
        names.retain(|name| !locked.contains(name));
        let (mut sorted, mut wanted) = (joints.clone(), names);
        sorted.sort();
        wanted.sort();
        assert_eq!(sorted, wanted, "{number}");
        cases.push((file, model, joints));
    }
    if let Some(worst) = compare(cases, 1) {
        println!("{TREES} trees of 1 to 30 bodies, largest difference {worst:.1e}");
    }
}

#[test]
fn arms_of_their_owners_files_accelerate_as_in_pinocchio() {
    let Ok(data) = std::env::var("HANDSTAND_DATA") else {
        eprintln!("skipped: HANDSTAND_DATA names no folder of robots");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut cases = Vec::new();
    for name in ["so100", "so101_new_calib", "so101_old_calib"] {
        let text = std::fs::read_to_string(format!("{data}/robots/so101/{name}.urdf")).unwrap();
        let file = folder.path().join(format!("{name}.urdf"));
        std::fs::write(&file, &text).unwrap();
        let (model, joints) = model(&text, &file, &[]);
        cases.push((file, model, joints));
    }
    if let Some(worst) = compare(cases, 2) {
        println!("largest difference {worst:.1e}");
    }
}

/// A mast that slews, a boom that luffs below it, and a head that rolls: no two axes parallel.
pub(crate) const CRANE: &str = r#"<robot name="crane"><link name="base"/>
<link name="mast"><inertial><origin xyz="0.05 0 0"/><mass value="0.4"/>
<inertia ixx="1e-3" iyy="1e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="boom"><inertial><origin xyz="0 0.02 -0.15"/><mass value="0.3"/>
<inertia ixx="2e-3" iyy="2e-3" izz="3e-4" ixy="1e-4" ixz="0" iyz="0"/></inertial></link>
<link name="head"><inertial><origin xyz="0.03 0 -0.05"/><mass value="0.2"/>
<inertia ixx="5e-4" iyy="4e-4" izz="3e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="slew" type="continuous"><parent link="base"/><child link="mast"/>
<axis xyz="0 0 1"/></joint>
<joint name="luff" type="continuous"><parent link="mast"/><child link="boom"/>
<origin xyz="0.1 0 -0.1" rpy="0 0 0.3"/><axis xyz="0 1 0"/></joint>
<joint name="roll" type="continuous"><parent link="boom"/><child link="head"/>
<origin xyz="0 0 -0.3" rpy="0.2 0 0"/><axis xyz="1 0 0.2"/></joint>
</robot>"#;

const HIDDEN_NM_S_RAD: f64 = 0.06;

/// [`swung_tree`] of a model.
pub(crate) fn swung(model: &Model, number: usize) -> String {
    swung_tree(&model.tree().unwrap(), number)
}

/// A motion and the torques that it takes by Newton and Euler, viscous friction at the boom
/// included, at 500 Hz, angles read to 1e-4 rad.
pub(crate) fn swung_tree(tree: &SpatialTree, number: usize) -> String {
    let equations = SpatialEquations::new(tree);
    let mut work = SpatialWorkspace::default();
    let mut text = String::from(
        "time_s,slew.position,slew.effort,luff.position,luff.effort,roll.position,roll.effort\n",
    );
    let state = |t: f64| -> [Vec<f64>; 3] {
        let wave = |joint: usize, of: fn(f64, f64) -> f64| {
            let first = 2.0 + 0.7 * joint as f64 + 0.3 * number as f64;
            0.4 * of(first, t) + 0.25 * of(2.3 * first, t)
        };
        let all = |of: fn(f64, f64) -> f64| (0..3).map(|joint| wave(joint, of)).collect();
        [
            all(|w, t| (w * t).sin()),
            all(|w, t| w * (w * t).cos()),
            all(|w, t| -w * w * (w * t).sin()),
        ]
    };
    for k in 0..3000 {
        let t = k as f64 * 0.002;
        let [q, ..] = state(t);
        // The torque of a sample lasts until the next one.
        let [at, speed, acceleration] = state(t + 0.001);
        let mut torque = vec![0.0; 3];
        equations.inverse(
            &mut work,
            [&at, &speed, &acceleration],
            &mut torque,
            |_, _| {},
        );
        torque[1] += HIDDEN_NM_S_RAD * speed[1];
        let _ = write!(text, "{t:.3}");
        for (q, torque) in q.iter().zip(&torque) {
            let _ = write!(text, ",{:.4},{torque:.9}", q);
        }
        text.push('\n');
    }
    text
}

/// Exit code, stdout and stderr of a command.
fn ran(folder: &Path, arguments: &[&str]) -> (i32, [String; 2]) {
    let mut command = Command::new(program());
    let output = command
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap();
    let said =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    (output.status.code().unwrap(), said)
}

/// What a command that succeeds prints on stdout and stderr.
pub(crate) fn printed(folder: &Path, arguments: &[&str]) -> [String; 2] {
    let (code, said) = ran(folder, arguments);
    assert_eq!(code, 0, "{arguments:?}: {}", said[1]);
    said
}

/// Exit code and stderr, its words with a blank between.
pub(crate) fn refused(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let (code, [_, said]) = ran(folder, arguments);
    (code, said.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// Writes a crane's file and imports it into `crane.toml`, its joints driven by torques; what the
/// import says on stderr.
pub(crate) fn import_crane(folder: &Path, urdf: &str) -> String {
    std::fs::write(folder.join("crane.urdf"), urdf).unwrap();
    let import = [
        "import",
        "crane.urdf",
        "--space",
        "--driven",
        "-o",
        "crane.toml",
    ];
    let [_, told] = printed(folder, &import);
    told
}

pub(crate) fn run(folder: &Path, arguments: &[&str]) -> (Value, String) {
    let [text, complaints] = printed(folder, arguments);
    (
        serde_json::from_str(&text).unwrap_or(Value::Null),
        complaints,
    )
}

/// From the robot's file to a better model, as a user goes, the new one in another folder.
#[test]
fn what_a_robot_in_space_lacks_is_added_and_the_error_falls() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let told = import_crane(at, CRANE);
    assert!(told.contains("joints: slew, luff, roll"), "{told}");
    let model = Model::load(&at.join("crane.toml")).unwrap();
    for (number, name) in ["a.csv", "b.csv", "c.csv"].into_iter().enumerate() {
        std::fs::write(at.join(name), swung(&model, number)).unwrap();
    }
    std::fs::create_dir(at.join("new")).unwrap();
    let add = [
        "add",
        "crane.toml",
        "viscous@2",
        "--fit",
        "a.csv",
        "b.csv",
        "c.csv",
        "-o",
        "new/better.toml",
    ];
    let (_, told) = run(at, &add);
    assert!(told.contains("1 slew, 2 luff, 3 roll"), "{told}");
    let better = Model::load(&at.join("new/better.toml")).unwrap();
    let found = better.effects[0].values[0];
    assert!((found / HIDDEN_NM_S_RAD - 1.0).abs() < 0.02, "{found}");
    let rms = |model: &str| {
        let (data, _) = run(at, &["compare", model, "c.csv", "--json"]);
        data["comparisons"][0]["signals"][1]["rms_rad"]
            .as_f64()
            .unwrap_or_else(|| panic!("{data}"))
    };
    let (before, after) = (rms("crane.toml"), rms("new/better.toml"));
    assert!(after < 0.2 * before, "{before} {after}");
    // A link's mass that is off is found again, and the same figures in every session.
    let better = std::fs::read_to_string(at.join("new/better.toml")).unwrap();
    let heavier = better.replace("mass_kg = 0.2\n", "mass_kg = 0.25\n");
    assert_ne!(heavier, better);
    std::fs::write(at.join("new/heavier.toml"), heavier).unwrap();
    let logs = ["a.csv", "b.csv", "c.csv"];
    let fit = [
        "fit",
        "new/heavier.toml",
        "-o",
        "fitted.toml",
        "--free",
        "link3.mass_kg",
    ];
    run(at, &[&fit[..], &logs].concat());
    let found = Model::load(&at.join("fitted.toml")).unwrap().links[2].mass_kg;
    assert!((found / 0.2 - 1.0).abs() < 0.02, "{found}");
    let (data, _) = run(
        at,
        &[&["drift", "fitted.toml", "--json"][..], &logs].concat(),
    );
    assert!(data.is_object(), "{data}");
}
