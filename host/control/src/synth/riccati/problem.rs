//! A Riccati equation and its stabilising solution.

use super::{doubling, newton};
use nalgebra::DMatrix;

/// Factors of R that are tried where the inputs are too cheap.
const DEARER: [f64; 4] = [1e2, 1e4, 1e6, 1e8];

/// In which time the plant runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::synth) enum TimeDomain {
    /// A'X + XA - XB R^-1 B'X + Q = 0.
    Continuous,
    /// X = A'XA - A'XB (R + B'XB)^-1 B'XA + Q.
    Discrete,
}

/// The data of a Riccati equation: A n x n, B n x m, Q and R symmetric, R positive definite.
#[derive(Debug, Clone, Copy)]
pub(in crate::synth) struct Problem<'a> {
    pub time: TimeDomain,
    pub a: &'a DMatrix<f64>,
    pub b: &'a DMatrix<f64>,
    pub q: &'a DMatrix<f64>,
    pub r: &'a DMatrix<f64>,
}

/// The stabilising solution.
#[derive(Debug, Clone)]
pub(in crate::synth) struct Solution {
    /// X.
    pub x: DMatrix<f64>,
    /// K = R^-1 B'X, or (R + B'XB)^-1 B'XA.
    pub k: DMatrix<f64>,
    /// Largest entry of what X leaves in the equation, over the largest entry of X.
    pub residual: f64,
}

impl Problem<'_> {
    /// The stabilising solution, or `None` if none was found.
    pub fn solve(&self) -> Option<Solution> {
        if let Some(solution) = self.solve_directly() {
            return Some(solution);
        }
        // Modes that Q does not see are left as they are by doubling, even if they grow. Newton's
        // iteration needs only a gain that stabilises, such as one for a cost that sees everything.
        let n = self.a.nrows();
        let size = self.q.amax().max(1e-3 * self.r.amax());
        let seen = self.q + DMatrix::identity(n, n) * size;
        let seen = self.doubled(&seen).and_then(|x| newton::refine(self, x));
        seen.or_else(|| self.solve_by_dearer_inputs())
    }

    /// Cheap inputs leave doubling too few digits; gains of dearer ones stabilise as well, which is
    /// all that Newton's iteration needs.
    fn solve_by_dearer_inputs(&self) -> Option<Solution> {
        DEARER.iter().find_map(|factor| {
            let r = self.r * *factor;
            let dearer = Problem { r: &r, ..*self };
            newton::refine(self, dearer.solve_directly()?.x)
        })
    }

    fn solve_directly(&self) -> Option<Solution> {
        newton::refine(self, self.doubled(self.q)?)
    }

    fn doubled(&self, q: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let mut g = self.b * self.r.clone().cholesky()?.solve(&self.b.transpose());
        doubling::symmetrise(&mut g);
        match self.time {
            TimeDomain::Discrete => doubling::doubling(self.a.clone(), g, q.clone()),
            TimeDomain::Continuous => {
                let size = rms(self.a).max(rms(&g).sqrt() * rms(q).sqrt());
                let shifts = [1.0, 3.3, 0.31, 11.0].map(|factor| factor * size);
                let shifts = shifts.into_iter().filter(|shift| *shift > 0.0);
                shifts
                    .filter_map(|shift| doubling::cayley(self.a, &g, q, shift))
                    .next()
            }
        }
    }
}

/// Root mean square of a matrix's singular values.
pub(super) fn rms(m: &DMatrix<f64>) -> f64 {
    m.norm() / (m.nrows() as f64).sqrt()
}
