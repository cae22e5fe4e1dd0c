//! Motions that do not show the same: an effect that only strong ones have.

use crate::common::Bench;
use handstand::Model;
use handstand::diagnose::conventions::ModelFile;
use handstand::diagnose::{DiagnoseOptions, Diagnosis, Verdict, diagnose_logs};
use handstand::effects::EFFECTS;
use handstand::log::{LogRequest, LogSet};
use std::fmt::Write as _;

const MODEL: &str = r#"[rig]
name = "light arm"
angle_zero = "hanging"

[[link]]
com_m = 0.1
mass_kg = 0.2
inertia_kg_m2 = 1.2e-4

[[joint]]
drive = "torque"

[[effect]]
kind = "viscous"
joint = 1
coefficient_nm_s_rad = 0.002

[log]
time = { column = "time_s", unit = "s" }

[[log.joint]]
position = { column = "q_rad", unit = "rad", resolution_rad = 0.0051 }
input = { column = "torque_nm", unit = "N m" }
"#;

/// Torque beyond which the drive gives no more, N m.
const LIMIT_NM: f64 = 0.05;

/// Eight seconds under torques of this size.
fn log(amplitude_nm: f64, phase: f64) -> String {
    const RATE_HZ: f64 = 100.0;
    const PARTS: usize = 20;
    let mut text = String::from("time_s,q_rad,torque_nm");
    let (mut angle, mut speed) = (0.2 * phase.sin(), 0.0);
    for k in 0..(8.0 * RATE_HZ) as usize {
        let t = k as f64 / RATE_HZ;
        let torque = amplitude_nm * (0.6 * (5.3 * t + phase).sin() + 0.4 * (2.1 * t).sin());
        let read = 0.0051 * (angle / 0.0051_f64).round();
        let _ = write!(text, "\n{t:.2},{read:.4},{torque:.6}");
        let drive = torque.clamp(-LIMIT_NM, LIMIT_NM);
        let dt = 1.0 / RATE_HZ / PARTS as f64;
        for _ in 0..PARTS {
            let torque = drive - 0.2 * 9.81 * 0.1 * f64::sin(angle) - 0.002 * speed;
            speed += dt * torque / (1.2e-4 + 0.2 * 0.1 * 0.1);
            angle += dt * speed;
        }
    }
    text
}

fn diagnosed(bench: &Bench, [training, held_out]: [&[&str]; 2], effects: &[&str]) -> Diagnosis {
    let path = bench.path("model.toml");
    let model = Model::load(&path).unwrap();
    let requests = |names: &[&str]| {
        let requests = names.iter().map(|name| LogRequest::whole(bench.path(name)));
        requests.collect()
    };
    let logs = LogSet {
        training: requests(training),
        held_out: requests(held_out),
    };
    let all = EFFECTS.iter().map(|effect| effect.info().id);
    let options = DiagnoseOptions {
        without: all
            .filter(|id| !effects.contains(id))
            .map(String::from)
            .collect(),
        ..DiagnoseOptions::default()
    };
    let file = ModelFile {
        path: &path,
        text: MODEL,
    };
    let found = diagnose_logs(&model, file, &logs, &options, &|_| {});
    found.unwrap().diagnosis
}

/// Weak and strong motions.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.put("model.toml", MODEL);
    for (name, amplitude_nm, phase) in [
        ("weak1.csv", 0.04, 0.0),
        ("weak2.csv", 0.045, 1.0),
        ("weak3.csv", 0.048, 2.0),
        ("strong.csv", 0.12, 0.5),
    ] {
        bench.put(name, log(amplitude_nm, phase));
    }
    bench
}

const ALL: [&str; 4] = ["torque_saturation", "coulomb", "air_drag", "delay"];

#[test]
fn what_one_fitted_motion_alone_shows_is_named_and_not_proved() {
    let split: [&[&str]; 2] = [&["weak1.csv", "strong.csv"], &["weak3.csv"]];
    let found = diagnosed(&bench(), split, &ALL);
    assert_eq!(found.verdict, Verdict::Named, "{:?}", found.summary);
    assert_eq!(found.effects[0].address(), "torque_saturation@1");
    let limit = found.effects[0].parameters[0].value;
    assert!((limit / LIMIT_NM - 1.0).abs() < 0.01, "{limit}");
    let warned = &found.warnings[0];
    assert!(
        warned.contains("only fitted motions show this (strong.csv)"),
        "{warned}"
    );
}

#[test]
fn what_one_motion_held_out_alone_shows_is_told_and_not_claimed() {
    let split: [&[&str]; 2] = [&["weak1.csv", "weak2.csv"], &["strong.csv"]];
    let found = diagnosed(&bench(), split, &ALL);
    assert_eq!(found.verdict, Verdict::Ambiguous, "{:?}", found.summary);
    assert_eq!(found.shows_alone, ["strong.csv"]);
    assert_eq!(found.effects[0].address(), "torque_saturation@1");
    let limit = found.effects[0].parameters[0].value;
    assert!((limit / LIMIT_NM - 1.0).abs() < 0.01, "{limit}");
    let said = &found.summary[0];
    assert!(said.starts_with("Shows in strong.csv alone: "), "{said}");
}
