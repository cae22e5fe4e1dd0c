//! Time of one 10-ms period of the paper's closed loop, and of one 5-s run: 1-ms Runge-Kutta steps.

// `criterion_group!` makes a public function.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use handstand::Model;
use handstand::sim::closed_loop::{
    ClosedLoop, Commands, InitialState, PosedPlant, StateFeedback, stream,
};
use std::hint::black_box;
use std::path::Path;

/// DLQR of the paper's robot: Q = 100 I, R = I, 10 ms.
const GAINS: [[f64; 6]; 2] = [
    [
        -75.758443, -32.187228, -11.454290, -13.004784, -6.2134254, -2.3441985,
    ],
    [
        -62.056988, -26.928273, -9.0350845, -10.653945, -5.1619377, -1.8225471,
    ],
];

fn runs(c: &mut Criterion) {
    let text = include_str!("../models/handstand.toml");
    let model = Model::parse(text, Path::new("handstand.toml")).expect("our own model");
    let pose = [std::f64::consts::FRAC_PI_2, 0.0, 0.0];
    let dense = PosedPlant::new(&model, &pose, Commands::Torque).expect("our own model");
    let general = dense.clone().by_general_simulation();
    let controller = StateFeedback::new(3, GAINS.map(|row| row.to_vec()).to_vec());
    let start = InitialState::at([0.01, -0.02, 0.02]);
    for (name, plant) in [("dense", dense), ("general", general)] {
        let closed = ClosedLoop::around(plant, 0.01);
        let starts = vec![start.clone(); 32];
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let one = one.expect("a thread can be started");
        c.bench_function(&format!("32 closed loops, 5 s, {name}, one thread"), |b| {
            b.iter(|| one.install(|| closed.run_all(&controller, black_box(&starts), 5.0, 1)));
        });
        c.bench_function(&format!("closed loop, 5 s, {name}"), |b| {
            b.iter(|| closed.run(&controller, black_box(&start), 5.0, stream(1, 0)));
        });
    }
}

criterion_group!(benches, runs);
criterion_main!(benches);
