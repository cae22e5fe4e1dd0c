//! The offset of two clocks, from a signal that both logs hold.

use super::{Alignment, Timed};
use crate::error::{Error, Result};
use crate::output::number::short;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// Correlations below this are chance, or another motion.
const LEAST_CORRELATION: f64 = 0.9;
/// Another peak this near the best one leaves the offset open.
const AS_GOOD: f64 = 0.98;
/// Least share of the shorter log that must overlap.
const LEAST_OVERLAP: f64 = 0.25;
/// Most samples of a common grid.
const MOST_SAMPLES: usize = 1 << 20;

/// The offset at which two signals agree best, and which they are.
pub(super) fn aligned(
    first: &Timed,
    second: &Timed,
    named: Option<&(String, String)>,
) -> Result<(f64, Alignment)> {
    let (ours, theirs) = match named {
        Some((a, b)) => (
            vec![first.column(a, "first")?],
            vec![second.column(b, "second")?],
        ),
        None => (first.signals(), second.signals()),
    };
    let longest_s = first.duration_s().max(second.duration_s());
    let step_s = first.step_s().min(second.step_s());
    let step_s = step_s.max(longest_s / (MOST_SAMPLES / 2) as f64);
    let samples = |log: &Timed| (log.duration_s() / step_s) as usize + 1;
    let grids = |log: &Timed, columns: &[usize]| -> Vec<Vec<f64>> {
        let grid = |column: &usize| log.gridded(*column, step_s, samples(log));
        columns.iter().map(grid).collect()
    };
    let (own, other) = (grids(first, &ours), grids(second, &theirs));
    let mut best: Option<(Peak, usize, usize)> = None;
    for (i, a) in own.iter().enumerate() {
        for (j, b) in other.iter().enumerate() {
            // Columns of one name count the same way round.
            let same_name = first.log.names[ours[i]] == second.log.names[theirs[j]];
            let peak = peak(a, b, same_name);
            let better = |(found, ..): &(Peak, usize, usize)| {
                peak.correlation.abs() > found.correlation.abs()
            };
            if best.as_ref().is_none_or(better) {
                best = Some((peak, ours[i], theirs[j]));
            }
        }
    }
    let remedy = "say which columns hold the same signal (--align FIRST=SECOND), or give --offset";
    let Some((peak, a, b)) = best else {
        return Err(Error::usage("no column of the logs changes", remedy));
    };
    let (a, b) = (first.log.names[a].clone(), second.log.names[b].clone());
    let percent = |correlation: f64| short(100.0 * correlation.abs());
    if peak.correlation.abs() < LEAST_CORRELATION {
        let what = format!(
            "no signal of the logs agrees: `{a}` and `{b}` correlate best, by {} %, where {} % are \
             the least of two records of one motion",
            percent(peak.correlation),
            percent(LEAST_CORRELATION)
        );
        return Err(Error::usage(what, remedy));
    }
    if peak.rival.abs() > AS_GOOD * peak.correlation.abs() {
        let what = format!(
            "`{a}` and `{b}` repeat themselves: another offset fits by {} % where the best one \
             does by {} %",
            percent(peak.rival),
            percent(peak.correlation)
        );
        return Err(Error::usage(what, remedy));
    }
    let offset_s = first.time_s[0] - second.time_s[0] + peak.lag * step_s;
    let alignment = Alignment {
        first: a,
        second: b,
        correlation: peak.correlation,
    };
    Ok((offset_s, alignment))
}

/// Where two signals agree best.
#[derive(Debug, Clone, Copy)]
struct Peak {
    /// Samples by which the second is late against the first, with a fraction.
    lag: f64,
    /// Correlation there, over what overlaps.
    correlation: f64,
    /// Largest correlation beyond the peak's own hill.
    rival: f64,
}

/// Correlates by Fourier transforms; what overlaps too little does not count, nor do negative
/// correlations if `same_way`.
fn peak(a: &[f64], b: &[f64], same_way: bool) -> Peak {
    let size = (a.len() + b.len()).next_power_of_two();
    let raw = correlated(a, b, size);
    let (own, other) = (energies(a), energies(b));
    let least = (LEAST_OVERLAP * a.len().min(b.len()) as f64) as usize;
    let lags = 1 - b.len() as i64..a.len() as i64;
    let at = |lag: i64| {
        let (from, to) = (lag.max(0), (b.len() as i64 + lag).min(a.len() as i64));
        if to - from < least.max(8) as i64 {
            return 0.0;
        }
        let energy = |sums: &[f64], from: i64, to: i64| sums[to as usize] - sums[from as usize];
        let scale = energy(&own, from, to) * energy(&other, from - lag, to - lag);
        // Nothing that moves correlates with nothing.
        let whole = own[a.len()] * other[b.len()];
        if scale <= 1e-4 * whole {
            return 0.0;
        }
        let correlation = raw[lag.rem_euclid(size as i64) as usize] / scale.sqrt();
        if same_way {
            correlation.max(0.0)
        } else {
            correlation
        }
    };
    let values: Vec<f64> = lags.clone().map(at).collect();
    let best = (0..values.len()).max_by(|i, j| values[*i].abs().total_cmp(&values[*j].abs()));
    let best = best.unwrap_or_default();
    let sign = values.get(best).copied().unwrap_or_default().signum();
    let height = |k: usize| sign * values.get(k).copied().unwrap_or_default();
    // The hill ends where the correlation is half as high.
    let left = (0..best).rev().find(|k| height(*k) < 0.5 * height(best));
    let right = (best..values.len()).find(|k| height(*k) < 0.5 * height(best));
    let beyond = |k: &usize| left.is_some_and(|l| *k < l) || right.is_some_and(|r| *k > r);
    let rival = (0..values.len()).filter(beyond).map(|k| values[k].abs());
    let bend = height(best.wrapping_sub(1)) - 2.0 * height(best) + height(best + 1);
    let fraction = if bend < 0.0 {
        0.5 * (height(best.wrapping_sub(1)) - height(best + 1)) / bend
    } else {
        0.0
    };
    Peak {
        lag: (lags.start + best as i64) as f64 + fraction.clamp(-0.5, 0.5),
        correlation: values.get(best).copied().unwrap_or_default(),
        rival: rival.fold(0.0, f64::max),
    }
}

/// sum over k of a(k + lag) b(k), at `lag` modulo `size`.
fn correlated(a: &[f64], b: &[f64], size: usize) -> Vec<f64> {
    let mut planner = FftPlanner::new();
    let forward = planner.plan_fft_forward(size);
    let transformed = |values: &[f64]| {
        let mut all: Vec<Complex<f64>> = values.iter().map(|v| Complex::new(*v, 0.0)).collect();
        all.resize(size, Complex::default());
        forward.process(&mut all);
        all
    };
    let mut product: Vec<Complex<f64>> = transformed(a)
        .iter()
        .zip(transformed(b))
        .map(|(a, b)| a * b.conj())
        .collect();
    planner.plan_fft_inverse(size).process(&mut product);
    product.iter().map(|value| value.re / size as f64).collect()
}

/// Sums of squares up to each sample.
fn energies(values: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let sums = values.iter().map(|value| {
        sum += value * value;
        sum
    });
    std::iter::once(0.0).chain(sums).collect()
}
