//! Time of one forward-dynamics evaluation.

// `criterion_group!` makes a public function.
#![allow(missing_docs)]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use handstand::dynamics::{Chain, ChainLink, Dense, Workspace};
use std::hint::black_box;

fn chain(n: usize) -> Chain {
    let link = ChainLink {
        length_m: 0.15,
        com_m: 0.075,
        com_angle_rad: 0.0,
        mass_kg: 0.2,
        inertia_kg_m2: 3.75e-4,
        armature_kg_m2: 0.0,
        slide: None,
    };
    Chain {
        links: vec![link; n],
        gravity_m_s2: 9.81,
    }
}

fn forward(c: &mut Criterion) {
    let mut group = c.benchmark_group("forward dynamics");
    for n in [3, 30, 100] {
        let chain = chain(n);
        let mut work = Workspace::new(n);
        let wave = |k: f64| {
            (0..n)
                .map(|i| (k * (i + 1) as f64).sin())
                .collect::<Vec<_>>()
        };
        let (mut angle, speed, torque) = (wave(1.0), wave(2.0), wave(3.0));
        let (held, mut out) = (vec![false; n], vec![0.0; n]);
        let base = chain.base_m_s2(0.0);
        group.bench_function(BenchmarkId::from_parameter(n), |b| {
            b.iter(|| {
                // Other angles each time, so that nothing is hoisted.
                angle[0] += 1e-9;
                chain.forward(
                    &mut work,
                    base,
                    black_box(&angle),
                    &speed,
                    &torque,
                    &held,
                    &mut out,
                );
                black_box(&mut out);
            });
        });
    }
    group.bench_function("3, closed form", |b| {
        let dense = Dense::<3>::new(&chain(3), 0.0).expect("the chain has three links");
        let wave = |k: f64| std::array::from_fn(|i| (k * (i + 1) as f64).sin());
        let (mut angle, speed, torque): ([f64; 3], _, _) = (wave(1.0), wave(2.0), wave(3.0));
        b.iter(|| {
            angle[0] += 1e-9;
            dense.forward(black_box(&angle), &speed, &torque, &black_box([false; 3]))
        });
    });
    group.finish();
}

criterion_group!(benches, forward);
criterion_main!(benches);
