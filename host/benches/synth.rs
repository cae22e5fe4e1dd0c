//! Time of one synthesis: linearise, sample, solve for gains; n links, n - 1 of them driven.

// `criterion_group!` makes a public function.
#![allow(missing_docs)]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use handstand::Model;
use handstand::model::Drive;
use handstand::synth::{dlqr, linearise, lqr, upright, zoh};
use nalgebra::DMatrix;
use std::hint::black_box;
use std::path::Path;

/// The handstand, or so many equal links upright.
fn model(links: usize) -> Model {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/handstand.toml");
    let mut model = Model::load(&file).expect("the model is there");
    if links != 3 {
        let (mut link, mut joint) = (model.links[0].clone(), model.joints[0].clone());
        (link.length_m, link.com_m, link.mass_kg, link.inertia_kg_m2) = (0.15, 0.075, 0.2, 3.75e-4);
        joint.drive = Drive::Torque;
        model.links = vec![link; links];
        model.joints = vec![joint; links];
        model.joints[0].drive = Drive::Passive;
    }
    model
}

fn synth(c: &mut Criterion) {
    let mut group = c.benchmark_group("synthesis");
    for links in [3, 10, 30] {
        let model = model(links);
        let pose = upright(&model);
        let linear = linearise(&model, &pose).expect("upright is an equilibrium");
        let plant = linear.plant;
        let sampled = zoh(&plant, 0.01, 0.0).expect("it can be sampled");
        let (n, m) = plant.b.shape();
        let (q, r) = (DMatrix::identity(n, n), DMatrix::identity(m, m));
        let id = |name| BenchmarkId::new(name, n);
        group.bench_function(id("linearise"), |b| {
            b.iter(|| linearise(black_box(&model), &pose));
        });
        group.bench_function(id("zoh"), |b| b.iter(|| zoh(black_box(&plant), 0.01, 0.0)));
        group.bench_function(id("lqr"), |b| b.iter(|| lqr(black_box(&plant), &q, &r)));
        group.bench_function(id("dlqr"), |b| b.iter(|| dlqr(black_box(&sampled), &q, &r)));
    }
    group.finish();
}

criterion_group!(benches, synth);
criterion_main!(benches);
