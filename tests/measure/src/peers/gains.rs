//! Gains by the library on the tasks of `tests/peers/dlqr.py`.

use super::median_seconds;
use handstand::Model;
use handstand::model::{Angles, Drive};
use handstand::synth::{Discrete, dlqr, linearise, upright, zoh};
use nalgebra::DMatrix;
use std::hint::black_box;
use std::path::{Path, PathBuf};

/// Calls to a measurement, times the square of the number of states.
const CALLS: usize = 5000;

/// Matrices and gains of a chain of 30 links, to 60 digits.
pub fn chain_fixture() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../host/tests/data/riccati_chain.f64")
}

/// Median time, s, of one sampled regulator of so many equal links upright, the first joint
/// passive.
pub fn dlqr_seconds(links: usize) -> f64 {
    let plant = chain(links);
    let (n, m) = plant.b.shape();
    let (q, r) = (DMatrix::identity(n, n), DMatrix::identity(m, m));
    let calls = (CALLS / (n * n)).max(3);
    let seconds = median_seconds(15, || {
        for _ in 0..calls {
            let _ = black_box(dlqr(black_box(&plant), &q, &r));
        }
    });
    seconds / calls as f64
}

/// How far the gains of 60 states are from 60 digits, relative, in their largest entry.
pub fn dlqr_off() -> Option<f64> {
    let bytes = std::fs::read(chain_fixture()).ok()?;
    let values = bytes.chunks_exact(8);
    let values: Vec<f64> = values
        .map(|b| f64::from_le_bytes(b.try_into().unwrap_or_default()))
        .collect();
    let (a, rest) = values.split_at_checked(60 * 60)?;
    let (b, exact) = rest.split_at_checked(60 * 29)?;
    let plant = Discrete {
        a: DMatrix::from_row_slice(60, 60, a),
        b: DMatrix::from_row_slice(60, 29, b),
        c: DMatrix::identity(60, 60),
        ts_s: 0.01,
        delayed_inputs: 0,
    };
    let exact = DMatrix::from_row_slice(29, 60, exact);
    let gains = dlqr(
        &plant,
        &DMatrix::identity(60, 60),
        &DMatrix::identity(29, 29),
    )
    .ok()?;
    Some((gains.k - &exact).amax() / exact.amax())
}

fn chain(links: usize) -> Discrete {
    let text = include_str!("../../../../host/models/handstand.toml");
    let mut model = Model::parse(text, Path::new("handstand.toml")).expect("the model is sound");
    model.angles = Angles::Relative;
    let (mut link, mut joint) = (model.links[0].clone(), model.joints[0].clone());
    (link.length_m, link.com_m, link.mass_kg, link.inertia_kg_m2) = (0.15, 0.075, 0.2, 3.75e-4);
    joint.drive = Drive::Torque;
    model.links = vec![link; links];
    model.joints = vec![joint; links];
    model.joints[0].drive = Drive::Passive;
    let linear = linearise(&model, &upright(&model)).expect("upright is an equilibrium");
    zoh(&linear.plant, 0.01, 0.0).expect("it can be sampled")
}
