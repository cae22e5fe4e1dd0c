//! Time of a 20-s prediction with an effect of the library and with the same law as an expression:
//! the second takes at most three times as long.

// `criterion_group!` makes a public function.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use handstand::Model;
use handstand::motion::Motion;
use handstand::sim::{Plant, PlantMemory, StartState, predict};
use std::f64::consts::TAU;
use std::hint::black_box;
use std::path::Path;

const ARM: &str = r#"[rig]
name = "arm"
angle_zero = "hanging"

[[link]]
com_m = 0.1
mass_kg = 0.2
inertia_kg_m2 = 1e-4

[[joint]]
drive = "torque"

[log]
time = { column = "time_s", unit = "s" }

[[log.joint]]
position = { column = "q_rad", unit = "rad" }
input = { column = "torque_nm", unit = "N m" }
"#;

const BUILT_IN: &str = r#"
[[effect]]
kind = "air_drag"
joint = 1
coefficient_nm_s2_rad2 = 0.002
"#;

const EXPRESSION: &str = r#"
[[expression]]
name = "wind"
torque = "-c * w * abs(w)"

[[expression.parameter]]
key = "c"
unit = "N m s^2/rad^2"
start = 0.002
low = 0.0
high = 1.0

[[effect]]
kind = "wind"
joint = 1
c = 0.002
"#;

fn predictions(c: &mut Criterion) {
    let time_s: Vec<f64> = (0..2001).map(|k| 0.01 * f64::from(k)).collect();
    let torque = time_s.iter().map(|t| 0.1 * (TAU * 0.7 * t).sin());
    let motion = Motion {
        position_rad: vec![vec![0.0; time_s.len()]],
        velocity_rad_s: vec![None],
        input: vec![Some(torque.collect())],
        time_s,
        ..Motion::default()
    };
    let start = StartState {
        angle_rad: vec![0.0],
        speed_rad_s: vec![0.0],
        reading_slope: None,
    };
    for (name, effect) in [("air_drag", BUILT_IN), ("expression", EXPRESSION)] {
        let text = format!("{ARM}{effect}");
        let model = Model::parse(&text, Path::new("arm.toml")).expect("a model");
        let plant = Plant::new(&model, &motion);
        let mut out = vec![0.0; motion.len()];
        c.bench_function(&format!("predict 20 s, drag by {name}"), |b| {
            b.iter(|| {
                let (all, mut memory) = (0..motion.len(), PlantMemory::default());
                predict(
                    &plant,
                    &motion,
                    all,
                    black_box(&start),
                    &mut memory,
                    &mut out,
                )
            });
        });
    }
}

criterion_group!(benches, predictions);
criterion_main!(benches);
