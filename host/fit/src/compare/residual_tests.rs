//! Whether what a model leaves is chance, or still follows from something: three tests at 99 %.
//!
//! Samples are counted, not timed. Motions stand end to end, but no product reaches across their
//! borders.

use super::result::ResidualTest;
use crate::fitting::FitProblem;
use crate::model::MeasuredSignal;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Lags looked at, in samples, as in MATLAB's `resid`.
const LAGS: usize = 25;
/// Most lags summed for the effective number of samples.
const MEMORY: usize = 400;
/// A test on fewer samples says nothing.
const LEAST_SAMPLES: usize = 40;
/// Normal quantile of 1 - 0.01 / (2 * 51): the largest of 51 lags, two-sided (Bonferroni).
const Z_99_OF_51: f64 = 3.725;

/// Tests of one signal's residual, rad or rad/s, per motion; none where there are too few samples.
pub(super) fn residual_tests(
    data: &FitProblem,
    signal: usize,
    residual: &[Vec<f64>],
) -> Vec<ResidualTest> {
    if residual.iter().map(Vec::len).sum::<usize>() < LEAST_SAMPLES {
        return Vec::new();
    }
    let (motions, joint) = (&data.motions, data.joint_of(signal));
    let driven = motions.iter().all(|m| m.input[joint].is_some());
    let cause: Vec<Vec<f64>> = motions
        .iter()
        .enumerate()
        .map(|(index, m)| match &m.input[joint] {
            Some(input) if driven => input.clone(),
            _ => data.measured(index, signal).to_vec(),
        })
        .collect();
    let cause_name = match (driven, data.signals[signal]) {
        (true, _) => "input",
        (false, MeasuredSignal::Rate) => "rate",
        (false, _) => "angle",
    };
    let residual = zero_gaps(residual);
    let mut tests = vec![whiteness(&residual)];
    tests.extend(independence(&residual, &cause, cause_name));
    tests.extend(linearity(&residual, &cause, cause_name));
    tests
}

/// Whether each residual is free of its predecessors: Ljung & Box (1978), Biometrika 65, 297-303.
///
/// The mean stays in: a constant error is no chance.
pub fn whiteness(residual: &[Vec<f64>]) -> ResidualTest {
    let samples: usize = residual.iter().map(Vec::len).sum();
    let power = product_sum(residual, residual, 0);
    let lags = LAGS.min(samples / 4);
    let mut statistic = 0.0;
    for lag in 1..=lags {
        let pairs: usize = residual.iter().map(|e| e.len().saturating_sub(lag)).sum();
        if pairs > 0 && power > 0.0 {
            let correlation = product_sum(residual, residual, lag as isize) / power;
            statistic += correlation.powi(2) / pairs as f64;
        }
    }
    statistic *= samples as f64 * (samples as f64 + 2.0);
    let threshold = chi_square_99(lags as f64);
    verdict(
        "whiteness (Ljung-Box)",
        statistic,
        threshold,
        "what is left is white: nothing in it could be predicted from its past",
        "each error resembles the one before: something with a course in time is not modelled",
    )
}

/// Whether the residual is free of the input, now or up to 25 samples away: Ljung (1999), System
/// Identification, 16.6. The band is for the largest correlation of all lags and allows for both
/// signals' memory. None where the band admits any correlation: motions so slow that their samples
/// hardly tell more than one.
pub fn independence(
    residual: &[Vec<f64>],
    cause: &[Vec<f64>],
    cause_name: &str,
) -> Option<ResidualTest> {
    let (statistic, threshold) = cross(&centred(residual), &centred(cause))?;
    Some(verdict(
        "independence of the input",
        statistic,
        threshold,
        &format!("what is left does not follow the {cause_name}"),
        &format!(
            "what is left follows the {cause_name}: its way to the angle is not fully modelled"
        ),
    ))
}

/// Whether the residual's size is free of the input's: Billings & Voon (1986), Int. J. Control 44,
/// 235-244. None as above.
pub(super) fn linearity(
    residual: &[Vec<f64>],
    cause: &[Vec<f64>],
    cause_name: &str,
) -> Option<ResidualTest> {
    let squared = |signal: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        let square = |row: Vec<f64>| row.into_iter().map(|x| x * x).collect();
        centred(&signal.into_iter().map(square).collect::<Vec<_>>())
    };
    let (statistic, threshold) = cross(&squared(centred(residual)), &squared(centred(cause)))?;
    Some(verdict(
        "no nonlinearity left",
        statistic,
        threshold,
        &format!("the size of what is left does not depend on the size of the {cause_name}"),
        &format!("what is left grows or shrinks with the {cause_name}: a nonlinearity is missing"),
    ))
}

fn verdict(
    name: &'static str,
    statistic: f64,
    threshold: f64,
    good: &str,
    bad: &str,
) -> ResidualTest {
    let passed = statistic <= threshold;
    ResidualTest {
        name,
        statistic,
        threshold,
        passed,
        meaning: if passed { good } else { bad }.to_string(),
    }
}

/// Largest |correlation| over the lags, and its 99 % band: sqrt(sum of r_a r_b over all lags / N);
/// none where a signal is constant or the band reaches 1.
fn cross(a: &[Vec<f64>], b: &[Vec<f64>]) -> Option<(f64, f64)> {
    let samples: usize = a.iter().map(Vec::len).sum();
    let (power_a, power_b) = (product_sum(a, a, 0), product_sum(b, b, 0));
    if power_a <= 0.0 || power_b <= 0.0 {
        return None;
    }
    let lags = LAGS as isize;
    let largest = (-lags..=lags)
        .map(|lag| product_sum(a, b, lag).abs())
        .fold(0.0, f64::max);
    let memory = MEMORY.min(samples / 4);
    let mut sum = 1.0;
    for lag in 1..=memory {
        let taper = 1.0 - lag as f64 / (memory + 1) as f64;
        let shift = lag as isize;
        let (ra, rb) = (product_sum(a, a, shift), product_sum(b, b, shift));
        sum += 2.0 * taper * ra * rb / (power_a * power_b);
    }
    let band = Z_99_OF_51 * (sum.max(1.0) / samples as f64).sqrt();
    (band < 1.0).then(|| (largest / (power_a * power_b).sqrt(), band))
}

/// Sum of a(k) b(k + lag) within motions.
fn product_sum(a: &[Vec<f64>], b: &[Vec<f64>], lag: isize) -> f64 {
    let skip = lag.unsigned_abs();
    a.iter()
        .zip(b)
        .map(|(a, b)| {
            let (first, second) = if lag >= 0 { (a, b) } else { (b, a) };
            let later = second.iter().skip(skip);
            first.iter().zip(later).map(|(x, y)| x * y).sum::<f64>()
        })
        .sum()
}

fn zero_gaps(signal: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let fill = |x: &f64| if x.is_finite() { *x } else { 0.0 };
    signal
        .iter()
        .map(|row| row.iter().map(fill).collect())
        .collect()
}

/// With the mean over all motions taken out; what was not measured counts as the mean.
fn centred(signal: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let known = || signal.iter().flatten().filter(|x| x.is_finite());
    let mean = known().sum::<f64>() / known().count().max(1) as f64;
    let centre = |x: &f64| if x.is_finite() { x - mean } else { 0.0 };
    signal
        .iter()
        .map(|row| row.iter().map(centre).collect())
        .collect()
}

/// 99 % quantile of chi-square with this many degrees of freedom.
fn chi_square_99(freedom: f64) -> f64 {
    ChiSquared::new(freedom).map_or(f64::INFINITY, |chi_square| chi_square.inverse_cdf(0.99))
}
