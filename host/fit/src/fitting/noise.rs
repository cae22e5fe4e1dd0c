//! How exactly a motion was measured: the floor below which no model can be judged.

use crate::motion::Motion;

/// How exactly something was measured, rad, m or rad/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Standard deviation of a reading.
    pub deviation: f64,
    /// Standard error of that estimate; 0 where it is the rounding of a known resolution.
    pub error: f64,
}

/// No noise is smaller.
const LEAST: f64 = 1e-6;

/// Standard deviation of what was measured, rad, m or rad/s, in these motions one by one.
///
/// The larger of the resolution's rounding error (D / sqrt 12) and the noise seen in sixth
/// differences. Motion leaks into them where sampling is slow; then neighbours agree, while those
/// of noise alternate (correlation -6/7), and the resolution alone counts. Over uneven time stamps
/// they are divided differences: stamps that are right let no motion through, and the error of
/// stamps that are not is an error of the reading.
pub fn noise(motions: &[Motion], series: &[&[f64]], declared_resolution: Option<f64>) -> Noise {
    let resolution = declared_resolution.or_else(|| estimated_resolution(series));
    let rounding = resolution.unwrap_or(0.0) / 12f64.sqrt();
    let times: Vec<&[f64]> = motions.iter().map(|m| m.time_s.as_slice()).collect();
    let differences = differences(&times, series);
    let seen = difference_noise(&differences);
    let counts = seen.is_finite() && (rounding == 0.0 || alternation(&differences) < -0.6);
    let known = rounding.max(LEAST);
    if counts && seen > known {
        Noise {
            deviation: seen,
            error: seen * relative_error(differences.iter().map(Vec::len).sum()),
        }
    } else {
        Noise {
            deviation: known,
            error: 0.0,
        }
    }
}

/// Order of the differences in which noise is looked for.
const ORDER: usize = 6;

/// The step of a quantised series, in its unit, where all readings are multiples of one.
pub fn estimated_resolution(series: &[&[f64]]) -> Option<f64> {
    let steps = || {
        series
            .iter()
            .flat_map(|values| values.windows(2))
            .map(|pair| (pair[1] - pair[0]).abs())
            .filter(|step| *step > 1e-9)
    };
    let smallest = steps().fold(f64::INFINITY, f64::min);
    // Written with rounded digits, a step is a multiple only to about a hundredth.
    let off = steps()
        .take(2000)
        .filter(|step| {
            let multiple = step / smallest;
            (multiple - multiple.round()).abs() > 0.02 * multiple.max(1.0)
                && (multiple - multiple.round()).abs() > 0.1
        })
        .count();
    let counted = steps().take(2000).count();
    (counted >= 10 && off * 50 <= counted && smallest > 1e-5).then_some(smallest)
}

/// Sixth differences, motion by motion.
fn differences(times: &[&[f64]], series: &[&[f64]]) -> Vec<Vec<f64>> {
    let of_motion = |(time_s, values): (&&[f64], &&[f64])| {
        let differences = if is_even(time_s) {
            even(values)
        } else {
            divided(time_s, values)
        };
        differences.into_iter().filter(|x| x.is_finite()).collect()
    };
    times.iter().zip(series).map(of_motion).collect()
}

/// Largest share by which a step of even time stamps differs from the mean.
const EVEN: f64 = 1e-3;

fn is_even(time_s: &[f64]) -> bool {
    let (Some(first), Some(last)) = (time_s.first(), time_s.last()) else {
        return true;
    };
    let mean = (last - first) / (time_s.len().max(2) - 1) as f64;
    let mut steps = time_s.windows(2).map(|pair| pair[1] - pair[0]);
    steps.all(|step| (step - mean).abs() <= EVEN * mean)
}

fn even(values: &[f64]) -> Vec<f64> {
    let mut row = values.to_vec();
    for _ in 0..ORDER {
        row = row.windows(2).map(|pair| pair[1] - pair[0]).collect();
    }
    row
}

/// Divided differences, scaled so that white noise has the variance it has in even ones.
fn divided(time_s: &[f64], values: &[f64]) -> Vec<f64> {
    let windows = time_s.windows(ORDER + 1).zip(values.windows(ORDER + 1));
    windows
        .map(|(time, values)| {
            let step = (time[ORDER] - time[0]) / ORDER as f64;
            let (mut sum, mut squares) = (0.0, 0.0);
            for (i, value) in values.iter().enumerate() {
                let others = (0..=ORDER).filter(|j| *j != i);
                let weight = 1.0 / others.map(|j| (time[i] - time[j]) / step).product::<f64>();
                sum += weight * value;
                squares += weight * weight;
            }
            sum * (gain() / squares).sqrt()
        })
        .collect()
}

/// Variance of a sixth difference of white noise, per variance of the noise: the central binomial
/// coefficient (2k over k).
fn gain() -> f64 {
    (1..=ORDER).map(|i| (ORDER + i) as f64 / i as f64).product()
}

/// Correlation of neighbouring differences.
fn alternation(differences: &[Vec<f64>]) -> f64 {
    let (mut product, mut square) = (0.0, 1e-300);
    for row in differences {
        for pair in row.windows(2) {
            product += pair[0] * pair[1];
            square += pair[0] * pair[0];
        }
    }
    product / square
}

/// Standard error of [`difference_noise`] as a share of it, of so many differences.
///
/// A median of magnitudes of n normal numbers has 1.17 / sqrt(n). Neighbouring differences agree:
/// their magnitudes do about as the square of their correlation, (2k over k + i) / (2k over k) at a
/// distance of i, so that 3.2 of them count as one.
fn relative_error(differences: usize) -> f64 {
    const OF_MEDIAN: f64 = 1.17;
    const COUNT_AS_ONE: f64 = 3.2;
    OF_MEDIAN * (COUNT_AS_ONE / differences.max(1) as f64).sqrt()
}

/// Standard deviation of the white noise whose differences have this median magnitude.
fn difference_noise(differences: &[Vec<f64>]) -> f64 {
    let mut magnitudes: Vec<f64> = differences.iter().flatten().map(|x| x.abs()).collect();
    if magnitudes.is_empty() {
        return f64::INFINITY;
    }
    let middle = magnitudes.len() / 2;
    let (_, median, _) = magnitudes.select_nth_unstable_by(middle, f64::total_cmp);
    1.4826 * *median / gain().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::closed_loop::normal;
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha8Rng;

    /// Independent normal numbers of this standard deviation.
    fn white(samples: usize, deviation: f64, seed: u64) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        (0..samples).map(|_| deviation * normal(&mut rng)).collect()
    }

    fn estimated(readings: &[f64], resolution: Option<f64>) -> Noise {
        let time_s: Vec<f64> = (0..readings.len()).map(|k| 0.01 * k as f64).collect();
        let motion = Motion {
            time_s,
            position_rad: vec![readings.to_vec()],
            ..Motion::default()
        };
        noise(&[motion], &[readings], resolution)
    }

    #[test]
    fn the_interval_of_noise_holds_it_in_nineteen_of_twenty_logs() {
        const LOGS: u64 = 300;
        let holds = |seed: u64| {
            let noise = estimated(&white(600, 2e-3, seed), Some(1e-3));
            (noise.deviation - 2e-3).abs() < 1.96 * noise.error
        };
        let held = (0..LOGS).filter(|seed| holds(*seed)).count();
        assert!((276..=294).contains(&held), "{held}");
    }

    #[test]
    fn rounding_that_is_known_is_no_estimate() {
        let slow: Vec<f64> = (0..600)
            .map(|k| 0.05 * (0.01 * f64::from(k)).sin())
            .collect();
        let rounded: Vec<f64> = slow.iter().map(|x| 5e-3 * (x / 5e-3).round()).collect();
        let noise = estimated(&rounded, Some(5e-3));
        assert_eq!((noise.deviation, noise.error), (5e-3 / 12f64.sqrt(), 0.0));
    }
}
