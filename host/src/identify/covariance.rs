//! How well the fitted values are known.

use super::data::Data;
use super::fit::Fit;
use nalgebra::{DMatrix, DVector};

/// A fitted value's 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Standard error.
    pub standard_error: f64,
    /// Lower end, inside the bounds.
    pub low: f64,
    /// Upper end, inside the bounds.
    pub high: f64,
}

/// Length of the blocks within which residuals may be correlated, s.
const BLOCK_S: f64 = 0.5;

/// Intervals of the fitted values, and their correlation matrix.
///
/// The covariance is the larger, value by value, of the classical one (residual variance times inverse normal
/// matrix) and one robust to residuals that are correlated within blocks of half a second (Liang & Zeger 1986),
/// which a model with something missing leaves. Start states count as unknowns. `None` where the data do not
/// determine the values at all.
pub fn intervals(fit: &Fit, data: &Data) -> Option<(Vec<Interval>, DMatrix<f64>)> {
    let count = fit.free.len();
    let projected: Vec<DMatrix<f64>> = fit.jacobian.iter().map(project).collect();
    let mut normal = DMatrix::zeros(count, count);
    for jacobian in &projected {
        normal += jacobian.tr_mul(jacobian);
    }
    let scale: Vec<f64> = (0..count).map(|i| normal[(i, i)].sqrt()).collect();
    if scale.iter().any(|s| *s <= 0.0 || !s.is_finite()) {
        return None;
    }
    let scaled = DMatrix::from_fn(count, count, |r, c| normal[(r, c)] / (scale[r] * scale[c]));
    let inverse = scaled.try_inverse()?;
    let inverse = DMatrix::from_fn(count, count, |r, c| inverse[(r, c)] / (scale[r] * scale[c]));

    let unknowns = count
        + fit
            .nodes
            .iter()
            .map(super::node::Node::unknowns)
            .sum::<usize>();
    let freedom = fit.residuals.count().saturating_sub(unknowns).max(1) as f64;
    let variance = fit.residuals.cost() / freedom;
    let robust = &inverse * block_scores(fit, data, &projected) * &inverse;

    let values = fit.values();
    let intervals = (0..count)
        .map(|i| {
            let standard_error = (variance * inverse[(i, i)])
                .max(robust[(i, i)])
                .max(0.0)
                .sqrt();
            let (low, high) = fit.free[i].bounds(&fit.model);
            Interval {
                standard_error,
                low: (values[i] - 1.96 * standard_error).max(low),
                high: (values[i] + 1.96 * standard_error).min(high),
            }
        })
        .collect();
    let correlation = DMatrix::from_fn(count, count, |r, c| {
        inverse[(r, c)] / (inverse[(r, r)] * inverse[(c, c)]).sqrt()
    });
    Some((intervals, correlation))
}

/// Parameter columns with what the window's own start state could explain taken out.
pub(super) fn project(window: &super::normal::WindowJacobian) -> DMatrix<f64> {
    let own = window.node.tr_mul(&window.node) + DMatrix::from_diagonal(&window.node_precision);
    match own.cholesky() {
        Some(cholesky) => {
            let coupling = cholesky.solve(&window.node.tr_mul(&window.parameters));
            &window.parameters - &window.node * coupling
        }
        None => window.parameters.clone(),
    }
}

/// Sum over blocks of time of the outer product of their scores, corrected for the number of blocks.
fn block_scores(fit: &Fit, data: &Data, projected: &[DMatrix<f64>]) -> DMatrix<f64> {
    let count = fit.free.len();
    let joints = data.sigma_rad.len();
    let mut sum = DMatrix::zeros(count, count);
    let mut blocks = 0usize;
    for (w, window) in data.windows.iter().enumerate() {
        let time = &data.motions[window.motion].time_s[window.samples.clone()];
        let samples = time.len();
        let mut begin = 0;
        while begin < samples {
            let mut end = begin + 1;
            while end < samples && time[end] - time[begin] < BLOCK_S {
                end += 1;
            }
            let mut score = DVector::zeros(count);
            for joint in 0..joints {
                for k in begin..end {
                    let row = joint * samples + k;
                    score += projected[w].row(row).transpose() * fit.residuals.windows[w][row];
                }
            }
            sum += &score * score.transpose();
            blocks += 1;
            begin = end;
        }
    }
    let blocks = blocks as f64;
    sum * (blocks / (blocks - count as f64).max(1.0))
}
