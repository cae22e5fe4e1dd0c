//! Errors summed in blocks of time, so that their uncertainty can be estimated by resampling the
//! blocks.

use crate::fitting::{FitData, Residuals};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Weighted squared errors of one fit, block by block.
#[derive(Debug, Clone, Default)]
pub(super) struct BlockErrors {
    /// Sum of squared weighted residuals per block.
    pub sums: Vec<f64>,
    /// Residuals per block.
    pub counts: Vec<usize>,
    /// Per motion: sum of squared residuals, rad^2, and their number.
    pub motions: Vec<(f64, usize)>,
}

/// Longest block, s: longer than residuals stay correlated on a servo arm.
const BLOCK_S: f64 = 0.8;
/// A motion gives at least this many blocks.
const LEAST_BLOCKS: f64 = 8.0;
/// A root-mean-square weighted residual up to this counts as nothing but noise.
pub(super) const AT_NOISE_FLOOR: f64 = 1.2;
const RESAMPLES: usize = 600;

impl BlockErrors {
    /// Sums weighted residuals.
    pub fn of(residuals: &Residuals, data: &FitData) -> BlockErrors {
        let mut errors = BlockErrors {
            motions: vec![(0.0, 0); data.motions.len()],
            ..BlockErrors::default()
        };
        let joints = data.joints();
        for (window, residuals) in data.windows.iter().zip(&residuals.windows) {
            let motion = &data.motions[window.motion];
            let time = &motion.time_s[window.samples.clone()];
            let block_s = BLOCK_S.min(motion.duration_s() / LEAST_BLOCKS);
            let samples = time.len();
            let mut begin = 0;
            while begin < samples {
                let mut end = begin + 1;
                while end < samples && time[end] - time[begin] < block_s {
                    end += 1;
                }
                let mut sum = 0.0;
                let total = &mut errors.motions[window.motion];
                for (joint, sigma) in data.sigma_rad.iter().enumerate() {
                    for r in &residuals[joint * samples + begin..joint * samples + end] {
                        sum += r * r;
                        total.0 += (r * sigma).powi(2);
                    }
                }
                total.1 += (end - begin) * joints;
                errors.sums.push(sum);
                errors.counts.push((end - begin) * joints);
                begin = end;
            }
        }
        errors
    }

    /// Appends the blocks of other motions.
    pub fn extend<'a>(&mut self, others: impl IntoIterator<Item = &'a BlockErrors>) {
        for other in others {
            self.sums.extend(&other.sums);
            self.counts.extend(&other.counts);
            self.motions.extend(&other.motions);
        }
    }

    /// Number of residuals.
    pub fn count(&self) -> usize {
        self.counts.iter().sum()
    }

    /// Mean squared weighted residual; 1 is the noise.
    pub fn mean(&self) -> f64 {
        self.sums.iter().sum::<f64>() / self.count().max(1) as f64
    }

    /// Root-mean-square error of all motions, rad.
    pub fn rms_rad(&self) -> f64 {
        let sum: f64 = self.motions.iter().map(|m| m.0).sum();
        let count: usize = self.motions.iter().map(|m| m.1).sum();
        (sum / count.max(1) as f64).sqrt()
    }

    /// Root-mean-square weighted residual; 1 is the noise.
    pub fn rms(&self) -> f64 {
        self.mean().sqrt()
    }
}

/// 95 % interval of a statistic of paired blocks by bootstrap: `statistic` gets the two sums of a
/// resample.
pub(super) fn bootstrap(
    a: &BlockErrors,
    b: &BlockErrors,
    seed: u64,
    statistic: impl Fn(f64, f64) -> f64,
) -> [f64; 2] {
    let blocks = a.sums.len();
    if blocks == 0 {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut values: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let (mut sum_a, mut sum_b) = (0.0, 0.0);
            for _ in 0..blocks {
                let k = random.random_range(0..blocks);
                sum_a += a.sums[k];
                sum_b += b.sums[k];
            }
            statistic(sum_a, sum_b)
        })
        .collect();
    values.sort_by(f64::total_cmp);
    [RESAMPLES / 40, RESAMPLES - 1 - RESAMPLES / 40].map(|k| values[k])
}

/// 95 % interval of the relative reduction of the root-mean-square error from `before` to `after`.
pub(super) fn reduction(before: &BlockErrors, after: &BlockErrors, seed: u64) -> [f64; 2] {
    bootstrap(before, after, seed, |before, after| {
        1.0 - (after / before.max(1e-300)).sqrt()
    })
}

/// Whether `worse` is significantly worse than `better`: the lower 95 % limit of the difference is
/// above zero.
pub(super) fn significantly_worse(worse: &BlockErrors, better: &BlockErrors, seed: u64) -> bool {
    bootstrap(worse, better, seed, |worse, better| worse - better)[0] > 0.0
}
