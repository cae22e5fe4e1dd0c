//! Gains beside SciPy's on a thousand random problems, and beside 60 digits on a chain of 30 links.
//!
//! `tests/peers/riccati.py` makes the fixtures.

use handstand::Model;
use handstand::model::{Angles, Drive};
use handstand::synth::{Continuous, Discrete, dlqr, linearise, lqr, upright, zoh};
use nalgebra::DMatrix;
use std::path::{Path, PathBuf};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

/// Matrices of a fixture, one after the other.
struct Fixture {
    values: Vec<f64>,
    at: usize,
}

impl Fixture {
    fn open(name: &str) -> Fixture {
        let bytes = std::fs::read(data(name)).unwrap();
        let values = bytes
            .chunks_exact(8)
            .map(|b| f64::from_le_bytes(b.try_into().unwrap()));
        Fixture {
            values: values.collect(),
            at: 0,
        }
    }

    fn matrix(&mut self, rows: usize, columns: usize) -> DMatrix<f64> {
        let from = self.at;
        self.at += rows * columns;
        DMatrix::from_row_slice(rows, columns, &self.values[from..self.at])
    }
}

/// As in `riccati.py`.
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn matrix(&mut self, rows: usize, columns: usize) -> DMatrix<f64> {
        let uniform = |_| (self.next() >> 11) as f64 * 2f64.powi(-52) - 1.0;
        let values: Vec<f64> = (0..rows * columns).map(uniform).collect();
        DMatrix::from_row_slice(rows, columns, &values)
    }
}

fn gram(c: &DMatrix<f64>) -> DMatrix<f64> {
    let rows = c.row_iter().map(|row| row.transpose() * row);
    rows.fold(DMatrix::zeros(c.ncols(), c.ncols()), |sum, part| sum + part)
}

fn problem(seed: u64) -> [DMatrix<f64>; 4] {
    let mut random = SplitMix(seed);
    let mut up_to = |most: usize| 1 + (random.next() % most as u64) as usize;
    let n = up_to(8);
    let m = up_to(n.min(3));
    let p = up_to(n);
    let a = random.matrix(n, n) * (1.2 * (3.0 / n as f64).sqrt());
    let b = random.matrix(n, m);
    let q = gram(&random.matrix(p, n));
    let r = gram(&random.matrix(m, m)) + DMatrix::identity(m, m) * 0.1;
    [a, b, q, r]
}

fn off(k: &DMatrix<f64>, exact: &DMatrix<f64>) -> f64 {
    (k - exact).amax() / exact.amax()
}

fn sampled(a: DMatrix<f64>, b: DMatrix<f64>) -> Discrete {
    let c = DMatrix::identity(a.nrows(), a.nrows());
    Discrete {
        a,
        b,
        c,
        ts_s: 0.01,
        delayed_inputs: 0,
    }
}

#[test]
fn a_thousand_random_gains_are_scipy_s_and_exact() {
    let mut fixture = Fixture::open("riccati_random.f64");
    let (mut worst, mut scipy_off) = (0.0_f64, 0);
    for seed in 0..1000 {
        let [a, b, q, r] = problem(seed);
        let (n, m) = b.shape();
        let plant = Continuous {
            a: a.clone(),
            b: b.clone(),
            c: DMatrix::identity(n, n),
        };
        let ours = [
            dlqr(&sampled(a, b), &q, &r).unwrap().k,
            lqr(&plant, &q, &r).unwrap().k,
        ];
        for k in ours {
            let (scipy, exact) = (fixture.matrix(m, n), fixture.matrix(m, n));
            worst = worst.max(off(&k, &exact));
            // Four of SciPy's continuous gains are farther than that from 60 digits themselves.
            if off(&scipy, &exact) < 9e-10 {
                assert!(off(&k, &scipy) < 1e-9, "seed {seed}")
            } else {
                scipy_off += 1
            }
        }
    }
    assert_eq!(fixture.at, fixture.values.len());
    assert!(worst < 1e-12, "{worst:e} off 60 digits");
    assert!(scipy_off <= 4, "{scipy_off} gains of SciPy's are off");
}

/// `riccati.py`'s chain as a model.
fn chain(links: usize) -> Model {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/handstand.toml");
    let mut model = Model::load(&file).unwrap();
    model.angles = Angles::Relative;
    let (mut link, mut joint) = (model.links[0].clone(), model.joints[0].clone());
    (link.length_m, link.com_m, link.mass_kg, link.inertia_kg_m2) = (0.15, 0.075, 0.2, 3.75e-4);
    joint.drive = Drive::Torque;
    model.links = vec![link; links];
    model.joints = vec![joint; links];
    model.joints[0].drive = Drive::Passive;
    model
}

#[test]
fn gains_of_sixty_states_keep_their_digits() {
    let mut fixture = Fixture::open("riccati_chain.f64");
    let (a, b) = (fixture.matrix(60, 60), fixture.matrix(60, 29));
    let exact = fixture.matrix(29, 60);

    let model = chain(30);
    let ours = zoh(
        &linearise(&model, &upright(&model)).unwrap().plant,
        0.01,
        0.0,
    )
    .unwrap();
    assert!(off(&ours.a, &a) < 1e-9, "{:e}", off(&ours.a, &a));
    assert!(off(&ours.b, &b) < 1e-9, "{:e}", off(&ours.b, &b));

    let (q, r) = (DMatrix::identity(60, 60), DMatrix::identity(29, 29));
    let gains = dlqr(&sampled(a, b), &q, &r).unwrap();
    let off = off(&gains.k, &exact);
    println!(
        "farthest off 60 digits: {off:.1e}; residual {:.1e}",
        gains.residual
    );
    assert!(off < 1e-9, "{off:e}");
    assert!(gains.residual < 1e-15);
}
