use super::super::{ModelFile, findings};
use super::*;
use crate::log::{LogRequest, Severity};
use crate::motion::MotionSource;
use handstand_sim::sim::{Plant, PlantMemory, StartState, predict};
use std::f64::consts::TAU;
use std::path::Path;

#[test]
fn units_of_one_input_do_not_crowd_out_other_corrections() {
    let tried = |correction| Trial {
        correction,
        before: 1.0,
        after: 0.5,
        before_rad: 1.0,
        after_rad: 0.5,
        better: 1.0,
        own: None,
    };
    let unit = Unit::named("N m", None).unwrap();
    let input = |joint| tried(Correction::Unit(vec![(LogColumn::Input(joint), unit)]));
    let reversed = tried(Correction::Reverse(vec![LogColumn::Input(0)]));
    let mut sorted: Vec<Trial> = (0..JUDGED).map(|_| input(0)).collect();
    sorted.extend([input(1), reversed.clone()]);
    let kept = most_promising(sorted);
    assert_eq!(kept, [input(0), input(0), input(1), reversed]);
}

/// The file of a chain of six servos.
fn long_chain_file() -> String {
    let mut text = String::from("[rig]\nname = \"long\"\nangle_zero = \"hanging\"\n");
    for _ in 0..6 {
        text += "[[link]]\nlength_m = 0.1\ncom_m = 0.05\nmass_kg = 0.05\ninertia_kg_m2 = 2e-3\n\
                 [[joint]]\ndrive = \"position\"\ngain_per_rad = 3.0\nstall_torque_nm = 0.8\n\
                 no_load_speed_rad_s = 6.0\n";
    }
    text += "[log]\ntime = { column = \"t\", unit = \"s\" }\n";
    for joint in 1..=6 {
        text += &format!(
            "[[log.joint]]\nposition = {{ column = \"q{joint}\", unit = \"rad\" }}\n\
             input = {{ column = \"goal{joint}\", unit = \"rad\" }}\n"
        );
    }
    text
}

/// The chain, its servos following goals of their own speeds as its model says.
fn long_chain() -> (Model, Motion) {
    moved(&long_chain_file())
}

/// The model of a file of six servos, and a motion of it.
fn moved(file: &str) -> (Model, Motion) {
    let model = Model::parse(file, Path::new("long.toml")).unwrap();
    let time_s: Vec<f64> = (0..300).map(|k| 0.01 * f64::from(k)).collect();
    let goal = |joint: usize| {
        let rate = 1.5 + 0.7 * joint as f64;
        let goals = time_s.iter().map(|t| 0.5 * (rate * t).sin());
        Some(goals.collect())
    };
    let mut motion = Motion {
        name: "long".into(),
        source: MotionSource {
            path: "long.csv".into(),
            sha256: String::new(),
            lines: (2, 301),
        },
        position_rad: vec![vec![0.0; 300]; 6],
        velocity_rad_s: vec![None; 6],
        rate_rad_s: vec![None; 6],
        input: (0..6).map(goal).collect(),
        supply_v: None,
        torque_on: None,
        payload_kg: 0.0,
        turned: false,
        time_s,
    };
    let start = StartState {
        angle_rad: vec![0.0; 6],
        speed_rad_s: vec![0.0; 6],
        reading_slope: None,
    };
    let plant = Plant::new(&model, &motion);
    let mut readings = vec![0.0; 6 * 300];
    let memory = &mut PlantMemory::default();
    predict(&plant, &motion, 0..300, &start, memory, &mut readings);
    for (position, read) in motion.position_rad.iter_mut().zip(readings.chunks(300)) {
        *position = read.to_vec();
    }
    (model, motion)
}

/// All samples and a look at each reading's growth would take minutes.
#[test]
fn a_long_chain_is_judged_on_what_it_can_afford() {
    let (model, mut motion) = long_chain();
    assert!(is_long(&model));
    assert_eq!(affordable(SAMPLES, &model), 1777);
    assert_eq!(search(&model, std::slice::from_ref(&motion)), []);
    motion.position_rad[3].iter_mut().for_each(|q| *q = -*q);
    let found = search(&model, &[motion]);
    let corrections: Vec<_> = found.iter().map(|fault| &fault.trial.correction).collect();
    let reversed = Correction::Reverse(vec![LogColumn::Position(3)]);
    assert_eq!(corrections, [&reversed]);
}

/// The motion with a joint's angle and goal written otherwise.
fn calibrated(motion: &Motion, joint: usize, written: impl Fn(f64) -> f64) -> Motion {
    let mut motion = motion.clone();
    let goals = motion.input[joint].iter_mut().flatten();
    for value in motion.position_rad[joint].iter_mut().chain(goals) {
        *value = written(*value);
    }
    motion
}

/// Gravity alone tells how a servo that regulates its angle is calibrated.
#[test]
fn another_calibration_of_a_servo_is_told_from_both_of_its_columns() {
    let (model, motion) = long_chain();
    let found = |written: &dyn Fn(f64) -> f64| {
        let spoiled = calibrated(&motion, 2, written);
        let mut found = search(&model, &[spoiled]);
        assert_eq!(found.len(), 1, "{found:?}");
        let fault = found.remove(0);
        assert_eq!(fault.trial.correction.calibrates(), Some(2), "{fault:?}");
        fault
    };
    let reversed = found(&|q| -q).trial.correction;
    assert!(matches!(reversed, Correction::Reverse(_)), "{reversed:?}");

    let Correction::Unit(columns) = found(&f64::to_degrees).trial.correction else {
        panic!("no unit");
    };
    assert!(columns.iter().all(|(_, unit)| unit.name == "deg"));

    let moved = found(&|q| q + 0.6);
    let zero = moved.zero.unwrap();
    assert!((zero.added + 0.6).abs() < 0.01, "{zero:?}");
    let [low, high] = zero.interval;
    assert!(low <= -0.6 && -0.6 <= high && high - low < 0.05, "{zero:?}");
}

/// An angle that was read earlier would look like it.
#[test]
fn a_drive_that_acts_late_is_left_to_diagnosis() {
    let (model, _) = long_chain();
    let late = "[[effect]]\nkind = \"delay\"\njoint = 3\ndelay_s = 0.05\n";
    let (_, motion) = moved(&long_chain_file().replace("[log]", &format!("{late}[log]")));
    assert_eq!(search(&model, &[motion]), []);
}

/// Read in a wrong unit, an angle seems to wrap and to lie far from its goal.
#[test]
fn rows_are_judged_in_the_units_that_were_found() {
    let (model, motion) = long_chain();
    let spoiled = calibrated(&motion, 2, |q| (q / TAU * 4096.0).round());
    let mut csv = String::from("t");
    (1..=6).for_each(|joint| csv += &format!(",q{joint},goal{joint}"));
    for (row, time_s) in spoiled.time_s.iter().enumerate() {
        csv += &format!("\n{time_s}");
        for joint in 0..6 {
            let goal = spoiled.input[joint].as_ref().unwrap()[row];
            csv += &format!(",{:.6},{goal:.6}", spoiled.position_rad[joint][row]);
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log.csv");
    std::fs::write(&log, csv).unwrap();
    let (path, text) = (Path::new("long.toml"), &long_chain_file());
    let file = ModelFile { path, text };
    let found = findings(&[LogRequest::whole(log)], &model, file).unwrap();
    let refused = found
        .iter()
        .filter(|finding| finding.severity == Severity::Refuse);
    let kinds: Vec<&str> = refused.map(|finding| finding.kind).collect();
    assert_eq!(kinds, ["unit"], "{found:#?}");
}
