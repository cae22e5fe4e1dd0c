//! Sums of sines, each joint at frequencies of its own.

use super::limits::JointLimits;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// Sines of one joint.
const SINES: usize = 6;
/// Tries of random phases; the one with the lowest crest is taken.
const TRIES: usize = 20;
/// Seconds in which it begins and ends.
const FADE_S: f64 = 1.0;

/// Angles of one joint, rad, `samples` of them at `hz`: `at` of `joints` takes every `joints`-th of
/// the frequencies that fit the duration. Scaled to the range or to the speed, whichever is less.
pub(super) fn multisine(
    joint: &JointLimits,
    (at, joints): (usize, usize),
    (samples, hz): (usize, f64),
    band_hz: (f64, f64),
    random: &mut ChaCha8Rng,
) -> Vec<f64> {
    let frequencies = frequencies(at, joints, samples as f64 / hz, band_hz);
    let mut best: Option<(f64, Vec<f64>)> = None;
    for _ in 0..TRIES {
        let phases: Vec<f64> = frequencies
            .iter()
            .map(|_| random.random_range(0.0..TAU))
            .collect();
        let wave = wave(&frequencies, &phases, samples, hz);
        let crest = largest(&wave);
        if best.as_ref().is_none_or(|(least, _)| crest < *least) {
            best = Some((crest, wave));
        }
    }
    let (crest, wave) = best.unwrap_or((1.0, vec![0.0; samples]));
    let steepest = wave.windows(2).map(|w| (w[1] - w[0]).abs() * hz);
    let steepest = steepest.fold(1e-12, f64::max);
    let scale = (joint.half_rad() / crest.max(1e-12)).min(joint.speed_rad_s / steepest);
    let middle = joint.middle_rad();
    wave.iter().map(|value| middle + scale * value).collect()
}

/// Whole periods in the duration, spread evenly over the logarithm of the band.
fn frequencies(at: usize, joints: usize, duration_s: f64, band_hz: (f64, f64)) -> Vec<f64> {
    let count = SINES * joints;
    let of = |k: usize| {
        let share = k as f64 / (count - 1).max(1) as f64;
        let wanted = band_hz.0 * (band_hz.1 / band_hz.0).powf(share);
        (wanted * duration_s).round().max(1.0) / duration_s
    };
    (0..SINES).map(|sine| of(sine * joints + at)).collect()
}

/// Amplitudes fall with the frequency, so that each sine asks for the same speed beyond the lowest.
fn wave(frequencies: &[f64], phases: &[f64], samples: usize, hz: f64) -> Vec<f64> {
    let lowest = frequencies.first().copied().unwrap_or(1.0);
    let value = |k: usize| {
        let time_s = k as f64 / hz;
        let left_s = (samples - 1 - k) as f64 / hz;
        let fade = |seconds: f64| {
            (0.5 * TAU * (seconds / FADE_S).min(1.0) / 2.0)
                .sin()
                .powi(2)
        };
        let sines = frequencies.iter().zip(phases);
        let sum: f64 = sines
            .map(|(f, phase)| (lowest / f).sqrt() * (TAU * f * time_s + phase).sin())
            .sum();
        fade(time_s) * fade(left_s) * sum
    };
    (0..samples).map(value).collect()
}

fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()))
}
