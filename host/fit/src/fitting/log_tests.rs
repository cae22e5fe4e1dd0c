//! Logs as they are: gaps, rates alone, joints without any column, uneven stamps, slow and fast
//! sampling, filtered readings. Each time values are found that are hidden in the motion.

use super::*;
use crate::effects::named;
use crate::model::{ColumnMean, EffectInstance, MeasuredSignal, Model, ParameterPath};
use crate::motion::{Motion, Split};
use crate::sim::{Plant, PlantMemory, StartState, predict};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::Path;

/// A pendulum with friction, swung by hand: period 1.4 s.
pub(super) fn pendulum(columns: &str, torque_nm: f64) -> Model {
    let text = format!(
        "[rig]\nname = \"p\"\nangle_zero = \"hanging\"\nstep_s = 0.005\n\
         [[link]]\ncom_m = 0.1\nmass_kg = 0.2\ninertia_kg_m2 = 0.008\n\
         [[joint]]\ndrive = \"passive\"\n\
         [[effect]]\nkind = \"coulomb\"\njoint = 1\ntorque_nm = {torque_nm}\n\
         [log]\ntime = {{ column = \"t\", unit = \"s\" }}\n[[log.joint]]\n{columns}\n"
    );
    Model::parse(&text, Path::new("p.toml")).unwrap()
}

pub(super) const ANGLE: &str =
    "position = { column = \"q\", unit = \"rad\", resolution_rad = 0.001 }";
const RATE: &str = "velocity = { column = \"w\", unit = \"rad/s\", resolution_rad_s = 0.01 }";

/// What a model does from this angle, at these times, let go at rest: what it predicts goes into
/// the angles, or into the rates where it has those alone, or a sensor of them.
pub(super) fn swing(model: &Model, angle_rad: &[f64], time_s: Vec<f64>) -> Motion {
    driven(model, angle_rad, time_s, vec![None; angle_rad.len()])
}

/// The same of drives with these inputs.
pub(super) fn driven(
    model: &Model,
    angle_rad: &[f64],
    time_s: Vec<f64>,
    input: Vec<Option<Vec<f64>>>,
) -> Motion {
    let joints = model.link_count();
    let gaps = vec![f64::NAN; time_s.len()];
    let mut motion = Motion {
        name: format!("from {angle_rad:?}"),
        position_rad: vec![gaps; joints],
        velocity_rad_s: vec![None; joints],
        input,
        time_s,
        ..Motion::default()
    };
    let start = StartState {
        angle_rad: angle_rad.to_vec(),
        speed_rad_s: vec![0.0; joints],
        ..StartState::default()
    };
    let plant = Plant::new(model, &motion);
    let mut readings = vec![0.0; plant.signals() * motion.len()];
    let mut memory = PlantMemory::default();
    let whole = 0..motion.len();
    predict(&plant, &motion, whole, &start, &mut memory, &mut readings);
    let (of_joints, of_rates) = readings.split_at(joints * motion.len());
    for (joint, values) in of_joints.chunks(motion.len()).enumerate() {
        let columns = &model.log.joints[joint];
        let rounded = rounded(values, columns.measured());
        match columns.signal() {
            MeasuredSignal::Angle | MeasuredSignal::Displacement => {
                motion.position_rad[joint] = rounded;
            }
            MeasuredSignal::Rate => motion.velocity_rad_s[joint] = Some(rounded),
            MeasuredSignal::Nothing => {}
        }
    }
    motion.rate_rad_s = vec![None; joints];
    let rates = of_rates.chunks(motion.len());
    for (&joint, values) in plant.rate_joints().iter().zip(rates) {
        let read = rounded(values, model.log.joints[joint].rate.as_ref());
        motion.rate_rad_s[joint] = Some(read);
    }
    motion
}

fn rounded(values: &[f64], columns: Option<&ColumnMean>) -> Vec<f64> {
    let step = columns.and_then(ColumnMean::resolution).unwrap_or(1e-9);
    let rounded = values.iter().map(|value| (value / step).round() * step);
    rounded.collect()
}

pub(super) fn even(samples: u32, hz: f64) -> Vec<f64> {
    (0..samples).map(|k| f64::from(k) / hz).collect()
}

/// The friction that these motions of 0.006 N m tell a model of half as much.
fn friction(columns: &str, motions: Vec<Motion>) -> Refitted {
    let path: ParameterPath = "coulomb@1.torque_nm".parse().unwrap();
    let split = Split {
        training: motions,
        held_out: Vec::new(),
    };
    refit(&pendulum(columns, 0.003), &[path], &split, None, &|_| {}).unwrap()
}

fn assert_found(refitted: &Refitted, share: f64) {
    let value = &refitted.values[0];
    assert!((value.value / 0.006 - 1.0).abs() < share, "{value:?}");
    assert!(
        refitted.error.after_rad < 1.6 * refitted.error.floor_rad,
        "{:?}",
        refitted.error
    );
}

#[test]
fn a_rate_alone_tells_the_friction_from_any_start() {
    let truth = pendulum(RATE, 0.006);
    for begin in [1.0, -0.4, 2.6] {
        let motion = swing(&truth, &[begin], even(600, 100.0));
        let refitted = friction(RATE, vec![motion]);
        assert_found(&refitted, 0.02);
        // The floor is the rate's, rad/s.
        let floor = 0.01 / 12f64.sqrt();
        assert!((refitted.error.floor_rad / floor - 1.0).abs() < 0.2);
        assert_eq!(refitted.unobserved.len(), 2, "{:?}", refitted.unobserved);
    }
}

#[test]
fn missing_samples_are_not_compared_and_do_not_count() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut motion = swing(&pendulum(ANGLE, 0.006), &[1.0], even(600, 100.0));
    let whole = motion.clone();
    for angle in &mut motion.position_rad[0] {
        if random.random_bool(0.4) {
            *angle = f64::NAN;
        }
    }
    let missing = motion.position_rad[0].iter().filter(|q| q.is_nan()).count();
    let model = pendulum(ANGLE, 0.006);
    let data = |motion| FitProblem::new(&model, vec![motion], Horizon::Whole);
    let (gapped, all) = (data(motion.clone()), data(whole));
    assert_eq!(gapped.gaps(), missing);
    let count = |data: &FitProblem| fit_start_states(&model, data).residuals.count();
    assert_eq!(count(&gapped) + missing, count(&all));
    assert_found(&friction(ANGLE, vec![motion]), 0.02);
}

/// Some twenty samples to a period at least: with fewer a start state cannot be guessed.
#[test]
fn sampling_from_1_to_500_hz_tells_the_same() {
    let rigs = [
        (1.0, 60, 3.9),
        (5.0, 150, 0.15),
        (20.0, 200, 0.008),
        (100.0, 600, 0.008),
        (500.0, 3000, 0.008),
    ];
    for (hz, samples, inertia_kg_m2) in rigs {
        let rig = |torque_nm: f64| {
            let mut model = pendulum(ANGLE, torque_nm);
            model.links[0].inertia_kg_m2 = inertia_kg_m2;
            model
        };
        let split = Split {
            training: vec![swing(&rig(0.006), &[1.2], even(samples, hz))],
            held_out: Vec::new(),
        };
        let path: ParameterPath = "coulomb@1.torque_nm".parse().unwrap();
        let value = &refit(&rig(0.003), &[path], &split, None, &|_| {})
            .unwrap()
            .values[0];
        assert!(
            (value.value / 0.006 - 1.0).abs() < 0.03,
            "{hz} Hz: {value:?}"
        );
    }
}

/// Stamps that jitter by up to a third of the period.
fn jittering() -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    let mut stamp = |k: i32| 0.01 * (f64::from(k) + random.random_range(-0.33..0.33));
    (0..600).map(&mut stamp).collect()
}

#[test]
fn jittering_stamps_that_are_right_are_no_noise() {
    let motion = swing(&pendulum(ANGLE, 0.006), &[1.0], jittering());
    let refitted = friction(ANGLE, vec![motion]);
    assert_found(&refitted, 0.02);
    let floor = 0.001 / 12f64.sqrt();
    assert!(
        refitted.error.floor_rad < 1.5 * floor,
        "{:?}",
        refitted.error
    );
}

#[test]
fn the_error_of_wrong_stamps_is_in_the_noise() {
    // Sampled evenly, stamped unevenly: where the arm is fast, a reading is off by speed x jitter.
    let mut motion = swing(&pendulum(ANGLE, 0.006), &[1.0], even(600, 100.0));
    motion.time_s = jittering();
    let refitted = friction(ANGLE, vec![motion]);
    let error = refitted.error;
    // Errors of 2 ms at 2 rad/s.
    assert!((1.5e-3..8e-3).contains(&error.floor_rad), "{error:?}");
    assert!(error.after_rad < 2.0 * error.floor_rad, "{error:?}");
    let value = &refitted.values[0];
    assert!((value.value / 0.006 - 1.0).abs() < 0.1, "{value:?}");
}

#[test]
fn filtered_readings_have_a_floor_below_what_any_model_reaches() {
    let truth = pendulum(&ANGLE.replace("0.001", "0.02"), 0.006);
    let mut motion = swing(&truth, &[1.0], even(600, 100.0));
    let mut filtered = motion.position_rad[0][0];
    for angle in &mut motion.position_rad[0] {
        filtered += 0.3 * (*angle - filtered);
        *angle = filtered;
    }
    let refitted = friction(ANGLE, vec![motion]);
    let error = refitted.error;
    assert!(error.after_rad > 1.5 * error.floor_rad, "{error:?}");
}

#[test]
fn what_acts_on_a_joint_without_any_column_shows_in_the_other() {
    let double = |coefficient: f64, first: &str| {
        let text = format!(
            "[rig]\nname = \"d\"\nangle_zero = \"hanging\"\nstep_s = 0.005\n\
             [[link]]\nlength_m = 0.2\ncom_m = 0.1\nmass_kg = 0.3\ninertia_kg_m2 = 0.001\n\
             [[link]]\ncom_m = 0.1\nmass_kg = 0.2\ninertia_kg_m2 = 0.001\n\
             [[joint]]\ndrive = \"passive\"\n[[joint]]\ndrive = \"passive\"\n\
             [[effect]]\nkind = \"viscous\"\njoint = 1\n\
             coefficient_nm_s_rad = {coefficient}\n\
             [log]\ntime = {{ column = \"t\", unit = \"s\" }}\n\
             [[log.joint]]\n{first}\n[[log.joint]]\n{ANGLE}\n"
        );
        Model::parse(&text, Path::new("d.toml")).unwrap()
    };
    let path: ParameterPath = "viscous@1.coefficient_nm_s_rad".parse().unwrap();
    for (first, share) in [("", 0.05), (RATE, 0.03)] {
        let motion = swing(&double(0.006, first), &[0.0, 0.5], even(600, 100.0));
        let split = Split {
            training: vec![motion],
            held_out: Vec::new(),
        };
        let refitted = refit(&double(0.003, first), &[path], &split, None, &|_| {}).unwrap();
        let value = &refitted.values[0];
        assert!(
            (value.value / 0.006 - 1.0).abs() < share,
            "{first}: {value:?}"
        );
        assert!(refitted.unobserved[0].contains("Joint 1"));
    }
}

/// A gyro that reads 0.1 rad/s at rest, by which the integrated angle drifts by 4 rad, and one that
/// is filtered by 40 ms.
#[test]
fn a_rate_alone_tells_its_sensor_s_bias_and_lag() {
    for (id, key, hidden) in [
        ("rate_bias", "bias_rad_s", 0.1),
        ("sensor_lag", "time_constant_s", 0.04),
    ] {
        let with = |value: f64| {
            let mut model = pendulum(RATE, 0.006);
            model.effects.push(EffectInstance {
                effect: named(id).unwrap(),
                joint: Some(0),
                values: vec![value],
            });
            model
        };
        for begin in [1.0, -0.4] {
            let split = Split {
                training: vec![swing(&with(hidden), &[begin], even(4000, 100.0))],
                held_out: Vec::new(),
            };
            let path: ParameterPath = format!("{id}@1.{key}").parse().unwrap();
            let refitted = refit(&with(0.1 * hidden), &[path], &split, None, &|_| {}).unwrap();
            let value = &refitted.values[0];
            assert!((value.value / hidden - 1.0).abs() < 0.03, "{value:?}");
            let error = &refitted.error;
            assert!(error.after_rad < 1.3 * error.floor_rad, "{id}: {error:?}");
        }
    }
}
