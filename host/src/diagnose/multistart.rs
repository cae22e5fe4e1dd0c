//! Fits of one model from random starts.

use super::budget::STARTS;
use crate::fitting::{Fit, FitData, FitOptions, fit};
use crate::model::{Model, ParameterPath};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// The base model fitted; from many starts on few samples.
pub(super) fn base_fit(model: &Model, data: &FitData, few: bool, seed: u64) -> Fit {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let starts = if few { STARTS } else { 0 };
    let others = (0..starts).map(|_| scattered(model, &model.free, &mut random));
    let models: Vec<Model> = std::iter::once(model.clone()).chain(others).collect();
    let fitted = |start: &Model| fit(start, &model.free, data, None, FitOptions::default());
    let fits: Vec<Fit> = models.par_iter().map(fitted).collect();
    let cost = |fit: &Fit| fit.residuals.cost();
    let best = fits.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
    best.unwrap_or_else(|| fitted(model))
}

/// The model with every free value that can't be negative multiplied by a random factor up to about
/// three either way.
pub(super) fn scattered(model: &Model, free: &[ParameterPath], random: &mut ChaCha8Rng) -> Model {
    let mut scattered = model.clone();
    for path in free {
        let (low, high) = path.bounds(&scattered);
        let factor = random.random_range(-1.2f64..1.2).exp();
        if let Some(value) = path.get(&scattered).filter(|_| low >= 0.0) {
            let known = path.set(&mut scattered, (value * factor).clamp(low, high));
            debug_assert!(known, "a free parameter is one of the model's");
        }
    }
    scattered
}
