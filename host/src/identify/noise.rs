//! How exactly a motion was measured: the floor below which no model can be judged.

use crate::log::Motion;

/// Standard deviation of a joint's position measurement, rad.
///
/// The larger of the resolution's rounding error (D / sqrt 12) and the noise seen in high differences. Motion
/// leaks into differences too, the less the higher their order; where they still fall at the highest order,
/// sampling is too slow to tell noise from motion and the resolution alone counts.
pub fn noise_rad(motions: &[Motion], joint: usize, declared_resolution_rad: Option<f64>) -> f64 {
    let resolution = declared_resolution_rad.or_else(|| found_resolution_rad(motions, joint));
    let rounding = resolution.unwrap_or(0.0) / 12f64.sqrt();
    let fifth = difference_noise_rad(motions, joint, 5);
    let sixth = difference_noise_rad(motions, joint, 6);
    let settled = sixth > 0.8 * fifth;
    let seen = if sixth.is_finite() && (settled || rounding == 0.0) {
        sixth
    } else {
        0.0
    };
    rounding.max(seen).max(1e-6)
}

/// The step of a quantised position, rad, where all readings are multiples of one.
pub fn found_resolution_rad(motions: &[Motion], joint: usize) -> Option<f64> {
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

/// Noise estimated from differences of this order: median magnitude over that of unit white noise.
fn difference_noise_rad(motions: &[Motion], joint: usize, order: usize) -> f64 {
    let mut magnitudes = Vec::new();
    for motion in motions {
        let mut row: Vec<f64> = motion.position_rad[joint].clone();
        for _ in 0..order {
            for k in 0..row.len().saturating_sub(1) {
                row[k] = row[k + 1] - row[k];
            }
            row.pop();
        }
        magnitudes.extend(row.into_iter().map(f64::abs).filter(|x| x.is_finite()));
    }
    if magnitudes.is_empty() {
        return f64::INFINITY;
    }
    let middle = magnitudes.len() / 2;
    let (_, median, _) = magnitudes.select_nth_unstable_by(middle, f64::total_cmp);
    // The variance of the order-k difference of white noise is the central binomial coefficient (2k over k).
    let gain: f64 = (1..=order).map(|i| (order + i) as f64 / i as f64).product();
    1.4826 * *median / gain.sqrt()
}
