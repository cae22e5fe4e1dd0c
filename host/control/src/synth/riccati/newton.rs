//! Newton's iteration on a Riccati equation (Kleinman, IEEE Trans. Automatic Control 13 (1968) 114;
//! Hewer, ibid. 16 (1971) 382), with residuals in twice the digits.

use super::problem::{Problem, Solution, TimeDomain, rms};
use super::stein::{lyapunov, stein};
use super::twofold::{SplitMatrix, Twofold};
use nalgebra::DMatrix;

/// Far starts halve their distance at each step before the iteration turns quadratic.
const MOST_STEPS: usize = 60;
/// K that moved by this share has errors of about its square left; at 1e-6, K of one problem in a
/// thousand was 2e-12 off.
const SETTLED: f64 = 1e-7;
/// Rounding alone moves K by this share.
const NOTHING: f64 = 1e-13;
/// Corrections need few digits: what they miss, the next one finds.
const CORRECTION: f64 = 1e-4;

/// Refines `x`; `None` if its gain does not stabilise or nothing settles.
pub(super) fn refine(problem: &Problem<'_>, x: DMatrix<f64>) -> Option<Solution> {
    let equation = Equation::new(problem);
    let mut x = Twofold::exact(x);
    let mut before: Option<DMatrix<f64>> = None;
    let mut moved_before = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let (k, left) = equation.gain_and_residual(&x)?;
        let moved = before.map_or(f64::INFINITY, |before| {
            (&k - before).amax() / k.amax().max(f64::MIN_POSITIVE)
        });
        // Towards a pole on the edge of stability the steps only halve: that is no settling.
        let settled = moved <= SETTLED && moved <= 0.1 * moved_before || moved <= NOTHING;
        moved_before = moved;
        let closed = problem.a - problem.b * &k;
        if settled {
            return Some(Solution {
                residual: left.amax() / x.hi.amax().max(f64::MIN_POSITIVE),
                x: x.rounded(),
                k,
            });
        }
        let correction = match problem.time {
            TimeDomain::Discrete => stein(closed, left, CORRECTION)?,
            TimeDomain::Continuous => {
                let shift = rms(&closed).max(f64::MIN_POSITIVE);
                lyapunov(&closed, &left, shift, CORRECTION)?
            }
        };
        x = x.plus_exact(&correction);
        before = Some(k);
    }
    None
}

/// What stays the same from step to step.
struct Equation<'a> {
    problem: &'a Problem<'a>,
    /// Transposes, split.
    a: SplitMatrix,
    b: SplitMatrix,
}

impl Equation<'_> {
    fn new<'a>(problem: &'a Problem<'a>) -> Equation<'a> {
        Equation {
            problem,
            a: SplitMatrix::new(problem.a.transpose()),
            b: SplitMatrix::new(problem.b.transpose()),
        }
    }

    /// The gain that goes with X, and what X leaves in the equation.
    fn gain_and_residual(&self, x: &Twofold) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
        let Problem { time, q, r, .. } = *self.problem;
        let ax = self.a.times(x);
        let bx = self.b.times(x);
        // The gain solves weight * K = moment.
        let (weight, moment) = match time {
            TimeDomain::Continuous => (Twofold::exact(r.clone()), bx),
            TimeDomain::Discrete => {
                let xb = bx.transpose();
                let weight = self.b.times(&xb).plus_exact(r);
                (weight, self.a.times(&xb).transpose())
            }
        };
        let (k, off) = solve(&weight, &moment)?;
        // With moment = weight * K + off: K' moment + off' K, where a small off may be rounded.
        let spent = SplitMatrix::new(k.transpose()).times_symmetric(&moment);
        let left = match time {
            TimeDomain::Continuous => ax.transpose().plus(1.0, &ax),
            TimeDomain::Discrete => self.a.times_symmetric(&ax.transpose()).plus(-1.0, x),
        };
        let left = left.plus_exact(q).plus(-1.0, &spent).rounded() - off.transpose() * &k;
        left.iter().all(|value| value.is_finite()).then(|| {
            let mut left = left;
            // The lower triangle is the one that was computed.
            left.fill_upper_triangle_with_lower_triangle();
            (k, left)
        })
    }
}

/// K of weight * K = moment, to full precision by iterative refinement, and moment - weight * K.
fn solve(weight: &Twofold, moment: &Twofold) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
    let mut rounded = weight.rounded();
    super::symmetrise(&mut rounded);
    let factor = rounded.cholesky()?;
    let hi = SplitMatrix::new(weight.hi.clone());
    let off = |k: &DMatrix<f64>| {
        let product = hi.times(&Twofold::exact(k.clone()));
        moment.clone().plus(-1.0, &product).rounded() - &weight.lo * k
    };
    let mut k = factor.solve(&moment.hi);
    for _ in 0..2 {
        k += factor.solve(&off(&k));
    }
    let left = off(&k);
    Some((k, left))
}
