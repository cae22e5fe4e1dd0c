//! Riccati equations by structure-preserving doubling: fast, and as accurate as their conditioning
//! allows.
//!
//! Chu, Fan, Lin, Wang, International Journal of Control 77 (2004) 767 (discrete); Chu, Fan, Lin,
//! Linear Algebra and its Applications 396 (2005) 55 (continuous, by Cayley's transform).

use super::dense::{product, solve_both};
use nalgebra::DMatrix;

/// Most doublings: each squares the slowest closed-loop pole. One within 1e-6 of the unit circle
/// takes 24; one on it, 27 and a wrong answer.
const MOST_DOUBLINGS: usize = 25;

/// Where Newton's iteration takes over.
const SETTLED: f64 = 1e-8;

/// X = A'X (I + G X)^-1 A + Q with G = B R^-1 B', stabilising; `None` where doubling finds none.
pub(super) fn doubling(
    mut a: DMatrix<f64>,
    mut g: DMatrix<f64>,
    mut h: DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    let mut before = f64::INFINITY;
    for _ in 0..MOST_DOUBLINGS {
        let mut w = product(&g, &h);
        for i in 0..n {
            w[(i, i)] += 1.0;
        }
        let (wa, wg) = solve_both(w, &a, &g)?;
        let at = a.transpose();
        let more = product(&at, &product(&h, &wa));
        g += product(&product(&a, &wg), &at);
        symmetrise(&mut g);
        a = product(&a, &wa);
        h += &more;
        symmetrise(&mut h);
        let change = more.amax() / h.amax().max(f64::MIN_POSITIVE);
        if !change.is_finite() {
            return None;
        }
        // The change after a small one is its square.
        if change < SETTLED || (change < 1e-5 && change >= before) {
            return Some(h);
        }
        before = change;
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
