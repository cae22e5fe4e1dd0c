//! How exactly a motion was measured: the floor below which no model can be judged.

use crate::log::Motion;

/// Standard deviation of a joint's position measurement, rad.
///
/// The larger of the resolution's rounding error (D / sqrt 12) and the noise seen in sixth
/// differences. Motion leaks into them where sampling is slow; then neighbours agree, while those
/// of noise alternate (correlation -6/7), and the resolution alone counts.
pub fn noise_rad(motions: &[Motion], joint: usize, declared_resolution_rad: Option<f64>) -> f64 {
    let resolution = declared_resolution_rad.or_else(|| estimated_resolution_rad(motions, joint));
    let rounding = resolution.unwrap_or(0.0) / 12f64.sqrt();
    let differences = differences(motions, joint, ORDER);
    let seen = difference_noise_rad(&differences);
    let counts = seen.is_finite() && (rounding == 0.0 || alternation(&differences) < -0.6);
    rounding.max(if counts { seen } else { 0.0 }).max(1e-6)
}

/// Order of the differences in which noise is looked for.
const ORDER: usize = 6;

/// The step of a quantised position, rad, where all readings are multiples of one.
pub fn estimated_resolution_rad(motions: &[Motion], joint: usize) -> Option<f64> {
    let steps = || {
        motions
            .iter()
            .flat_map(move |m| m.position_rad[joint].windows(2))
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

/// Differences of this order, motion by motion.
fn differences(motions: &[Motion], joint: usize, order: usize) -> Vec<Vec<f64>> {
    motions
        .iter()
        .map(|motion| {
            let mut row = motion.position_rad[joint].clone();
            for _ in 0..order {
                row = row.windows(2).map(|pair| pair[1] - pair[0]).collect();
            }
            row.into_iter().filter(|x| x.is_finite()).collect()
        })
        .collect()
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

/// Standard deviation of the white noise whose differences have this median magnitude.
fn difference_noise_rad(differences: &[Vec<f64>]) -> f64 {
    let mut magnitudes: Vec<f64> = differences.iter().flatten().map(|x| x.abs()).collect();
    if magnitudes.is_empty() {
        return f64::INFINITY;
    }
    let middle = magnitudes.len() / 2;
    let (_, median, _) = magnitudes.select_nth_unstable_by(middle, f64::total_cmp);
    // The variance of the order-k difference of white noise is the central binomial coefficient (2k
    // over k).
    let gain: f64 = (1..=ORDER).map(|i| (ORDER + i) as f64 / i as f64).product();
    1.4826 * *median / gain.sqrt()
}
