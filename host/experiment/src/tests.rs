//! Explanations that are known to look alike, on one arm.

use super::candidates::with_payload_place;
use super::inputs::at_rest;
use super::limits::ExperimentLimits;
use super::proposal::{ExperimentProposal, RivalName};
use super::propose::{ProposeOptions, parted, propose_values};
use super::rival::Rival;
use super::tighten::Criterion;
use crate::fitting::{Candidate, FitProblem, Horizon};
use crate::model::{Model, ParameterPath};
use crate::motion::Motion;
use crate::sim::{Plant, PlantMemory, predict};
use handstand_model::effects;
use std::f64::consts::TAU;
use std::path::Path;

const ARM: &str = r#"[rig]
name = "arm"
angle_zero = "hanging"

[[link]]
length_m = 0.15
com_m = 0.09
mass_kg = 0.25
inertia_kg_m2 = 6e-4

[[joint]]
drive = "duty"
stall_torque_nm = 1.5
nominal_supply_v = 9.8

[[effect]]
kind = "viscous"
joint = 1
coefficient_nm_s_rad = 0.012

[[effect]]
kind = "coulomb"
joint = 1
torque_nm = 0.02

[fit]
free = ["viscous@1.coefficient_nm_s_rad", "coulomb@1.torque_nm"]

[log]
time = { column = "time_s", unit = "s" }
torque_on = "torque_on"

[[log.joint]]
position = { column = "q1_rad", unit = "rad", resolution_rad = 0.005 }
input = { column = "duty", unit = "1" }
"#;

fn arm() -> Model {
    with_payload_place(&Model::parse(ARM, Path::new("arm.toml")).unwrap())
}

/// The arm with an effect, its values free beside the arm's own.
fn with(id: &str, values: &[f64]) -> (Model, Vec<ParameterPath>) {
    let mut model = arm();
    let effect = Candidate {
        effect: effects::named(id).unwrap(),
        joint: (id != "base_tilt").then_some(0),
    };
    model.effects.push(effect.instance(values));
    let mut free = model.free.clone();
    free.extend(effect.paths());
    (model, free)
}

/// A swing of a model, read by an encoder in steps of 5 mrad: what the logs hold.
fn swing(model: &Model) -> Motion {
    let time_s: Vec<f64> = (0..800).map(|k| 0.01 * f64::from(k)).collect();
    let duty = |t: &f64| 0.12 * (TAU * 0.6 * t).sin() + 0.06 * (TAU * 1.7 * t).sin();
    let mut motion = Motion {
        name: "swing".to_string(),
        position_rad: vec![vec![f64::NAN; time_s.len()]],
        velocity_rad_s: vec![None],
        input: vec![Some(time_s.iter().map(duty).collect())],
        time_s,
        ..Motion::default()
    };
    let plant = Plant::new(model, &motion);
    let mut readings = vec![0.0; motion.len()];
    let start = at_rest(&plant, &[0.0]);
    let (all, memory) = (0..motion.len(), &mut PlantMemory::default());
    predict(&plant, &motion, all, &start, memory, &mut readings);
    motion.position_rad[0] = readings
        .iter()
        .map(|q| 0.005 * (q / 0.005).round())
        .collect();
    motion
}

fn options(logs: &FitProblem, mass_kg: Option<f64>) -> ProposeOptions {
    ProposeOptions {
        limits: ExperimentLimits {
            low_rad: vec![-1.3],
            high_rad: vec![1.3],
            speed_rad_s: vec![12.0],
            ..ExperimentLimits::of_logs(&arm(), &logs.motions, 10.0)
        },
        mass_kg,
        criterion: Criterion::D,
        seed: 1,
    }
}

/// What is proposed where these are left, the first being true.
fn proposal(left: &[(Model, Vec<ParameterPath>)], mass_kg: Option<f64>) -> ExperimentProposal {
    let logs = FitProblem::new(&left[0].0, vec![swing(&left[0].0)], Horizon::Whole);
    let rivals = left.iter().map(|(model, free)| {
        let added: Vec<String> = free[2..].iter().map(ToString::to_string).collect();
        let name = RivalName {
            effects: Vec::new(),
            name: added.join(" + "),
            values: added,
        };
        Rival::fitted(name, model, free, &logs)
    });
    let rivals: Vec<Rival> = rivals.collect();
    parted(&rivals, &logs, Horizon::Whole, &options(&logs, mass_kg)).unwrap()
}

#[test]
fn a_heavier_arm_and_a_weaker_drive_are_parted_by_a_known_mass() {
    let left = [with("mass", &[0.05]), with("torque_scale", &[0.83])];
    let found = proposal(&left, None);
    let experiment = found.experiment.expect("a known mass parts them");
    assert!(experiment.condition.payload_kg > 0.0, "{experiment:?}");
    assert!(experiment.instructions[0].starts_with("Add a known mass of"));
    assert!(found.separations[0].parted, "{:?}", found.separations);
    // Without a mass at hand nothing parts them.
    let without = proposal(&left, Some(0.0));
    assert!(without.experiment.is_none(), "{without:?}");
}

#[test]
fn a_late_command_and_a_slow_sensor_are_parted_by_a_motion_alone() {
    let left = [with("delay", &[0.04]), with("sensor_lag", &[0.04])];
    let found = proposal(&left, None);
    let experiment = found.experiment.expect("a motion parts them");
    assert_eq!(experiment.condition.changes(), 0, "{experiment:?}");
    assert!(experiment.instructions.is_empty());
}

#[test]
fn a_tilted_base_and_a_turned_encoder_are_parted_by_turning_the_rig() {
    let left = [with("base_tilt", &[0.08]), with("encoder_zero", &[0.08])];
    let found = proposal(&left, None);
    let experiment = found.experiment.expect("turning the rig parts them");
    assert!(experiment.condition.turned, "{experiment:?}");
}

#[test]
fn no_motion_parts_a_rotor_from_the_inertia_of_the_link() {
    let (mut heavy, mut free) = (arm(), arm().free);
    heavy.links[0].inertia_kg_m2 += 1e-3;
    free.push("link1.inertia_kg_m2".parse().unwrap());
    let found = proposal(&[with("armature", &[1e-3]), (heavy, free)], None);
    assert!(found.experiment.is_none(), "{:?}", found.separations);
    let measured = &found.measure[0];
    assert_eq!(measured.path, "link1.inertia_kg_m2");
    assert!(measured.instruction.contains("swing link 1"));
}

#[test]
fn a_value_gets_tighter_where_it_shows_most() {
    let model = arm();
    let motions = vec![swing(&model)];
    let logs = FitProblem::new(&model, motions.clone(), Horizon::Whole);
    let value: ParameterPath = "viscous@1.coefficient_nm_s_rad".parse().unwrap();
    let options = options(&logs, None);
    let found = propose_values(&model, &[value], motions, Horizon::Whole, &options).unwrap();
    let tightened = &found.values[0];
    let ratio = tightened.standard_error_after / tightened.standard_error_before;
    assert!(ratio < 0.8, "{tightened:?}");
    // A motion at rest would say nothing of friction in motion.
    let experiment = found.experiment.unwrap();
    let q = &experiment.motion.position_rad[0];
    let range = q.iter().fold(0.0, |most: f64, q| most.max(q.abs()));
    assert!(range > 0.5, "{range}");
}

#[test]
fn no_explanation_leaves_the_limits() {
    let left = [with("mass", &[0.05]), with("torque_scale", &[0.83])];
    let logs = FitProblem::new(&left[0].0, vec![swing(&left[0].0)], Horizon::Whole);
    let mut narrow = options(&logs, None);
    narrow.limits.speed_rad_s = vec![1e-3];
    let rivals: Vec<Rival> = left
        .iter()
        .map(|(model, free)| Rival::fitted(RivalName::of(&[], &[]), model, free, &logs))
        .collect();
    match parted(&rivals, &logs, Horizon::Whole, &narrow) {
        Ok(found) => {
            assert_eq!(found.within_limits, 0);
            assert!(found.experiment.is_none());
        }
        Err(error) => assert_eq!(error.exit_code(), 2),
    }
}

#[test]
fn without_logs_driven_joints_move_about_the_log_s_zero_and_others_as_they_may() {
    let upright = ARM.replace("angle_zero = \"hanging\"", "angle_zero = \"upright\"");
    let model = Model::parse(&upright, Path::new("arm.toml")).unwrap();
    let limits = ExperimentLimits::of_model(&model, (0.5, 2.0), 100.0);
    assert_eq!((limits.low_rad[0], limits.high_rad[0]), (-0.5, 0.5));
    let mut passive = model;
    passive.joints[0].drive = handstand_model::model::Drive::Passive;
    let limits = ExperimentLimits::of_model(&passive, (0.5, 2.0), 100.0);
    let freely = (f64::NEG_INFINITY, f64::INFINITY);
    assert_eq!((limits.low_rad[0], limits.speed_rad_s[0]), freely);
}
