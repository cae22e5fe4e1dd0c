//! Exported models move in MuJoCo as they do here.

use crate::simulators::{answers, python};
use handstand::Model;
use handstand::challenge::{KINDS, Motions, bench};
use handstand::log::Motion;
use handstand::model::export::mjcf;
use handstand::sim::{Plant, SensorState, Start, predict};
use serde_json::json;
use std::path::Path;

const PERIOD_S: f64 = 0.01;
const PERIODS: usize = 200;

/// A true model of the benchmark, in the units of its drives' motors and without a sensor's
/// rounding.
///
/// None where the library's effect cannot act at the joint that was drawn.
fn model(motions: Motions, kind: &'static str, seed: u64) -> Option<Model> {
    let bench = bench(motions, seed, &[kind])?;
    let mut model = Model::parse(&bench.true_model_toml, Path::new("true.toml")).ok()?;
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

fn start(model: &Model) -> Start {
    let joints = model.link_count();
    Start {
        angle_rad: (0..joints).map(|joint| 0.6 - 0.3 * joint as f64).collect(),
        speed_rad_s: vec![0.0; joints],
        reading_rad_s: None,
    }
}

/// Per sample, the joints' relative angles, rad.
fn ours(model: &Model, motion: &Motion, start: &Start) -> Vec<Vec<f64>> {
    let plant = Plant::new(model, motion);
    let samples = motion.len();
    let mut readings = vec![0.0; samples * plant.len()];
    let mut sensors = SensorState::default();
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
        std::fs::write(&file, &exported.text).unwrap();
        let (motion, start) = (motion(&model), start(&model));
        let inputs: Vec<Vec<f64>> = (0..PERIODS)
            .map(|k| {
                motion
                    .input
                    .iter()
                    .flatten()
                    .map(|input| input[k])
                    .collect()
            })
            .collect();
        cases.push(json!({
            "file": file, "start_rad": start.angle_rad, "period_s": PERIOD_S, "inputs": inputs,
        }));
        expected.push((format!("{kind} {seed}"), ours(&model, &motion, &start)));
    }
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
