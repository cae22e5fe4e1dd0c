//! E = M'E M + F by doubling (Smith, SIAM Journal on Applied Mathematics 16 (1968) 198), and
//! Lyapunov's equation.

use super::dense::{product, transposed_product};
use super::doubling::symmetrise;
use nalgebra::DMatrix;

/// Each doubling squares M: after 60, a pole within 1e-16 of the circle has been seen to decay or
/// not.
const MOST_DOUBLINGS: usize = 60;

/// E, the sum of M'^k F M^k over all k, to about `accuracy`; `None` if M does not decay.
pub(in crate::synth) fn stein(
    mut m: DMatrix<f64>,
    f: DMatrix<f64>,
    accuracy: f64,
) -> Option<DMatrix<f64>> {
    let mut e = f;
    for _ in 0..MOST_DOUBLINGS {
        let more = transposed_product(&m, &product(&e, &m));
        e += &more;
        let change = more.amax();
        if !change.is_finite() {
            return None;
        }
        // Where there is little to add up, M itself must be seen to decay.
        if change <= accuracy * e.amax() && m.norm() < 0.9 {
            symmetrise(&mut e);
            return Some(e);
        }
        m = product(&m, &m);
        if !m.amax().is_finite() {
            return None;
        }
    }
    None
}

/// A'E + E A + F = 0, by Cayley's transform with `shift` > 0; `None` if A does not decay.
pub(super) fn lyapunov(
    a: &DMatrix<f64>,
    f: &DMatrix<f64>,
    shift: f64,
    accuracy: f64,
) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    let inverse = (DMatrix::identity(n, n) * shift - a).try_inverse()?;
    let m = &inverse * (2.0 * shift) - DMatrix::identity(n, n);
    let right = inverse.transpose() * (f * &inverse) * (2.0 * shift);
    stein(m, right, accuracy)
}
