//! An arm that a torque turns: its model knows no friction, and whirls where the arm swings.

use super::tests::{REACH, silent};
use crate::diagnose::DiagnoseOptions;
use crate::diagnose::evaluator::Evaluator;
use crate::model::Model;
use crate::motion::Motion;
use handstand_sim::sim::{Plant, PlantMemory, StartState, predict};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;
use std::path::Path;

const ARM: &str = r#"
[rig]
name = "arm"
angle_zero = "hanging"

[[link]]
length_m = 0.25
com_m = 0.125
mass_kg = 0.3
inertia_kg_m2 = 1.6e-3

[[joint]]
drive = "torque"

[log]
time = { column = "t_s", unit = "s" }

[[log.joint]]
position = { column = "q_rad", unit = "rad", resolution_rad = 1e-4 }
input = { column = "torque_nm", unit = "N m" }
"#;

const FRICTION: &str = "[[effect]]\nkind = \"coulomb\"\njoint = 1\ntorque_nm = 0.02\n";

/// Ten seconds at 100 Hz of the arm that rubs, under a torque of three sines.
fn measured(seed: u64) -> Motion {
    let truth = Model::parse(&format!("{ARM}{FRICTION}"), Path::new("truth.toml")).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let sines = [0.3, 0.7, 1.3].map(|frequency_hz| {
        let (torque_nm, phase) = (
            random.random_range(0.05..0.2),
            random.random_range(0.0..TAU),
        );
        move |t: f64| torque_nm * (TAU * frequency_hz * t + phase).sin()
    });
    let time_s: Vec<f64> = (0..1000).map(|k| 0.01 * f64::from(k)).collect();
    let torque_nm = (time_s.iter()).map(|t| sines.iter().map(|sine| sine(*t)).sum());
    let mut motion = Motion {
        position_rad: vec![vec![0.0; time_s.len()]],
        velocity_rad_s: vec![None],
        rate_rad_s: vec![None],
        input: vec![Some(torque_nm.collect())],
        time_s,
        ..Motion::default()
    };
    let start = StartState {
        angle_rad: vec![0.0],
        speed_rad_s: vec![0.0],
        reading_slope: None,
    };
    let (plant, mut memory) = (Plant::new(&truth, &motion), PlantMemory::default());
    let mut read_rad = vec![0.0; motion.len()];
    let all = 0..motion.len();
    predict(&plant, &motion, all, &start, &mut memory, &mut read_rad);
    let noisy = read_rad
        .iter()
        .map(|q| q + random.random_range(-3.5e-4..3.5e-4));
    motion.position_rad = vec![noisy.collect()];
    motion
}

/// Coulomb friction alone ends in a false valley; pre-sliding friction comes near, as stiff as it
/// may be, which is Coulomb friction.
#[test]
fn what_a_law_comes_to_on_its_bound_is_found() {
    let model = Model::parse(ARM, Path::new("arm.toml")).unwrap();
    let [a, b, c] = [0, 1, 2].map(measured);
    let options = DiagnoseOptions::default();
    let mut evaluator = Evaluator::new(&model, vec![a, b], vec![c], &options, REACH, silent());
    let mut singles = evaluator.singles();
    assert_eq!(singles[0].names(), ["pre_sliding@1"]);
    assert_eq!(singles[0].effects_on_bound(), [0]);
    assert!(evaluator.accepted(&evaluator.base, &singles).is_none());
    evaluator.put_plainer(&mut singles);
    let best = evaluator.accepted(&evaluator.base, &singles).unwrap();
    assert_eq!(best.names(), ["coulomb@1"]);
    assert!(evaluator.is_explained_by(best));
    assert!((best.added_effect(0).values[0] - 0.02).abs() < 1e-5);
}
