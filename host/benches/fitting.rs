//! Times of a prediction, a four-parameter fit and a diagnosis of virtual benches' 20-s logs.

// `criterion_group!` makes a public function.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use handstand::Model;
use handstand::challenge::{Hidden, generate};
use handstand::diagnose::{DiagnoseOptions, diagnose};
use handstand::fitting::{FitOptions, FitProblem, Horizon, fit};
use handstand::log::{LogRequest, read};
use handstand::model::ParameterPath;
use handstand::motion::Motion;
use handstand::sim::{Plant, PlantMemory, predict};
use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

const FREE: [&str; 4] = [
    "viscous@1.coefficient_nm_s_rad",
    "coulomb@1.torque_nm",
    "link1.inertia_kg_m2",
    "torque_scale@1.factor",
];

/// A model and the three motions of a bench.
fn bench(
    model_of: impl Fn(&handstand::challenge::Challenge) -> String,
    kind: &'static str,
) -> (Model, Vec<Motion>) {
    let challenge = generate(1, Hidden::Effect(kind));
    let model = Model::parse(&model_of(&challenge), Path::new("bench.toml")).expect("a model");
    let dir = tempfile::tempdir().expect("a directory");
    let requests: Vec<LogRequest> = challenge
        .logs
        .iter()
        .map(|(name, content)| {
            let path = dir.path().join(name);
            std::fs::write(&path, content).expect("a log written");
            LogRequest::whole(path)
        })
        .collect();
    let motions = read(&requests, &model.log).expect("a log");
    (model, motions)
}

fn identify(c: &mut Criterion) {
    let (model, motions) = bench(|c| c.answer.true_model_toml.clone(), "torque_scale");
    let one = vec![motions[0].clone()];
    let data = FitProblem::new(&model, one, Horizon::Whole);
    let motion = &data.motions[0];
    let plant = Plant::new(&model, motion);
    let start = data.guessed(&data.windows[0]).start(&plant);
    let mut out = vec![0.0; motion.len()];
    c.bench_function("predict 20 s", |b| {
        b.iter(|| {
            let mut memory = PlantMemory::default();
            predict(
                &plant,
                motion,
                0..motion.len(),
                black_box(&start),
                &mut memory,
                &mut out,
            );
            black_box(&mut out);
        });
    });

    let free: Vec<ParameterPath> = FREE
        .iter()
        .map(|text| text.parse().expect("an address"))
        .collect();
    let mut off = model.clone();
    for (path, factor) in free.iter().zip([2.0, 0.5, 2.0, 0.5]) {
        let value = path.get(&off).expect("a value");
        assert!(path.set(&mut off, factor * value));
    }
    let mut group = c.benchmark_group("slow");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(10));
    group.bench_function("fit four parameters to 20 s", |b| {
        b.iter(|| fit(black_box(&off), &free, &data, None, FitOptions::default()));
    });

    let (model, motions) = bench(|c| c.model_toml.clone(), "viscous");
    let (training, held_out) = motions.split_at(2);
    group.bench_function("diagnose three motions", |b| {
        let options = DiagnoseOptions::default();
        b.iter(|| {
            diagnose(
                black_box(&model),
                training.to_vec(),
                held_out.to_vec(),
                &options,
                &|_| {},
            )
        });
    });
    group.finish();
}

criterion_group!(benches, identify);
criterion_main!(benches);
