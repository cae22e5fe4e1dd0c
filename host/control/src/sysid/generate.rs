//! Responses of a known model, to try an identification on.

use super::model::TransferModel;
use super::polynomial::filter;
use crate::sim::closed_loop::normal;
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// Sampling period of the paper's servo logs, s.
pub const PAPER_TS_S: f64 = 0.01;

/// The paper's servo, eq. (2): from commanded to estimated speed, `0.06217 z / (z^2 - 1.469 z +
/// 0.5544)`, without noise.
pub fn paper_model() -> TransferModel {
    TransferModel {
        a: vec![1.0],
        b: vec![0.0, 0.06217],
        c: vec![1.0],
        d: vec![1.0],
        f: vec![1.0, -1.469, 0.5544],
    }
}

/// [`paper_model`] with noise of the orders the paper's BJ(2,1,2,1) leaves room for, two in C and
/// one in D. The paper prints no noise model: these coefficients are chosen.
pub fn paper_noise_model() -> TransferModel {
    TransferModel {
        c: vec![1.0, -0.6, 0.2],
        d: vec![1.0, -0.7],
        ..paper_model()
    }
}

/// Independent normal numbers of this standard deviation.
pub fn noise(samples: usize, deviation: f64, seed: u64) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..samples).map(|_| deviation * normal(&mut rng)).collect()
}

/// Plus and minus 1, each held for `hold` samples, drawn at random.
pub fn pseudo_random(samples: usize, hold: usize, seed: u64) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let levels: Vec<f64> = (0..samples.div_ceil(hold.max(1)))
        .map(|_| if rng.random() { 1.0 } else { -1.0 })
        .collect();
    (0..samples).map(|t| levels[t / hold.max(1)]).collect()
}

impl TransferModel {
    /// The output for `input`, from rest, with white noise of this standard deviation as `e`.
    pub fn respond(&self, input: &[f64], deviation: f64, seed: u64) -> Vec<f64> {
        let e = noise(input.len(), deviation, seed);
        let w = filter(&self.b, &self.f, input);
        let n = filter(&self.c, &self.d, &e);
        let sum: Vec<f64> = w.iter().zip(n).map(|(w, n)| w + n).collect();
        filter(&[1.0], &self.a, &sum)
    }
}
