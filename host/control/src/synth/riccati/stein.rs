//! E = M'E M + F by doubling (Smith, SIAM Journal on Applied Mathematics 16 (1968) 198), and
//! Lyapunov's equation.

use super::square::{FixedMatrix, Square, by_size};
use nalgebra::DMatrix;

/// Each doubling squares M: after 60, a pole within 1e-16 of the circle has been seen to decay or
/// not.
const MOST_DOUBLINGS: usize = 60;

/// E, the sum of M'^k F M^k over all k, to about `accuracy`; `None` if M does not decay.
pub(in crate::synth) fn stein(
    m: DMatrix<f64>,
    f: DMatrix<f64>,
    accuracy: f64,
) -> Option<DMatrix<f64>> {
    let n = m.nrows();
    by_size!(
        n,
        N => in_registers([&m, &f].map(FixedMatrix::<N>::padded), accuracy).map(|e| e.first(n)),
        summed([m, f], accuracy)
    )
}

/// Wider registers give the same bits: no product is fused with a sum.
#[multiversion::multiversion(targets("x86_64+avx2"))]
fn in_registers<const N: usize>(
    matrices: [FixedMatrix<N>; 2],
    accuracy: f64,
) -> Option<FixedMatrix<N>> {
    summed(matrices, accuracy)
}

#[inline(always)]
fn summed<M: Square>([mut m, mut e]: [M; 2], accuracy: f64) -> Option<M> {
    for _ in 0..MOST_DOUBLINGS {
        let more = m.transposed().times(&e.times(&m));
        e.add(&more);
        let change = more.largest();
        if !change.is_finite() {
            return None;
        }
        // Where there is little to add up, M itself must be seen to decay.
        if change <= accuracy * e.largest() && m.length() < 0.9 {
            e.symmetrise();
            return Some(e);
        }
        m = m.times(&m);
        if !m.largest().is_finite() {
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
