//! Least squares on a stream: sums only.

use nalgebra::{DMatrix, DVector};

/// Sums for the regression of one quantity on several.
pub(super) struct Regression {
    xx: DMatrix<f64>,
    xy: DVector<f64>,
    yy: f64,
    count: usize,
}

/// A coefficient and how many standard errors it lies from zero.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coefficient {
    /// Estimate.
    pub value: f64,
    /// Estimate over its standard error.
    pub t: f64,
}

impl Regression {
    pub fn new(regressors: usize) -> Self {
        Regression {
            xx: DMatrix::zeros(regressors, regressors),
            xy: DVector::zeros(regressors),
            yy: 0.0,
            count: 0,
        }
    }

    pub fn add(&mut self, x: &[f64], y: f64) {
        let x = DVector::from_column_slice(x);
        self.xx.ger(1.0, &x, &x, 1.0);
        self.xy.axpy(y, &x, 1.0);
        self.yy += y * y;
        self.count += 1;
    }

    /// All coefficients; none while there are too few samples. A regressor that never differs from
    /// zero, or that others explain, gets `t = 0`.
    pub fn solve(&self) -> Option<Vec<Coefficient>> {
        let n = self.xy.len();
        if self.count < 3 * n + 10 {
            return None;
        }
        let scale = DVector::from_fn(n, |i, _| match self.xx[(i, i)] {
            sum if sum > 0.0 => sum.sqrt().recip(),
            _ => 0.0,
        });
        let mut scaled = DMatrix::from_fn(n, n, |i, j| self.xx[(i, j)] * scale[i] * scale[j]);
        // A whiff of ridge keeps dependent regressors apart; it shrinks only those.
        for i in 0..n {
            scaled[(i, i)] += 1e-6;
        }
        let inverse = scaled.cholesky()?.inverse();
        let solution = &inverse * self.xy.component_mul(&scale);
        let explained = solution.dot(&self.xy.component_mul(&scale));
        let variance = (self.yy - explained).max(1e-12 * self.yy) / (self.count - n) as f64;
        let coefficient = |i: usize| {
            let error = (variance * inverse[(i, i)]).sqrt();
            // Beyond a variance inflation of 1e4 the estimate is the ridge's.
            let known = inverse[(i, i)] < 1e4 && error > 0.0;
            Coefficient {
                value: solution[i] * scale[i],
                t: if known { solution[i] / error } else { 0.0 },
            }
        };
        Some((0..n).map(coefficient).collect())
    }
}

/// Sums for a straight line y = offset + slope x.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LineFit {
    count: f64,
    x: f64,
    y: f64,
    dxx: f64,
    dxy: f64,
    dyy: f64,
}

impl LineFit {
    pub fn add(&mut self, x: f64, y: f64) {
        self.count += 1.0;
        let (dx, dy) = (x - self.x, y - self.y);
        self.x += dx / self.count;
        self.y += dy / self.count;
        self.dxx += dx * (x - self.x);
        self.dxy += dx * (y - self.y);
        self.dyy += dy * (y - self.y);
    }

    pub fn count(&self) -> usize {
        self.count as usize
    }

    /// Standard deviation of x.
    pub fn spread(&self) -> f64 {
        (self.dxx / self.count.max(1.0)).sqrt()
    }

    /// From -1 to 1; 0 where either is constant.
    pub fn correlation(&self) -> f64 {
        let product = (self.dxx * self.dyy).sqrt();
        if product > 0.0 {
            self.dxy / product
        } else {
            0.0
        }
    }

    pub fn slope(&self) -> f64 {
        self.dxy / self.dxx
    }

    /// Mean of y - x.
    pub fn offset(&self) -> f64 {
        self.y - self.x
    }
}
