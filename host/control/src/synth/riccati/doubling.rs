//! Riccati equations by structure-preserving doubling: fast, and as accurate as their conditioning
//! allows.
//!
//! Chu, Fan, Lin, Wang, International Journal of Control 77 (2004) 767 (discrete); Chu, Fan, Lin,
//! Linear Algebra and its Applications 396 (2005) 55 (continuous, by Cayley's transform).

use super::square::{FixedMatrix, Square, by_size};
use nalgebra::DMatrix;

/// Most doublings: each squares the slowest closed-loop pole. One within 1e-6 of the unit circle
/// takes 24; one on it, 27 and a wrong answer.
const MOST_DOUBLINGS: usize = 25;

/// Where Newton's iteration takes over: the next change would be about the square of this one.
const SETTLED: f64 = 1e-6;

/// X = A'X (I + G X)^-1 A + Q with G = B R^-1 B', stabilising; `None` where doubling finds none.
pub(super) fn doubling(a: DMatrix<f64>, g: DMatrix<f64>, h: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    by_size!(
        n,
        N => in_registers([&a, &g, &h].map(FixedMatrix::<N>::padded)).map(|x| x.first(n)),
        doubled([a, g, h])
    )
}

/// Wider registers give the same bits: no product is fused with a sum.
#[multiversion::multiversion(targets("x86_64+avx2"))]
fn in_registers<const N: usize>(matrices: [FixedMatrix<N>; 3]) -> Option<FixedMatrix<N>> {
    doubled(matrices)
}

#[inline(always)]
fn doubled<M: Square>([mut a, mut g, mut h]: [M; 3]) -> Option<M> {
    let mut before = f64::INFINITY;
    for _ in 0..MOST_DOUBLINGS {
        let mut w = g.times(&h);
        w.add_identity();
        let (wa, wg) = w.solve_both(&a, &g)?;
        let at = a.transposed();
        let more = at.times(&h.times(&wa));
        h.add(&more);
        h.symmetrise();
        let change = more.largest() / h.largest().max(f64::MIN_POSITIVE);
        if !change.is_finite() {
            return None;
        }
        // The change after a small one is its square.
        if change < SETTLED || (change < 1e-5 && change >= before) {
            return Some(h);
        }
        before = change;
        g.add(&a.times(&wg).times(&at));
        g.symmetrise();
        a = a.times(&wa);
    }
    None
}

/// A'X + XA - X G X + Q = 0, stabilising, with Cayley's `shift` > 0.
pub(super) fn cayley(
    a: &DMatrix<f64>,
    g: &DMatrix<f64>,
    q: &DMatrix<f64>,
    shift: f64,
) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    let shifted = a - DMatrix::identity(n, n) * shift;
    let inverse = shifted.clone().try_inverse()?;
    let ig = &inverse * g;
    let w = (shifted.transpose() + q * &ig).try_inverse()?;
    let e = DMatrix::identity(n, n) + w.transpose() * (2.0 * shift);
    let mut g0 = ig * &w * (2.0 * shift);
    let mut h0 = &w * (q * &inverse) * (2.0 * shift);
    symmetrise(&mut g0);
    symmetrise(&mut h0);
    doubling(e, g0, h0)
}

/// Replaces a matrix by its symmetric part.
pub(in crate::synth) fn symmetrise(m: &mut DMatrix<f64>) {
    for j in 0..m.ncols() {
        for i in 0..j {
            let mean = 0.5 * (m[(i, j)] + m[(j, i)]);
            m[(i, j)] = mean;
            m[(j, i)] = mean;
        }
    }
}
