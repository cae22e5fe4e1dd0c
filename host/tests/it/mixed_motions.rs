//! Motions of different kinds in one diagnosis: none may hide what another shows.

use crate::common::Bench;
use handstand::Model;
use handstand::diagnose::{DiagnoseOptions, Diagnosis, Verdict, diagnose};
use handstand::log::{LogRequest, read};
use handstand::motion::{Motion, MotionSource};
use handstand::sim::closed_loop::{
    ClosedLoop, Commands, InitialState, Sensor, StateFeedback, stream,
};
use handstand::sim::{Plant, PlantMemory, StartState, predict};
use handstand::synth::StateFeedbackPlan;
use handstand_shared::raw::Position;
use std::fmt::Write as _;

const HANDSTAND: &str = include_str!("../../models/handstand.toml");
const RATE_HZ: f64 = 100.0;

/// `nominal.toml`, `gains.json`, and `true.toml` with what is hidden.
fn bench(hidden: &str) -> Bench {
    let bench = Bench::new();
    let ten_bits = format!("unit = \"rad\", resolution_rad = {} }}", Position::LSB_RAD);
    let positions: Vec<&str> = HANDSTAND
        .lines()
        .filter(|line| !line.starts_with("velocity"))
        .collect();
    let nominal = positions.join("\n").replace("unit = \"rad\" }", &ten_bits) + "\n";
    bench.put("nominal.toml", &nominal);
    bench.put("true.toml", format!("{nominal}{hidden}"));
    let ran = bench.run("gains nominal.toml --state-space gains.json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    bench
}

fn header(joints: usize) -> String {
    let mut text = String::from("time_s");
    for joint in 1..=joints {
        let _ = write!(text, ",q{joint}_rad");
        if joint > 1 {
            let _ = write!(text, ",torque{joint}_nm");
        }
    }
    text
}

/// A swing below the bar under torques that come and go.
fn hanging(bench: &Bench, seed: f64, seconds: f64) -> String {
    let model = Model::load(&bench.path("true.toml")).unwrap();
    let samples = (seconds * RATE_HZ) as usize;
    let time_s: Vec<f64> = (0..samples).map(|k| k as f64 / RATE_HZ).collect();
    let torque = |joint: usize, t: f64| {
        let j = joint as f64;
        0.12 * (t * (3.1 + 0.7 * j + 0.2 * seed) + seed).sin() + 0.08 * (t * (7.3 - j) + j).sin()
    };
    let input = |joint: usize| {
        time_s
            .iter()
            .map(|t| torque(joint, *t))
            .collect::<Vec<f64>>()
    };
    let motion = Motion {
        name: String::new(),
        source: MotionSource {
            path: "hanging".into(),
            sha256: String::new(),
            lines: (0, 0),
        },
        position_rad: vec![vec![0.0; samples]; 3],
        velocity_rad_s: vec![None; 3],
        rate_rad_s: Vec::new(),
        input: vec![None, Some(input(1)), Some(input(2))],
        supply_v: None,
        torque_on: None,
        payload_kg: 0.0,
        turned: false,
        time_s,
    };
    let plant = Plant::new(&model, &motion);
    let start = StartState {
        angle_rad: vec![0.5 + 0.1 * seed, 0.0, 0.0],
        speed_rad_s: vec![0.0; 3],
        reading_slope: None,
    };
    let (mut readings, mut sensors) = (vec![0.0; 3 * samples], PlantMemory::default());
    predict(
        &plant,
        &motion,
        0..samples,
        &start,
        &mut sensors,
        &mut readings,
    );
    let mut text = header(3);
    for k in 0..samples {
        let _ = write!(text, "\n{:.2}", motion.time_s[k]);
        for joint in 0..3 {
            let angle =
                Position::LSB_RAD * (readings[joint * samples + k] / Position::LSB_RAD).round();
            let _ = write!(text, ",{angle}");
            if let Some(input) = &motion.input[joint] {
                let _ = write!(text, ",{}", input[k]);
            }
        }
    }
    text
}

/// Hanging at rest, every reading off by a step at times.
fn still(seconds: f64) -> String {
    let mut text = header(3);
    for k in 0..(seconds * RATE_HZ) as usize {
        let _ = write!(text, "\n{:.2}", k as f64 / RATE_HZ);
        for joint in 0..3 {
            let steps = f64::from(u8::from((k * (joint + 3)) % 7 == 0));
            let hanging_rad = if joint == 0 {
                -std::f64::consts::FRAC_PI_2
            } else {
                0.0
            };
            let _ = write!(text, ",{}", hanging_rad + steps * Position::LSB_RAD);
            if joint > 0 {
                let _ = write!(text, ",0");
            }
        }
    }
    text
}

/// A handstand from this lean.
fn balancing(bench: &Bench, lean_rad: f64, seconds: f64) -> String {
    let model = Model::load(&bench.path("true.toml")).unwrap();
    let plan = StateFeedbackPlan::load(&bench.path("gains.json"), &model).unwrap();
    let mut closed = ClosedLoop::new(&model, &plan.pose_rad, Commands::Own, 0.01).unwrap();
    closed.sensor = Sensor {
        position_resolution_rad: Position::LSB_RAD,
        ..Sensor::EXACT
    };
    let law = StateFeedback::new(3, plan.k.clone()).feeding(&plan.u0);
    let (mut text, start) = (header(3), InitialState::at(vec![lean_rad, 0.0, 0.0]));
    let outcome = closed.watch(&law, &start, seconds, stream(7, 0), |sample| {
        let _ = write!(text, "\n{:.2}", sample.time_s);
        for joint in 0..3 {
            let angle = plan.pose_rad[joint] + sample.measured.angle_rad[joint];
            let _ = write!(text, ",{angle}");
            if joint > 0 {
                let _ = write!(text, ",{}", sample.command[joint - 1]);
            }
        }
    });
    assert_eq!(outcome.fell_s, None);
    text
}

fn diagnosed(bench: &Bench, training: &[&str], held_out: &[&str]) -> Diagnosis {
    let model = Model::load(&bench.path("nominal.toml")).unwrap();
    let motions = |names: &[&str]| {
        let requests = names.iter().map(|name| LogRequest::whole(bench.path(name)));
        read(&requests.collect::<Vec<_>>(), &model.log).unwrap()
    };
    let options = DiagnoseOptions::default();
    diagnose(
        &model,
        motions(training),
        motions(held_out),
        &options,
        &|_| {},
    )
}

fn assert_bar_friction(diagnosis: &Diagnosis) {
    assert_eq!(diagnosis.verdict, Verdict::Named, "{:?}", diagnosis.summary);
    assert_eq!(diagnosis.effects[0].address(), "coulomb@1");
    let value = &diagnosis.effects[0].parameters[0];
    assert!((value.value / 0.01 - 1.0).abs() < 0.05, "{value:?}");
}

#[test]
fn neither_balancing_nor_rest_hides_what_hanging_shows() {
    let bench = bench("\n[[effect]]\nkind = \"coulomb\"\njoint = 1\ntorque_nm = 0.01\n");
    for (name, seed) in [("h1.csv", 0.0), ("h2.csv", 1.0), ("h3.csv", 2.0)] {
        bench.put(name, hanging(&bench, seed, 10.0));
    }
    for (name, lean) in [("b1.csv", 0.01), ("b2.csv", -0.015)] {
        bench.put(name, balancing(&bench, lean, 10.0));
    }
    bench.put("s1.csv", still(5.0));
    bench.put("s2.csv", still(5.0));
    let all = diagnosed(
        &bench,
        &["h1.csv", "h2.csv", "b1.csv", "s1.csv"],
        &["h3.csv", "b2.csv", "s2.csv"],
    );
    assert_bar_friction(&all);
}
