//! Errors summed in blocks of time, so that their uncertainty can be estimated by resampling the
//! blocks.

use crate::fitting::{FitProblem, Residuals};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Weighted squared errors of one fit, block by block.
#[derive(Debug, Clone, Default)]
pub(super) struct BlockErrors {
    /// In order of motions and time.
    blocks: Vec<Block>,
    /// Per motion: sum of squared residuals, rad^2 (rad^2/s^2 where no angle is measured), and
    /// their number.
    pub motions: Vec<(f64, usize)>,
    /// Per signal: sum of squared weighted residuals, and their number.
    signals: Vec<(f64, usize)>,
}

/// A stretch of a motion.
#[derive(Debug, Clone, Copy)]
struct Block {
    motion: usize,
    /// Sum of squared weighted residuals.
    sum: f64,
    /// Residuals.
    count: usize,
}

/// Longest block, s: longer than residuals stay correlated on a servo arm.
const BLOCK_S: f64 = 0.8;
/// A motion gives at least this many blocks.
const LEAST_BLOCKS: f64 = 8.0;
/// A signal's root-mean-square weighted residual up to this counts as nothing but noise.
pub(super) const AT_NOISE_FLOOR: f64 = 1.2;
const RESAMPLES: usize = 600;

impl BlockErrors {
    /// Sums weighted residuals.
    pub fn of(residuals: &Residuals, data: &FitProblem) -> BlockErrors {
        let mut errors = BlockErrors {
            motions: vec![(0.0, 0); data.motions.len()],
            signals: vec![(0.0, 0); data.sigma.len()],
            ..BlockErrors::default()
        };
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
                let (mut sum, mut count) = (0.0, 0);
                let total = &mut errors.motions[window.motion];
                for (signal, sigma) in data.sigma.iter().enumerate() {
                    let measured = &data.measured(window.motion, signal)[window.samples.clone()];
                    let known = measured[begin..end]
                        .iter()
                        .filter(|y| y.is_finite())
                        .count();
                    count += known;
                    let of_signal = &mut errors.signals[signal];
                    of_signal.1 += known;
                    total.1 += if data.counts(signal) { known } else { 0 };
                    for r in &residuals[signal * samples + begin..signal * samples + end] {
                        sum += r * r;
                        of_signal.0 += r * r;
                        if data.counts(signal) {
                            total.0 += (r * sigma).powi(2);
                        }
                    }
                }
                errors.blocks.push(Block {
                    motion: window.motion,
                    sum,
                    count,
                });
                begin = end;
            }
        }
        errors
    }

    /// Appends the blocks of other motions.
    pub fn extend<'a>(&mut self, others: impl IntoIterator<Item = &'a BlockErrors>) {
        for other in others {
            let before = self.motions.len();
            self.blocks.extend(other.blocks.iter().map(|block| Block {
                motion: before + block.motion,
                ..*block
            }));
            self.motions.extend(&other.motions);
            for (own, other) in self.signals.iter_mut().zip(&other.signals) {
                *own = (own.0 + other.0, own.1 + other.1);
            }
        }
    }

    /// The same blocks with the squares that another fit of the same motions leaves taken off.
    pub fn less(&self, other: &BlockErrors) -> BlockErrors {
        let mut less = self.clone();
        for (block, left) in less.blocks.iter_mut().zip(&other.blocks) {
            block.sum -= left.sum;
        }
        less
    }

    /// So many times the squares.
    #[cfg(test)]
    pub fn times(&self, factor: f64) -> BlockErrors {
        let mut times = self.clone();
        times
            .blocks
            .iter_mut()
            .for_each(|block| block.sum *= factor);
        let sums = times.motions.iter_mut().chain(&mut times.signals);
        sums.for_each(|(sum, _)| *sum *= factor);
        times
    }

    /// Sum of squared weighted residuals.
    pub fn sum(&self) -> f64 {
        self.blocks.iter().map(|block| block.sum).sum()
    }

    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Number of residuals.
    pub fn count(&self) -> usize {
        self.blocks.iter().map(|block| block.count).sum()
    }

    /// Mean squared weighted residual; 1 is the noise.
    pub fn mean(&self) -> f64 {
        self.sum() / self.count().max(1) as f64
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

    /// Largest mean squared weighted residual of a motion.
    pub fn worst_motion(&self) -> f64 {
        self.motion_means().into_iter().fold(0.0, f64::max)
    }

    /// Mean squared weighted residual of each motion.
    pub fn motion_means(&self) -> Vec<f64> {
        let mut sums = vec![(0.0, 0); self.motions.len()];
        for block in &self.blocks {
            let (sum, count) = &mut sums[block.motion];
            *sum += block.sum;
            *count += block.count;
        }
        let means = sums.iter().map(|(sum, count)| sum / (*count).max(1) as f64);
        means.collect()
    }

    /// Whether nothing but noise is left of any signal: what one joint or sensor shows must not
    /// drown in the others.
    pub fn is_noise(&self) -> bool {
        let mean = |(sum, count): &(f64, usize)| sum / (*count).max(1) as f64;
        self.signals
            .iter()
            .all(|signal| mean(signal).sqrt() < AT_NOISE_FLOOR)
    }
}

/// What a motion's blocks sum to in two fits, and their residuals.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct PairedSums {
    pub before: f64,
    pub after: f64,
    pub count: f64,
}

impl PairedSums {
    /// Gain of log-likelihood of residuals whose noise is this motion's own, one factor before and
    /// one after. Counted in residuals, of which neighbours are alike: good to weigh motions
    /// against each other, not as a number by itself.
    fn gain(&self) -> f64 {
        // No fit is better than the noise.
        let mean = |sum: f64| (sum / self.count.max(1.0)).max(LEAST_MEAN);
        0.5 * self.count * (mean(self.before) / mean(self.after)).ln()
    }
}

/// Mean squared weighted residuals below this are noise that happened to be small.
const LEAST_MEAN: f64 = 0.5;

/// 95 % interval of a statistic of paired blocks by bootstrap, blocks resampled within their
/// motion: motions differ in how large and how variable their errors are.
pub(super) fn bootstrap(
    before: &BlockErrors,
    after: &BlockErrors,
    seed: u64,
    statistic: impl Fn(&[PairedSums]) -> f64,
) -> [f64; 2] {
    let strata = strata(before, after);
    if strata.is_empty() {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut drawn = |blocks: &Vec<PairedSums>| {
        let draws = (0..blocks.len()).map(|_| blocks[random.random_range(0..blocks.len())]);
        total(draws)
    };
    let mut values: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let sums: Vec<PairedSums> = strata.iter().map(&mut drawn).collect();
            statistic(&sums)
        })
        .collect();
    values.sort_by(f64::total_cmp);
    [RESAMPLES / 40, RESAMPLES - 1 - RESAMPLES / 40].map(|k| values[k])
}

/// The paired blocks of each motion that has any.
fn strata(before: &BlockErrors, after: &BlockErrors) -> Vec<Vec<PairedSums>> {
    let mut strata = vec![Vec::new(); before.motions.len()];
    for (before, after) in before.blocks.iter().zip(&after.blocks) {
        strata[before.motion].push(PairedSums {
            before: before.sum,
            after: after.sum,
            count: before.count as f64,
        });
    }
    strata.retain(|blocks| !blocks.is_empty());
    strata
}

fn total(sums: impl Iterator<Item = PairedSums>) -> PairedSums {
    sums.fold(PairedSums::default(), |sum, block| PairedSums {
        before: sum.before + block.before,
        after: sum.after + block.after,
        count: sum.count + block.count,
    })
}

/// Per motion: what its blocks sum to in both fits.
pub(super) fn paired(before: &BlockErrors, after: &BlockErrors) -> Vec<PairedSums> {
    let strata = strata(before, after);
    strata
        .into_iter()
        .map(|blocks| total(blocks.into_iter()))
        .collect()
}

/// Log-likelihood gained from `before` to `after`, summed over motions, each with its own noise: a
/// motion where nothing changes adds nothing, however large its errors.
pub(super) fn gain(motions: &[PairedSums]) -> f64 {
    motions.iter().map(PairedSums::gain).sum()
}

/// Largest relative reduction of the root-mean-square error among motions.
pub(super) fn largest_reduction(motions: &[PairedSums]) -> f64 {
    let reduction = |m: &PairedSums| 1.0 - (m.after / m.before.max(1e-300)).sqrt();
    motions
        .iter()
        .map(reduction)
        .fold(f64::NEG_INFINITY, f64::max)
}

/// 95 % interval of the relative reduction of the root-mean-square error from `before` to `after`.
pub(super) fn reduction(before: &BlockErrors, after: &BlockErrors, seed: u64) -> [f64; 2] {
    bootstrap(before, after, seed, |motions| {
        let all = total(motions.iter().copied());
        1.0 - (all.after / all.before.max(1e-300)).sqrt()
    })
}

/// Whether `worse` is significantly worse than `better`: the lower 95 % limit of the difference is
/// above zero.
pub(super) fn significantly_worse(worse: &BlockErrors, better: &BlockErrors, seed: u64) -> bool {
    bootstrap(worse, better, seed, gain)[0] > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One motion for each list of sums; each block has ten residuals.
    fn errors(motions: &[&[f64]]) -> BlockErrors {
        let mut errors = BlockErrors {
            motions: vec![(0.0, 0); motions.len()],
            ..BlockErrors::default()
        };
        for (motion, sums) in motions.iter().enumerate() {
            let blocks = sums.iter().map(|sum| Block {
                motion,
                sum: *sum,
                count: 10,
            });
            errors.blocks.extend(blocks);
        }
        errors
    }

    #[test]
    fn a_motion_with_large_errors_does_not_swamp_another() {
        let wild: Vec<f64> = (0..20).map(|k| 1e6 * f64::from(1 + k % 7)).collect();
        let (calm, calmer) = (vec![100.0; 20], vec![20.0; 20]);
        let before = errors(&[&wild, &calm]);
        let after = errors(&[&wild, &calmer]);
        assert!(significantly_worse(&before, &after, 1));
        let alone = gain(&paired(&errors(&[&calm]), &errors(&[&calmer])));
        assert!((gain(&paired(&before, &after)) - alone).abs() < 1e-9);
    }

    #[test]
    fn what_one_signal_shows_does_not_drown_in_the_others() {
        let noise = |means: &[f64]| {
            let signals = means.iter().map(|mean| (1000.0 * mean, 1000)).collect();
            let errors = BlockErrors {
                signals,
                ..errors(&[&[10.0; 8]])
            };
            errors.is_noise()
        };
        assert!(noise(&[1.0, 1.4, 1.0]));
        assert!(!noise(&[1.0, 1.5, 1.0]));
        assert!(!noise(&[f64::NAN, 1.0]));
    }

    #[test]
    fn blocks_are_resampled_within_their_motion() {
        // Each motion gains the same in all of its blocks: nothing is left to chance.
        let before = errors(&[&[1000.0; 8], &[40.0; 8]]);
        let after = errors(&[&[500.0; 8], &[30.0; 8]]);
        let [low, high] = bootstrap(&before, &after, 1, gain);
        assert!((high - low).abs() < 1e-9, "{low} {high}");
    }

    #[test]
    fn what_another_fit_leaves_is_taken_off_block_by_block() {
        let (before, after) = (errors(&[&[10.0, 20.0]]), errors(&[&[4.0, 5.0]]));
        let removed = before.less(&after);
        assert_eq!(removed.sum(), 21.0);
        assert_eq!(removed.blocks[0].sum, 6.0);
    }

    #[test]
    fn what_is_gained_in_some_blocks_and_lost_in_others_is_not_significant() {
        let before = errors(&[&[100.0, 50.0, 100.0, 50.0, 100.0, 50.0, 100.0, 50.0]]);
        let after = errors(&[&[50.0, 100.0, 50.0, 100.0, 50.0, 100.0, 50.0, 99.0]]);
        assert!(!significantly_worse(&before, &after, 1));
    }
}
