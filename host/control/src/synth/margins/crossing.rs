//! Where a gain, a phase or a delay brings a loop to the edge of stability.

use super::response::{Grid, Matrix};
use super::{LoopMargin, OpenLoop};
use crate::synth::error::DesignError;
use nalgebra::{Complex, Schur};
use std::f64::consts::{PI, TAU};

/// Halvings of an interval: to the last digit.
const HALVINGS: usize = 60;

/// First step of the gain's logarithm from 1, how much longer the next ones are, and the last
/// place.
const GAIN_STEPS: (f64, f64, f64) = (0.002, 1.04, 12.0);

/// Of all channels together.
pub(super) fn common(open: &OpenLoop, grid: &Grid) -> Result<LoopMargin, DesignError> {
    if open.b.ncols() == 1 {
        return Ok(single(grid, 0));
    }
    let [phase_rad, delay_s] = phase_and_delay(grid, &|s| eigenvalues(s.clone()));
    Ok(LoopMargin {
        gain: [
            gain_limit(open, -1.0)?.unwrap_or(0.0),
            gain_limit(open, 1.0)?.unwrap_or(f64::INFINITY),
        ],
        phase_rad,
        delay_s,
    })
}

/// Of one channel alone: its loop has the sensitivity that stands on the diagonal of S.
pub(super) fn single(grid: &Grid, channel: usize) -> LoopMargin {
    let own = |s: &Matrix| s[(channel, channel)];
    let [phase_rad, delay_s] = phase_and_delay(grid, &|s| vec![own(s)]);
    let mut gain = [0.0, f64::INFINITY];
    let mut meets = |s: Complex<f64>| {
        // s = g / (g - 1) of a positive g lies outside of 0 to 1.
        let factor = s.re / (s.re - 1.0);
        if s.re < 0.0 {
            gain[0] = f64::max(gain[0], factor);
        } else if s.re > 1.0 {
            gain[1] = f64::min(gain[1], factor);
        }
    };
    for pair in grid.points.windows(2) {
        let [low, high] = [pair[0].0, pair[1].0];
        let [before, after] = [own(&pair[0].1), own(&pair[1].1)];
        for end in [before, after] {
            // At both ends of the frequencies S is real, to the digits that its solution leaves.
            if end.im.abs() <= 1e-13 * end.norm() {
                meets(end);
            }
        }
        if before.im * after.im < 0.0 {
            let sign = before.im.signum();
            let at = halve(low, high, |f| sign * own(&grid.sensitivity(f)).im > 0.0);
            meets(own(&grid.sensitivity(at)));
        }
    }
    LoopMargin {
        gain,
        phase_rad,
        delay_s,
    }
}

/// The last place from `low` towards `high` where `holds`, which it does at `low` alone.
fn halve(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// The gain nearest to 1 at which the loop is lost, upwards or downwards; none up to e^12.
fn gain_limit(open: &OpenLoop, direction: f64) -> Result<Option<f64>, DesignError> {
    let (mut step, longer, last) = GAIN_STEPS;
    let mut good = 0.0;
    while good < last {
        let mut bad = good + step;
        if open.is_stable((direction * bad).exp())? {
            good = bad;
            step *= longer;
            continue;
        }
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(good, bad);
            if open.is_stable((direction * middle).exp())? {
                good = middle;
            } else {
                bad = middle;
            }
        }
        return Ok(Some((direction * good).exp()));
    }
    Ok(None)
}

/// The least phase and delay at which an eigenvalue of L meets -1.
///
/// Sorted, the moduli of eigenvalues are continuous functions of the frequency.
fn phase_and_delay(grid: &Grid, of: &dyn Fn(&Matrix) -> Vec<Complex<f64>>) -> [Option<f64>; 2] {
    // |L| / (1 + |L|), which stays finite where S is 0.
    let size = |s: &Complex<f64>| (1.0 - s).norm() / ((1.0 - s).norm() + s.norm());
    let sorted = |s: &Matrix| {
        let mut values = of(s);
        values.sort_by(|a, b| size(a).total_cmp(&size(b)));
        values
    };
    let mut least = [None::<f64>; 2];
    let mut lower = |which: usize, value: f64| {
        least[which] = Some(least[which].map_or(value, |least| least.min(value)));
    };
    let mut before: Option<(f64, Vec<Complex<f64>>)> = None;
    for (frequency, s) in &grid.points {
        let here = sorted(s);
        if let Some((low, left)) = &before {
            for which in 0..here.len() {
                let above = size(&left[which]) > 0.5;
                if above == (size(&here[which]) > 0.5) {
                    continue;
                }
                let value = |f| sorted(&grid.sensitivity(f))[which];
                let at = halve(*low, *frequency, |f| (size(&value(f)) > 0.5) == above);
                let s = value(at);
                // How far L may still turn back until it is -1.
                let turn = (((1.0 - s) / s).arg() + PI).rem_euclid(TAU);
                lower(0, turn.min(TAU - turn));
                if at > 0.0 {
                    lower(1, turn / grid.rad_s(at));
                }
            }
        }
        before = Some((*frequency, here));
    }
    least
}

/// Of a small matrix.
fn eigenvalues(of: Matrix) -> Vec<Complex<f64>> {
    if of.nrows() == 2 {
        let half = (of[(0, 0)] + of[(1, 1)]) / 2.0;
        let difference = (of[(0, 0)] - of[(1, 1)]) / 2.0;
        let root = (difference * difference + of[(0, 1)] * of[(1, 0)]).sqrt();
        return vec![half + root, half - root];
    }
    Schur::new(of).unpack().1.diagonal().as_slice().to_vec()
}
