//! Exported models move in MuJoCo as they do here.

use crate::simulators::{answers, python};
use handstand::Model;
use handstand::challenge::{KINDS, Motions, true_model_toml};
use handstand::model::export::mjcf;
use handstand::motion::Motion;
use handstand::sim::{Plant, PlantMemory, StartState, predict};
use serde_json::{Value, json};
use std::path::Path;

const PERIOD_S: f64 = 0.01;
const PERIODS: usize = 200;

/// A true model of the benchmark, in the units of its drives' motors and without a sensor's
/// rounding.
///
/// None where the library's effect cannot act at the joint that was drawn.
fn model(motions: Motions, kind: &'static str, seed: u64) -> Option<Model> {
    let text = true_model_toml(motions, seed, &[kind])?;
    let mut model = Model::parse(&text, Path::new("true.toml")).ok()?;
    // MuJoCo's step; the benchmark's logs are of another.
    model.step_s = 5e-4;
    Some(model)
}

/// Two seconds from a start off the rest, each drive driven by a sine.
fn motion(model: &Model) -> Motion {
    let time_s: Vec<f64> = (0..=PERIODS).map(|k| k as f64 * PERIOD_S).collect();
    let wave = |joint: usize| -> Vec<f64> {
        let rate = 3.0 + joint as f64;
        time_s.iter().map(|t| 0.1 * (rate * t).sin()).collect()
    };
    let joints = model.joints.iter().enumerate();
    Motion {
        position_rad: vec![vec![0.0; time_s.len()]; model.link_count()],
        velocity_rad_s: vec![None; model.link_count()],
        input: joints
            .map(|(j, joint)| joint.drive.is_driven().then(|| wave(j)))
            .collect(),
        time_s,
        ..Motion::default()
    }
}

fn start(model: &Model) -> StartState {
    let joints = model.link_count();
    StartState {
        angle_rad: (0..joints).map(|joint| 0.6 - 0.3 * joint as f64).collect(),
        speed_rad_s: vec![0.0; joints],
        reading_slope: None,
    }
}

/// Per sample, the joints' relative angles, rad.
fn ours(model: &Model, motion: &Motion, start: &StartState) -> Vec<Vec<f64>> {
    let plant = Plant::new(model, motion);
    let samples = motion.len();
    let mut readings = vec![0.0; samples * plant.len()];
    let mut sensors = PlantMemory::default();
    predict(
        &plant,
        motion,
        0..samples,
        start,
        &mut sensors,
        &mut readings,
    );
    let row = |k: usize| -> Vec<f64> {
        let read: Vec<f64> = (0..plant.len())
            .map(|joint| readings[joint * samples + k])
            .collect();
        plant.decode_rad(&read)
    };
    (1..samples).map(row).collect()
}

/// What the script is asked, and the motion here.
fn case(model: &Model, text: &str, file: &Path) -> (Value, Vec<Vec<f64>>) {
    std::fs::write(file, text).unwrap();
    let (motion, start) = (motion(model), start(model));
    let inputs: Vec<Vec<f64>> = (0..PERIODS)
        .map(|k| {
            let inputs = motion.input.iter().flatten();
            inputs.map(|input| input[k]).collect()
        })
        .collect();
    let case = json!({
        "file": file, "start_rad": start.angle_rad, "period_s": PERIOD_S, "inputs": inputs,
    });
    (case, ours(model, &motion, &start))
}

/// A trolley on a slope, a boom that swings below it, and a load that slides across the boom's end.
const CRANE: &str = r#"
[rig]
name = "crane"
angle_zero = "horizontal"
step_s = 5e-4
[[link]]
length_m = 0.05
com_m = 0.02
mass_kg = 1.5
inertia_kg_m2 = 2e-3
[[link]]
length_m = 0.3
com_m = 0.15
mass_kg = 0.4
inertia_kg_m2 = 3e-3
[[link]]
com_m = 0.1
mass_kg = 0.3
inertia_kg_m2 = 1e-3
[[joint]]
axis = "slide"
slide_rad = 1.4
link_rad = 0.3
drive = "duty"
stall_force_n = 40.0
no_load_speed_m_s = 2.0
[[joint]]
drive = "passive"
[[joint]]
axis = "slide"
slide_rad = -1.2
link_rad = -0.5
drive = "position"
stall_force_n = 20.0
gain_per_m = 4.0
[[effect]]
kind = "viscous"
joint = 1
coefficient_n_s_m = 2.0
[[effect]]
kind = "armature"
joint = 1
inertia_kg = 0.5
[[effect]]
kind = "cable_spring"
joint = 3
stiffness_n_m = 30.0
rest_m = 0.1
[log]
time = { column = "t", unit = "s" }
[[log.joint]]
position = { column = "x", unit = "m" }
input = { column = "u", unit = "1" }
[[log.joint]]
position = { column = "q", unit = "rad" }
[[log.joint]]
position = { column = "z", unit = "m" }
input = { column = "goal", unit = "m" }
"#;

#[test]
fn exported_models_move_in_mujoco_as_here() {
    let Some(python) = python() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let (mut cases, mut expected) = (Vec::new(), Vec::new());
    let mut listed = Vec::new();
    for seed in 0..4 * KINDS.len() as u64 {
        let kind = KINDS[seed as usize % KINDS.len()];
        let motions = if seed % 3 == 2 {
            Motions::Hanging
        } else {
            Motions::Arm
        };
        // What MJCF lacks it lacks at every seed.
        if listed.contains(&(kind, motions)) {
            continue;
        }
        let Some(model) = model(motions, kind, seed) else {
            continue;
        };
        let exported = mjcf(&model);
        // These motions log no supply, so it does nothing.
        let mut missing = exported.not_carried.iter().map(|missing| &*missing.part);
        if missing.clone().any(|part| part != "nominal_supply_v") {
            if missing.any(|part| part == kind) {
                listed.push((kind, motions));
            }
            continue;
        }
        let file = folder.path().join(format!("{seed}.xml"));
        let (case, found) = case(&model, &exported.text, &file);
        cases.push(case);
        expected.push((format!("{kind} {seed}"), found));
    }
    let crane = Model::parse(CRANE, Path::new("crane.toml")).unwrap();
    let (case, found) = case(&crane, &mjcf(&crane).text, &folder.path().join("crane.xml"));
    cases.push(case);
    expected.push(("crane".to_string(), found));
    let theirs = answers(&python, "mjcf_trajectories.py", &cases);
    for ((name, ours), theirs) in expected.iter().zip(theirs) {
        let theirs: Vec<Vec<f64>> = serde_json::from_value(theirs).unwrap();
        for joint in 0..ours[0].len() {
            let column = || ours.iter().map(|row| row[joint]);
            let low = column().fold(f64::INFINITY, f64::min);
            let high = column().fold(f64::NEG_INFINITY, f64::max);
            let off = ours
                .iter()
                .zip(&theirs)
                .map(|(a, b)| (a[joint] - b[joint]).abs());
            let off = off.fold(0.0, f64::max) / (high - low);
            println!("{name}, joint {}: {:.2} %", joint + 1, 100.0 * off);
            assert!(
                off < 0.01,
                "{name}, joint {}: {off} of {}",
                joint + 1,
                high - low
            );
        }
    }
    println!(
        "{} compared; not carried, by effect and motions: {}",
        expected.len(),
        listed.len()
    );
    assert!(expected.len() >= 20, "{}", expected.len());
}
