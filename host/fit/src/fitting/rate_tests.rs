//! Joints with a rate sensor beside the one of their angle: both are compared, each by its noise.

use super::log_tests::{even, pendulum, swing};
use super::*;
use crate::compare::{compare, text};
use crate::effects::named;
use crate::model::{EffectInstance, MeasuredSignal, Model, ParameterPath};
use crate::motion::{Motion, Split};
use std::path::Path;

const COARSE: &str = "position = { column = \"q\", unit = \"rad\", resolution_rad = 0.02 }";
const GYRO: &str = "gyro = { column = \"w\", unit = \"rad/s\", resolution_rad_s = 0.005 }";

fn both() -> String {
    format!("{COARSE}\n{GYRO}")
}

fn with(columns: &str, id: &str, values: Vec<f64>) -> Model {
    let mut model = pendulum(columns, 0.006);
    model.effects.push(EffectInstance {
        effect: named(id).unwrap(),
        joint: Some(0),
        values,
    });
    model
}

fn refitted(model: &Model, path: &str, motion: Motion) -> Refitted {
    let split = Split {
        training: vec![motion],
        held_out: Vec::new(),
    };
    let path: ParameterPath = path.parse().unwrap();
    refit(model, &[path], &split, None, &|_| {}).unwrap()
}

#[test]
fn a_gyro_beside_the_angle_tells_its_bias_scale_and_lag() {
    for (id, key, hidden, given) in [
        ("rate_bias", "bias_rad_s", 0.05, 0.0),
        ("rate_scale", "factor", 0.95, 1.0),
        ("rate_lag", "time_constant_s", 0.02, 0.002),
    ] {
        let motion = swing(&with(&both(), id, vec![hidden]), &[1.0], even(1000, 100.0));
        let path = format!("{id}@1.{key}");
        let found = refitted(&with(&both(), id, vec![given]), &path, motion);
        let value = &found.values[0];
        assert!((value.value / hidden - 1.0).abs() < 0.02, "{id}: {value:?}");
        let (low, high) = (value.low, value.high);
        assert!(high - low < 0.1 * hidden, "{id}: {value:?}");
    }
}

#[test]
fn a_gyro_narrows_what_a_coarse_angle_tells_of_friction() {
    let motion = swing(&pendulum(&both(), 0.006), &[1.0], even(600, 100.0));
    let width = |columns: &str| {
        let path = "coulomb@1.torque_nm";
        let value = refitted(&pendulum(columns, 0.003), path, motion.clone()).values[0].clone();
        assert!((value.value / 0.006 - 1.0).abs() < 0.05, "{value:?}");
        value.high - value.low
    };
    let (alone, beside) = (width(COARSE), width(&both()));
    assert!(beside < 0.5 * alone, "{beside} {alone}");
}

#[test]
fn a_gyro_is_a_line_of_its_own_in_rad_per_second() {
    let motion = swing(
        &with(&both(), "rate_bias", vec![0.05]),
        &[1.0],
        even(600, 100.0),
    );
    let compared = compare(&pendulum(&both(), 0.006), "p.toml", &[motion], None);
    let [angle, rate] = &compared.signals[..] else {
        panic!("{:?}", compared.signals);
    };
    assert_eq!((angle.joint, rate.joint), (1, 1));
    assert_eq!(rate.quantity, MeasuredSignal::Rate);
    assert!(rate.beside_angle && !angle.beside_angle);
    assert!((rate.rms / 0.05 - 1.0).abs() < 0.05, "{rate:?}");
    assert!(angle.rms < 1.5 * angle.floor, "{angle:?}");
    // The error of the whole log stays one of angles.
    assert_eq!(compared.quantity(), MeasuredSignal::Angle);
    assert_eq!(compared.horizons.last().unwrap().rms, angle.rms);
    let said = text(&[compared], &crate::model::JointNames::default());
    for line in [
        "joint 1: rms, mrad ",
        "joint 1, rate: rms, mrad/s ",
        "Not passed, joint 1, rate",
    ] {
        assert!(said.contains(line), "{line}\n{said}");
    }
}

#[test]
fn a_log_without_what_the_model_s_gyro_reads_is_compared_by_its_angles() {
    let mut motion = swing(&pendulum(&both(), 0.006), &[1.0], even(600, 100.0));
    motion.rate_rad_s.clear();
    let of = |columns: &str| {
        let path = "coulomb@1.torque_nm";
        refitted(&pendulum(columns, 0.003), path, motion.clone()).values[0].value
    };
    assert_eq!(of(&both()), of(COARSE));
}

#[test]
fn a_late_angle_of_a_free_pendulum_shows_beside_its_gyro_alone() {
    let late = |columns: &str, by_s: f64| with(columns, "time_offset", vec![by_s]);
    let motion = swing(&late(&both(), 0.015), &[1.0], even(600, 100.0));
    let path = "time_offset@1.offset_s";
    let value = &refitted(&late(&both(), 0.0), path, motion).values[0];
    assert!((value.value / 0.015 - 1.0).abs() < 0.02, "{value:?}");
}

/// Two links that swing freely; the second has a rate sensor.
fn double(angles: &str, sensor: &str) -> Model {
    let text = format!(
        "[rig]\nname = \"d\"\nangle_zero = \"hanging\"\nangles = \"{angles}\"\n\
         [[link]]\nlength_m = 0.2\ncom_m = 0.1\nmass_kg = 0.3\ninertia_kg_m2 = 0.001\n\
         [[link]]\ncom_m = 0.1\nmass_kg = 0.2\ninertia_kg_m2 = 0.001\n\
         [[joint]]\ndrive = \"passive\"\n[[joint]]\ndrive = \"passive\"\n\
         [log]\ntime = {{ column = \"t\", unit = \"s\" }}\n\
         [[log.joint]]\nposition = {{ column = \"q1\", unit = \"rad\" }}\n\
         [[log.joint]]\nposition = {{ column = \"q2\", unit = \"rad\" }}\n\
         {sensor} = {{ column = \"w2\", unit = \"rad/s\" }}\n"
    );
    Model::parse(&text, Path::new("d.toml")).unwrap()
}

#[test]
fn a_gyro_reads_the_rate_of_its_link_and_a_tachometer_that_of_its_joint() {
    for angles in ["relative", "absolute"] {
        for sensor in ["gyro", "tachometer"] {
            let model = double(angles, sensor);
            let motion = swing(&model, &[0.5, -0.2], even(300, 100.0));
            let slope = |joint: usize, k: usize| {
                let q = &motion.position_rad[joint];
                (q[k + 1] - q[k - 1]) / (motion.time_s[k + 1] - motion.time_s[k - 1])
            };
            for k in (20..280).step_by(20) {
                let (first, second) = (slope(0, k), slope(1, k));
                let expected = match (angles, sensor) {
                    ("relative", "gyro") => first + second,
                    ("absolute", "tachometer") => second - first,
                    _ => second,
                };
                let read = motion.rate(1).unwrap()[k];
                assert!(
                    (read - expected).abs() < 0.02,
                    "{angles} {sensor}: {read} {expected}"
                );
            }
        }
    }
}

#[test]
fn other_readings_take_the_place_of_what_is_measured() {
    const RATE: &str = "velocity = { column = \"w\", unit = \"rad/s\" }";
    for columns in [COARSE, RATE, &both()] {
        let model = pendulum(columns, 0.006);
        let motion = swing(&model, &[1.0], even(100, 100.0));
        let data = FitProblem::new(&model, vec![motion], Horizon::Whole);
        let length = data.signals.len() * data.windows[0].samples.len();
        let other = data.clone().measuring(&[vec![vec![0.25; length]]]);
        for signal in 0..data.signals.len() {
            assert_eq!(other.measured(0, signal), [0.25; 100], "{columns}");
        }
    }
}
