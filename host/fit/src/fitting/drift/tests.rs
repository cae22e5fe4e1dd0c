use super::*;
use crate::fitting::told_values::blind;
use crate::fitting::{FitOptions, fit};
use crate::motion::MotionSource;
use crate::sim::{Plant, PlantMemory, StartState, predict};
use std::path::Path;

fn value(of: &str, value: f64, error: f64) -> OneValue {
    OneValue {
        of: of.to_string(),
        fitted: FittedValue {
            path: "coulomb@1.torque_nm".to_string(),
            key: "torque_nm".to_string(),
            unit: "N m".to_string(),
            value,
            low: value - HALF_WIDTH * error,
            high: value + HALF_WIDTH * error,
            on_bound: false,
        },
        stands_out: false,
    }
}

fn group(values: &[f64], error: f64) -> (String, Vec<OneValue>) {
    let values = values.iter().enumerate();
    let values = values.map(|(k, v)| value(&format!("log{k}"), *v, error));
    ("coulomb@1.torque_nm".to_string(), values.collect())
}

#[test]
fn the_statistic_is_cochrans() {
    // Mean 3, deviations -1, 0, 1 of standard error 0.5: Q = 8 with 2 degrees of freedom.
    let drift = homogeneity(group(&[2.0, 3.0, 4.0], 0.5), 1);
    assert!((drift.mean - 3.0).abs() < 1e-12);
    let expected = (-4.0_f64).exp();
    assert!(
        (drift.probability.unwrap() - expected).abs() < 1e-9,
        "{drift:?}"
    );
}

#[test]
fn one_worn_servo_stands_out_and_the_others_do_not() {
    let mut values = vec![0.030, 0.031, 0.029, 0.0305, 0.0298, 0.060];
    let drifts = tested(vec![group(&values, 0.001)]);
    assert!(drifts[0].differ);
    let out: Vec<bool> = drifts[0]
        .values
        .iter()
        .map(|value| value.stands_out)
        .collect();
    assert_eq!(out, [false, false, false, false, false, true]);
    // Without it all agree.
    values.pop();
    let agreeing = tested(vec![group(&values, 0.001)]);
    assert!(!agreeing[0].differ);
    assert!(agreeing[0].values.iter().all(|value| !value.stands_out));
}

/// Which of these values stand out, each with a standard error.
fn out(values: &[(f64, f64)]) -> Vec<bool> {
    let named = values
        .iter()
        .enumerate()
        .map(|(k, (v, error))| value(&format!("log{k}"), *v, *error));
    let drift = homogeneity(("coulomb@1.torque_nm".to_string(), named.collect()), 1);
    drift.values.iter().map(|value| value.stands_out).collect()
}

#[test]
fn an_outlier_does_not_make_those_that_agree_stand_out() {
    let equal = (0.03, 0.001);
    // However certain the outlier is of itself, and however much it draws the mean.
    for error in [1e-5, 1e-3, 5e-3] {
        let values = [equal, equal, equal, (0.09, error)];
        assert_eq!(out(&values), [false, false, false, true], "{error}");
    }
    let two = [equal, (0.09, 0.001), equal, (0.06, 0.001), equal];
    assert_eq!(out(&two), [false, true, false, true, false]);
}

#[test]
fn where_no_more_than_half_agree_none_stands_out() {
    let (low, high) = ((0.03, 0.001), (0.09, 0.001));
    assert_eq!(out(&[low, high]), [false; 2]);
    assert_eq!(out(&[low, low, high, high]), [false; 4]);
    assert_eq!(out(&[low]), [false]);
}

#[test]
fn more_values_ask_for_more_proof() {
    // Q = 4.5 with one degree of freedom: 3.4 %.
    let apart = || group(&[0.0, 3.0], 1.0);
    assert!(tested(vec![apart()])[0].differ);
    let same = || group(&[1.0, 1.0], 1.0);
    let among = tested(vec![apart(), same(), same()]);
    assert!(among.iter().all(|drift| !drift.differ), "{among:?}");
}

#[test]
fn joints_are_compared_by_effect_and_key() {
    let paths: Vec<ParameterPath> = [
        "coulomb@1.torque_nm",
        "coulomb@2.torque_nm",
        "link1.com_m",
        "delay@2.delay_s",
    ]
    .map(|path| path.parse().unwrap())
    .to_vec();
    let sessions: Vec<Drift> = [0.03, 0.09, 0.1, 0.01]
        .map(|v| homogeneity(group(&[v, v], 0.001), 4))
        .to_vec();
    let groups = between_joints(&paths, &sessions);
    assert_eq!(groups.len(), 1);
    assert_eq!(groups[0].0, "coulomb.torque_nm");
    let joints: Vec<&str> = groups[0].1.iter().map(|value| value.of.as_str()).collect();
    assert_eq!(joints, ["joint1", "joint2"]);
    let (first, error) = (&groups[0].1[0].fitted, 0.001 / 2.0_f64.sqrt());
    assert!((first.high - first.value - HALF_WIDTH * error).abs() < 1e-12);
    assert!(tested(groups)[0].differ);
}

const ARM: &str = r#"
[rig]
name = "arm"
angle_zero = "hanging"

[[link]]
com_m = 0.1
mass_kg = 0.2
inertia_kg_m2 = 1e-3

[[joint]]
drive = "duty"
stall_torque_nm = 1.5
no_load_speed_rad_s = 6.0

[[effect]]
kind = "dead_zone"
joint = 1
width = 0.05
punch = 0.0

[log]
time = { column = "t", unit = "s" }

[[log.joint]]
position = { column = "q", unit = "rad", resolution_rad = 0.001 }
input = { column = "u", unit = "1" }
"#;

/// A motion under this duty, as the model has it.
fn driven(model: &Model, duty: impl Fn(f64) -> f64) -> Motion {
    let time_s: Vec<f64> = (0..300).map(|k| f64::from(k) * 0.01).collect();
    let mut motion = Motion {
        name: "a".to_string(),
        source: MotionSource {
            path: "a.csv".into(),
            sha256: "0".into(),
            lines: (1, 300),
        },
        position_rad: vec![vec![0.0; time_s.len()]],
        velocity_rad_s: vec![None],
        rate_rad_s: Vec::new(),
        input: vec![Some(time_s.iter().map(|t| duty(*t)).collect())],
        time_s,
        supply_v: None,
        torque_on: None,
        payload_kg: 0.0,
        turned: false,
    };
    let start = StartState {
        angle_rad: vec![0.1],
        speed_rad_s: vec![0.0],
        ..StartState::default()
    };
    let mut readings = vec![0.0; motion.len()];
    let (plant, whole) = (Plant::new(model, &motion), 0..motion.len());
    let mut memory = PlantMemory::default();
    predict(&plant, &motion, whole, &start, &mut memory, &mut readings);
    let rounded = readings.iter().map(|rad| (rad / 0.001).round() * 0.001);
    motion.position_rad[0] = rounded.collect();
    motion
}

/// Commands that are full or none tell a dead zone's punch, of its width nothing.
#[test]
fn what_shows_nothing_beside_others_of_its_effect_is_held_as_by_a_fit() {
    let model = Model::parse(ARM, Path::new("arm.toml")).unwrap();
    let mut truth = model.clone();
    truth.effects[0].values = vec![0.08, 0.03];
    let bang = |t: f64| [0.0, 0.3, 0.0, -0.3][(2.0 * t) as usize % 4];
    let session = |name: &str, motion| DriftSession {
        name: name.to_string(),
        motions: vec![motion],
    };
    let sessions = [
        session("bang", driven(&truth, bang)),
        session("bang again", driven(&truth, |t| -bang(t))),
    ];
    let free: Vec<ParameterPath> = ["dead_zone@1.width", "dead_zone@1.punch"]
        .map(|path| path.parse().unwrap())
        .to_vec();
    let found = drift(&model, &free, &sessions, None);
    assert!(found.refused.is_empty(), "{:?}", found.refused);
    let held: Vec<&str> = found.held.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(held, ["bang", "bang again"]);
    assert!(
        found.held[0]
            .1
            .contains("`dead_zone@1.width` changes nothing"),
        "{found:?}"
    );
    // Held in every session, a value is none.
    let [punch] = &found.sessions[..] else {
        panic!("{found:?}");
    };
    assert_eq!(
        (punch.path.as_str(), punch.values.len()),
        ("dead_zone@1.punch", 2)
    );
    assert!(
        (punch.mean - 0.03).abs() < 2e-3 && !punch.differ,
        "{punch:?}"
    );
}

/// A step of a thousandth moves no sample across the width; the derivative's does.
#[test]
fn a_width_that_a_ramp_of_duty_shows_is_not_blind() {
    let mut truth = Model::parse(ARM, Path::new("arm.toml")).unwrap();
    truth.effects[0].values = vec![0.0803, 0.03];
    let ramp = driven(&truth, |t| 0.2 * t - 0.3);
    let data = FitProblem::new(&truth, vec![ramp], Horizon::Whole);
    let free: Vec<ParameterPath> = ["dead_zone@1.width", "dead_zone@1.punch"]
        .map(|path| path.parse().unwrap())
        .to_vec();
    let found = fit(&truth, &free, &data, None, FitOptions::iterations(0));
    assert_eq!(blind(&found, &data), []);
}
