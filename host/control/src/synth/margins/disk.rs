//! The structured singular value for channels that change each in its own way, and the disk margin.

use super::response::{Matrix, largest_singular_value};
use nalgebra::Complex;

/// Powers of the squared singular values whose sums lead to the largest one alone.
const POWERS: [f64; 3] = [8.0, 64.0, 512.0];

/// Turns of the search over all channels for each power.
const TURNS: usize = 2;

/// Halvings of a channel's interval in the search.
const HALVINGS: usize = 14;

/// Turns of the balancing.
const BALANCING_TURNS: usize = 10;

/// A disk margin, balanced between S and T.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiskMargin {
    /// Every channel may be multiplied by any (1 + d) / (1 - d), |d| < `alpha` / 2, in its own way.
    pub alpha: f64,
    /// Where it is least, rad/s.
    pub frequency_rad_s: f64,
}

impl DiskMargin {
    /// Factors of the gains within it: 1 / g to g.
    pub fn gain(&self) -> f64 {
        if self.alpha < 2.0 {
            (2.0 + self.alpha) / (2.0 - self.alpha)
        } else {
            f64::INFINITY
        }
    }

    /// The same in dB.
    pub fn gain_db(&self) -> f64 {
        20.0 * self.gain().log10()
    }

    /// Phases within it, rad, either way.
    pub fn phase_rad(&self) -> f64 {
        2.0 * (self.alpha / 2.0).atan()
    }
}

/// An upper bound of [`structured_singular_value`] that takes little time: of D that balances rows
/// and columns (Osborne 1960).
pub(super) fn upper_bound(m: &Matrix) -> f64 {
    match m.nrows() {
        1 | 2 => structured_singular_value(m),
        _ => largest_singular_value(&balanced(m.clone())),
    }
}

/// Least of the largest singular value of D M D^-1 over diagonal D: mu of one complex factor per
/// channel, exactly for up to three channels, from above for more.
pub(super) fn structured_singular_value(m: &Matrix) -> f64 {
    match m.nrows() {
        1 => m[0].norm(),
        2 => of_two(m),
        _ => of_more(balanced(m.clone())),
    }
}

/// Of two channels: the determinant does not depend on D, so the largest singular value is least
/// where the Frobenius norm is.
fn of_two(m: &Matrix) -> f64 {
    let [a, b, c, d] = [m[(0, 0)], m[(0, 1)], m[(1, 0)], m[(1, 1)]];
    let squares = a.norm_sqr() + d.norm_sqr() + 2.0 * b.norm() * c.norm();
    let determinant = (a * d - b * c).norm_sqr();
    let root = (squares * squares - 4.0 * determinant).max(0.0).sqrt();
    f64::midpoint(squares, root).sqrt()
}

/// Each row as large as its column, which makes the Frobenius norm least.
fn balanced(mut m: Matrix) -> Matrix {
    for _ in 0..BALANCING_TURNS {
        for channel in 0..m.nrows() {
            let own = m[(channel, channel)].norm_sqr();
            let row = m.row(channel).norm_squared() - own;
            let column = m.column(channel).norm_squared() - own;
            // A channel that no other meets, or that meets none, needs no balance.
            if row > 0.0 && column > 0.0 {
                m = scaled(&m, channel, (column / row).ln() / 4.0);
            }
        }
    }
    m
}

/// Sums of powers of the singular values are smooth and convex in the logarithms of D: lowered one
/// channel after the other, for ever higher powers.
fn of_more(mut m: Matrix) -> f64 {
    let mut least = largest_singular_value(&m);
    for power in POWERS {
        for _ in 0..TURNS {
            for channel in 1..m.nrows() {
                let log = lowest(2.0 / power.sqrt(), &|log| {
                    slope(scaled(&m, channel, log), channel, power)
                });
                m = scaled(&m, channel, log);
            }
        }
        least = least.min(largest_singular_value(&m));
    }
    least
}

/// Row `channel` times e^`log`, its column divided by as much.
fn scaled(m: &Matrix, channel: usize, log: f64) -> Matrix {
    let factor = Complex::from(log.exp());
    let mut m = m.clone();
    m.row_mut(channel).iter_mut().for_each(|z| *z *= factor);
    m.column_mut(channel).iter_mut().for_each(|z| *z /= factor);
    m
}

/// How the sum of powers rises with the logarithm of a channel's factor, in parts of itself: a
/// singular value rises by |u|^2 - |v|^2 of that channel.
fn slope(m: Matrix, channel: usize, power: f64) -> f64 {
    let svd = m.svd(true, true);
    let (Some(u), Some(v)) = (&svd.u, &svd.v_t) else {
        return 0.0;
    };
    let values = &svd.singular_values;
    let largest = values.max().max(f64::MIN_POSITIVE);
    let rise = |k: usize| {
        let share = (values[k] / largest).powf(2.0 * power);
        share * (u[(channel, k)].norm_sqr() - v[(k, channel)].norm_sqr())
    };
    (0..values.len()).map(rise).sum()
}

/// Where a rising slope meets 0, from 0 in steps of about `step`.
fn lowest(step: f64, slope: &dyn Fn(f64) -> f64) -> f64 {
    let down = slope(0.0) > 0.0;
    let mut reach = if down { -step } else { step };
    let mut near = 0.0;
    // Outwards until the slope turns.
    while (slope(reach) > 0.0) == down && reach.abs() < 40.0 {
        near = reach;
        reach *= 2.0;
    }
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(near, reach);
        if (slope(middle) > 0.0) == down {
            near = middle;
        } else {
            reach = middle;
        }
    }
    f64::midpoint(near, reach)
}
