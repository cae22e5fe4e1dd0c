//! The structured singular value for channels that change each in its own way, and the disk margin.

use super::response::{Matrix, largest_singular_value};
use crate::synth::descent::{self, Slope};
use nalgebra::{Complex, DVector};

/// Squarings that make powers of the squared singular values, whose sums lead to the largest one
/// alone.
const SQUARINGS: [i32; 3] = [3, 6, 9];

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
        _ => of_more(&balanced(m.clone())),
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
                let factor = Complex::from((column / row).powf(0.25));
                m.row_mut(channel).iter_mut().for_each(|z| *z *= factor);
                m.column_mut(channel).iter_mut().for_each(|z| *z /= factor);
            }
        }
    }
    m
}

/// Sums of powers of the singular values are smooth and convex in the logarithms of D: lowered for
/// ever higher powers.
fn of_more(m: &Matrix) -> f64 {
    let mut least = largest_singular_value(m);
    let mut logs = DVector::zeros(m.nrows());
    for squarings in SQUARINGS {
        let sum = |logs: &DVector<f64>| sum_of_powers(&scaled(m, logs), squarings);
        let Some(lower) = descent::least(logs.clone(), sum) else {
            break;
        };
        logs = lower;
        least = least.min(largest_singular_value(&scaled(m, &logs)));
    }
    least
}

/// Each row times e to its logarithm, each column divided by as much.
fn scaled(m: &Matrix, logs: &DVector<f64>) -> Matrix {
    Matrix::from_fn(m.nrows(), m.ncols(), |i, j| {
        m[(i, j)] * (logs[i] - logs[j]).exp()
    })
}

/// The sum of the singular values to the power of 2 (2^`squarings` + 1), to the root of that, and
/// how it rises with the logarithms of the channels' factors, all as logarithms: a singular value
/// rises by |u|^2 - |v|^2 of a channel. By powers of M* M, which no iteration has to find.
fn sum_of_powers(m: &Matrix, squarings: i32) -> Option<Slope> {
    let square = m.adjoint() * m;
    // M* M to the power 2^k is e^scale times this.
    let (mut power, mut scale) = (square.clone(), 0.0);
    for _ in 0..squarings {
        let size = power.norm();
        scale = 2.0 * (scale + size.ln());
        power.apply(|value| *value /= size);
        power = &power * &power;
    }
    let inner = (&power * &square).diagonal();
    let outer = (m * &power).component_mul(&m.conjugate()).column_sum();
    let sum = inner.sum().re;
    let value = (scale + sum.ln()) / (2.0 * (2f64.powi(squarings) + 1.0));
    value
        .is_finite()
        .then(|| (value, (outer - inner).map(|rise| rise.re / sum)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::eigen::largest;
    use rand::{Rng as _, SeedableRng as _};
    use rand_chacha::ChaCha8Rng;

    /// Entries of very different size.
    fn uneven(channels: usize, random: &mut ChaCha8Rng) -> Matrix {
        let mut part = || random.random_range(-1.0..1.0f64).powi(5);
        Matrix::from_fn(channels, channels, |_, _| Complex::new(part(), part()))
    }

    /// The least that steps of one channel at a time find, ever smaller.
    fn by_trial(m: &Matrix) -> f64 {
        let mut logs = DVector::zeros(m.nrows());
        let mut least = largest_singular_value(m);
        let mut step = 1.0;
        while step > 1e-4 {
            let before = least;
            for channel in 0..m.nrows() {
                for way in [-step, step] {
                    let mut next = logs.clone();
                    next[channel] += way;
                    let value = largest_singular_value(&scaled(m, &next));
                    if value < least {
                        (least, logs) = (value, next);
                    }
                }
            }
            if least == before {
                step /= 2.0;
            }
        }
        least
    }

    /// mu is at least every |eigenvalue| of Q M with Q a phase per channel, at most the largest
    /// singular value of every D M D^-1.
    #[test]
    fn it_lies_between_what_phases_and_scalings_reach() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut gained = 1.0_f64;
        for channels in [3, 4, 6, 9] {
            for _ in 0..4 {
                let m = uneven(channels, &mut random);
                let mu = structured_singular_value(&m);
                let tried = by_trial(&m);
                assert!(mu < 1.002 * tried, "{channels}: {mu}, {tried} by trial");
                for _ in 0..50 {
                    let phase = DVector::from_fn(channels, |_, _| {
                        Complex::from_polar(1.0, random.random_range(-3.2..3.2))
                    });
                    let turned = Matrix::from_diagonal(&phase) * &m;
                    let eigenvalues = turned.eigenvalues().unwrap();
                    let reached = largest(eigenvalues.as_slice());
                    assert!(
                        mu > 0.999_999 * reached,
                        "{channels}: {mu}, {reached} by phases"
                    );
                }
                gained = gained.min(mu / upper_bound(&m));
            }
        }
        assert!(gained < 0.96, "balancing alone does as well: {gained}");
    }

    #[test]
    fn a_scaling_of_the_channels_changes_nothing() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        for channels in [2, 3, 5, 18] {
            let m = uneven(channels, &mut random);
            let logs = DVector::from_fn(channels, |_, _| random.random_range(-2.0..2.0));
            let mu = [m.clone(), scaled(&m, &logs)].map(|m| structured_singular_value(&m));
            assert!((mu[0] / mu[1] - 1.0).abs() < 2e-3, "{channels}: {mu:?}");
        }
    }
}
