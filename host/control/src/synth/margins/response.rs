//! The sensitivity over frequency: where it is looked at, and its peaks.

use super::OpenLoop;
use crate::synth::eigen::poles;
use crate::synth::error::DesignError;
use nalgebra::{Complex, DMatrix};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Frequencies between the slowest and the fastest, before those near poles.
const COUNT: usize = 800;

/// A peak between two points is no higher than one of them divided by this.
const BETWEEN_POINTS: f64 = 0.8;

/// Steps of a golden section: the place is known to 1e-8 of the interval, the value far better.
const GOLDEN_STEPS: usize = 40;

/// Places about a pole that is near the edge of stability, in its distances from it.
const NEAR: [f64; 11] = [-8.0, -4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0, 8.0];

/// A response is one matrix per frequency.
pub(super) type Matrix = DMatrix<Complex<f64>>;

/// S at many frequencies, and anywhere between them.
pub(super) struct Grid {
    closed: Matrix,
    b: Matrix,
    c: Matrix,
    ts_s: Option<f64>,
    /// Frequencies, rad per sample, or rad/s in continuous time, with S there.
    pub points: Vec<(f64, Matrix)>,
}

impl Grid {
    pub(super) fn of(open: &OpenLoop) -> Result<Grid, DesignError> {
        let complex = |m: &DMatrix<f64>| m.map(|value| Complex::new(value, 0.0));
        let closed = open.closed(1.0);
        let all = [poles(&closed)?, poles(&open.a)?].concat();
        let mut grid = Grid {
            closed: complex(&closed),
            b: complex(&open.b),
            c: complex(&open.c),
            ts_s: open.ts_s,
            points: Vec::new(),
        };
        let frequencies = frequencies(&all, open.ts_s.is_some());
        let at = |frequency| (frequency, grid.sensitivity(frequency));
        grid.points = frequencies.into_iter().map(at).collect();
        Ok(grid)
    }

    /// S = I - C (zI - A + BC)^-1 B.
    pub(super) fn sensitivity(&self, frequency: f64) -> Matrix {
        let (n, m) = self.b.shape();
        let z = match self.ts_s {
            Some(_) => Complex::from_polar(1.0, frequency),
            None => Complex::new(0.0, frequency),
        };
        let shifted = DMatrix::from_diagonal_element(n, n, z) - &self.closed;
        let identity = DMatrix::identity(m, m);
        match shifted.lu().solve(&self.b) {
            Some(states) => identity - &self.c * states,
            // A pole on the edge of stability to the last digit: no margin is left.
            None => identity * Complex::new(f64::MAX.sqrt(), 0.0),
        }
    }

    /// A frequency of the grid in rad/s.
    pub(super) fn rad_s(&self, frequency: f64) -> f64 {
        frequency / self.ts_s.unwrap_or(1.0)
    }

    /// The largest value of a function of S, and its frequency in rad/s. Where it may be is seen by
    /// `roughly`, which is never below it.
    pub(super) fn peak(
        &self,
        roughly: impl Fn(&Matrix) -> f64 + Sync,
        of: impl Fn(&Matrix) -> f64 + Sync,
    ) -> (f64, f64) {
        let above: Vec<f64> = self.points.par_iter().map(|(_, s)| roughly(s)).collect();
        let highest = (0..above.len()).max_by(|a, b| above[*a].total_cmp(&above[*b]));
        let known = highest.map_or(0.0, |at| of(&self.points[at].1));
        let exact = self.points.par_iter().zip(&above).map(|((_, s), above)| {
            if *above < BETWEEN_POINTS * known {
                0.0
            } else {
                of(s)
            }
        });
        let values: Vec<f64> = exact.collect();
        let largest = values.iter().copied().fold(0.0, f64::max);
        let last = values.len() - 1;
        let about = |at: usize| (at.saturating_sub(1), (at + 1).min(last));
        // Of equal neighbours the first is enough.
        let is_peak = |at: &usize| {
            let (value, (low, high)) = (values[*at], about(*at));
            value >= BETWEEN_POINTS * largest
                && value >= values[high]
                && (*at == 0 || value > values[low])
        };
        let places: Vec<usize> = (0..values.len()).filter(is_peak).collect();
        let found: Vec<[(f64, f64); 2]> = places
            .into_par_iter()
            .map(|at| {
                let (low, high) = about(at);
                let ends = [self.points[low].0, self.points[high].0];
                let here = (values[at], self.points[at].0);
                [
                    here,
                    golden(ends, &|frequency| of(&self.sensitivity(frequency))),
                ]
            })
            .collect();
        let best =
            found.into_iter().flatten().fold(
                (0.0, 0.0),
                |best, own| {
                    if own.0 > best.0 { own } else { best }
                },
            );
        (best.0, self.rad_s(best.1))
    }
}

/// The largest value between two ends by golden section, and its place.
fn golden([mut low, mut high]: [f64; 2], of: &dyn Fn(f64) -> f64) -> (f64, f64) {
    let share = (5f64.sqrt() - 1.0) / 2.0;
    let inner = |low: f64, high: f64| [high - share * (high - low), low + share * (high - low)];
    let [mut left, mut right] = inner(low, high);
    let (mut at_left, mut at_right) = (of(left), of(right));
    for _ in 0..GOLDEN_STEPS {
        if at_left > at_right {
            (high, right, at_right) = (right, left, at_left);
            left = inner(low, high)[0];
            at_left = of(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = inner(low, high)[1];
            at_right = of(right);
        }
    }
    if at_left > at_right {
        (at_left, left)
    } else {
        (at_right, right)
    }
}

/// From far below the slowest pole to the highest frequency there is, close together about poles
/// near the edge of stability.
fn frequencies(poles: &[Complex<f64>], sampled: bool) -> Vec<f64> {
    // Of a pole: its frequency, its distance from the edge, its speed.
    let seen = |pole: &Complex<f64>| {
        if sampled {
            let log = pole.ln();
            (log.im.abs(), log.re.abs().min(PI), log.norm().min(PI))
        } else {
            (pole.im.abs(), pole.re.abs(), pole.norm())
        }
    };
    let seen: Vec<_> = poles.iter().map(seen).collect();
    let speeds = seen.iter().map(|(_, _, speed)| *speed);
    let speeds = || speeds.clone().filter(|speed| *speed > 1e-9);
    let slowest = speeds().fold(if sampled { 1.0 } else { f64::MAX }, f64::min);
    let highest = if sampled {
        PI
    } else {
        1e4 * speeds().fold(f64::MIN_POSITIVE, f64::max)
    };
    let lowest = 1e-3 * slowest.min(highest);
    let ratio = (highest / lowest).ln();
    let even = (0..=COUNT).map(|k| lowest * (ratio * k as f64 / COUNT as f64).exp());
    // Logarithmic places are far apart near the highest frequency of sampled loops.
    let linear = (0..=COUNT / 4).map(|k| highest * k as f64 / (COUNT / 4) as f64);
    let near = seen.iter().flat_map(|(frequency, distance, _)| {
        let distance = distance.max(1e-9 * highest.min(1.0));
        NEAR.iter().map(move |places| frequency + places * distance)
    });
    let mut all: Vec<f64> = even.chain(linear).chain(near).collect();
    all.retain(|frequency| (0.0..=highest).contains(frequency));
    all.extend([0.0, highest]);
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// The largest singular value.
pub(super) fn largest_singular_value(of: &Matrix) -> f64 {
    match of.len() {
        1 => of[0].norm(),
        _ => of.singular_values().max(),
    }
}
