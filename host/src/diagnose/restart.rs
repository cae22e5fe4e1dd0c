//! Fits from other starts, where false valleys are many: few samples, or a law that jumps.

use super::bench::{Bench, FINISH};
use super::opening::Opening;
use super::trial::Trial;
use crate::fitting::{Data, Fit, FitOptions, fit};
use crate::model::{EffectInstance, Model, ParameterPath};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Fewer training samples than this are few.
pub(super) const FEW: usize = 1500;
/// Random starts of each candidate, and their iterations.
const RESTARTS: usize = 100;
const RESTART_ITERATIONS: usize = 30;

impl Bench<'_> {
    /// Fits from random values around the model's own and the opening's.
    pub fn restarted(&self, from: &Trial, opening: &Opening) -> Vec<Trial> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        (0..RESTARTS)
            .map(|_| {
                let mut model = self.start.clone();
                for candidate in &from.set {
                    let known = from.search.model.effects.iter();
                    let same = |e: &&EffectInstance| {
                        e.effect == candidate.effect && e.joint == candidate.joint
                    };
                    model.effects.extend(known.filter(same).cloned());
                }
                model
                    .effects
                    .push(opening.candidate.instance(&opening.values));
                let mut free = from.search.free.clone();
                free.extend(opening.candidate.paths());
                scatter(&mut model, &free, &mut random);
                let options = FitOptions {
                    iterations: RESTART_ITERATIONS,
                    ..FitOptions::default()
                };
                let mut set = from.set.clone();
                set.push(opening.candidate);
                Trial::new(set, fit(&model, &free, &self.search, None, options))
            })
            .collect()
    }
}

impl Bench<'_> {
    /// Looks for candidates whose law jumps from the values the model came with, and from each start value: what
    /// is missing has bent the base values, and a fit that starts from them may end in a false valley.
    pub fn look_elsewhere(&self, trials: &mut [Trial]) {
        let alone = |trial: &&mut Trial| trial.set.len() == 1 && trial.set[0].jumps();
        let jumping: Vec<&mut Trial> = trials.iter_mut().filter(alone).collect();
        jumping.into_par_iter().for_each(|trial| {
            let candidate = trial.set[0];
            let found = candidate.starts().into_par_iter().map(|start| {
                let mut model = self.start.clone();
                model.effects.push(candidate.instance(&start));
                let options = FitOptions {
                    iterations: FINISH,
                    ..FitOptions::default()
                };
                let found = fit(&model, &trial.search.free, &self.search, None, options);
                Trial::new(vec![candidate], found)
            });
            let found = found.collect::<Vec<_>>().into_iter();
            if let Some(best) = found.min_by(|a, b| a.search_mean.total_cmp(&b.search_mean))
                && best.search_mean < trial.search_mean
            {
                *trial = best;
            }
        });
    }
}

/// The base model fitted; from many starts on few samples.
pub(super) fn base_fit(model: &Model, data: &Data, few: bool, seed: u64) -> Fit {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let starts = if few { RESTARTS } else { 0 };
    let scattered = (0..starts).map(|_| {
        let mut start = model.clone();
        scatter(&mut start, &model.free, &mut random);
        start
    });
    let models: Vec<Model> = std::iter::once(model.clone()).chain(scattered).collect();
    let fits: Vec<Fit> = models
        .par_iter()
        .map(|start| fit(start, &model.free, data, None, FitOptions::default()))
        .collect();
    let mut best = 0;
    for (k, candidate) in fits.iter().enumerate() {
        if candidate.residuals.cost() < fits[best].residuals.cost() {
            best = k;
        }
    }
    fits[best].clone()
}

/// Multiplies every free value that can't be negative by a random factor up to about three either way.
fn scatter(model: &mut Model, free: &[ParameterPath], random: &mut ChaCha8Rng) {
    for path in free {
        let (low, high) = path.bounds(model);
        let factor = random.random_range(-1.2f64..1.2).exp();
        if let Some(value) = path.get(model).filter(|_| low >= 0.0) {
            let known = path.set(model, (value * factor).clamp(low, high));
            debug_assert!(known, "a free parameter is one of the model's");
        }
    }
}
