//! Fits from random starts, where false valleys are many: few samples.

use super::budget::{START_ITERATIONS, START_SAMPLES, STARTS};
use super::evaluator::Evaluator;
use super::hypothesis::Hypothesis;
use crate::fitting::{Candidate, Fit, FitOptions, FitProblem, InitialGuess, fit};
use crate::model::{Model, ParameterPath};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Two fits whose costs differ by less than this share ended in one valley.
const ALIKE: f64 = 0.01;

/// The valleys that fits from random starts ended in.
///
/// Starts go on until it is unlikely that there are valleys which none ended in: after n starts
/// and w valleys w (n - 1) / (n - w - 2) are expected in all (Boender, Rinnooy Kan: Bayesian
/// stopping rules for multistart global optimization methods, Mathematical Programming 37, 1987).
#[derive(Debug)]
pub(super) struct Valleys {
    costs: Vec<f64>,
    starts: usize,
    most_starts: usize,
}

impl Valleys {
    /// None yet. The fewer the samples, the more starts may be made: they cost as much in all.
    pub fn of_samples(samples: usize) -> Valleys {
        Valleys {
            costs: Vec::new(),
            starts: 0,
            most_starts: (START_SAMPLES / samples.max(1)).clamp(1, STARTS),
        }
    }

    /// Notes where a fit ended.
    pub fn note(&mut self, cost: f64) {
        self.starts += 1;
        let alike = |known: &f64| cost == *known || (cost - known).abs() <= ALIKE * known.abs();
        if !self.costs.iter().any(alike) {
            self.costs.push(cost);
        }
    }

    /// Whether less than half a valley is expected beyond those found, or the starts are spent.
    pub fn are_found(&self) -> bool {
        let (valleys, starts) = (self.costs.len(), self.starts);
        let expected = |left: usize| (valleys * (starts - 1)) as f64 / left as f64;
        let left = starts.saturating_sub(valleys + 2);
        starts >= self.most_starts || left > 0 && expected(left) < valleys as f64 + 0.5
    }
}

/// The base model fitted; from several starts on few samples.
pub(super) fn base_fit(model: &Model, data: &FitProblem, few: bool, seed: u64) -> Fit {
    let fitted = |start: &Model| fit(start, &model.free, data, None, FitOptions::default());
    let cost = |fit: &Fit| fit.residuals.cost();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut valleys = Valleys::of_samples(data.samples());
    let mut best = fitted(model);
    valleys.note(cost(&best));
    while few && !valleys.are_found() {
        let found = fitted(&scattered(model, &model.free, &mut random));
        valleys.note(cost(&found));
        if cost(&found) < cost(&best) {
            best = found;
        }
    }
    best
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

impl Evaluator<'_> {
    /// Fits from random values around the model's own and the guess's.
    pub fn random_starts(&self, from: &Hypothesis, guess: &InitialGuess) -> Vec<Hypothesis> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let mut start = self.start.clone();
        for candidate in &from.set {
            let known = from.search.model.effects.iter();
            let same = known.filter(|&effect| Candidate::from(effect) == *candidate);
            start.effects.extend(same.cloned());
        }
        start.effects.push(guess.candidate.instance(&guess.values));
        let mut free = from.search.free.clone();
        free.extend(guess.candidate.paths());
        let mut valleys = Valleys::of_samples(self.search.samples());
        let mut fits = Vec::new();
        while !valleys.are_found() {
            let model = scattered(&start, &free, &mut random);
            let options = FitOptions::iterations(START_ITERATIONS);
            let found = fit(&model, &free, &self.search, None, options);
            let found = Hypothesis::new(from.set_with(guess.candidate), found);
            valleys.note(found.search_mean);
            fits.push(found);
        }
        fits
    }
}

#[cfg(test)]
mod tests {
    use super::{STARTS, Valleys};

    fn starts_until_found(costs: impl Iterator<Item = f64>) -> usize {
        let mut valleys = Valleys::of_samples(100);
        let mut costs = costs.into_iter();
        while !valleys.are_found() {
            valleys.note(costs.next().unwrap());
        }
        valleys.starts
    }

    #[test]
    fn one_valley_is_believed_after_eight_starts_and_more_take_more() {
        assert_eq!(starts_until_found(std::iter::repeat(1.0)), 8);
        let two = (0..).map(|k| if k % 5 == 0 { 1.0 } else { 2.0 });
        assert_eq!(starts_until_found(two), 17);
        let late = (0..).map(|k| if k < 5 { 2.0 } else { 1.0 });
        assert_eq!(starts_until_found(late), 17);
        assert_eq!(starts_until_found((1..).map(f64::from)), STARTS);
        assert_eq!(starts_until_found(std::iter::repeat(f64::INFINITY)), 8);
    }
}
