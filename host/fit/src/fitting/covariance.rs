//! How well the fitted values are known.

use super::cluster::{Cluster, clusters, pull_of_rests};
use super::data::FitProblem;
use super::fit::Fit;
use super::student::quantile_975;
use nalgebra::DMatrix;

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

/// Share of a cluster's information that is taken out with it: a value that rests on one cluster
/// alone still gets an interval, some twenty times as wide as its own score says.
const TAKEN_OUT: f64 = 0.95;

/// Intervals of the fitted values, and their correlation matrix.
///
/// An encoder at rest misreads by the same amount until it moves on, so neighbouring residuals tell
/// little more than one of them. The standard error is that of a jackknife over clusters of time,
/// which may be correlated inside as they like (CV3 in MacKinnon, Nielsen & Webb 2023; one linear
/// step for each cluster left out), or the classical one (residual variance times inverse normal
/// matrix) where that is larger, to which rests add what their one misreading moves the values by:
/// the fit takes it up, and no residual shows it. A value may rest on few clusters: the interval is
/// Student's with as many degrees of freedom as clusters really carry it (Bell & McCaffrey 2002).
/// Start states count as unknowns. `None` where the data do not determine the values at all.
pub fn intervals(fit: &Fit, data: &FitProblem) -> Option<(Vec<Interval>, DMatrix<f64>)> {
    let free: Vec<usize> = (0..fit.free.len()).collect();
    intervals_of(&free, fit, data)
}

/// The same of these of the fit's values, by their place, where the others are what they are.
pub fn intervals_of(
    places: &[usize],
    fit: &Fit,
    data: &FitProblem,
) -> Option<(Vec<Interval>, DMatrix<f64>)> {
    let count = places.len();
    let clusters = clusters(fit, data).into_iter();
    let clusters: Vec<Cluster> = clusters.map(|cluster| cluster.of(places)).collect();
    let known = DMatrix::from_diagonal(&fit.value_prior().precision.select_rows(places));
    let normal: DMatrix<f64> =
        (clusters.iter()).fold(known, |sum, cluster| sum + &cluster.information);
    let inverse = inverse(&normal)?;
    let residual = residual_variance(fit);
    let jackknife = jackknife(&clusters, &normal);
    let pull = { pull_of_rests(fit, data).select_rows(places) }.select_columns(places);
    let of_rests = &inverse * pull * &inverse;
    let values = fit.values();
    let intervals = (0..count)
        .map(|i| {
            let classical = residual * inverse[(i, i)];
            let variance = jackknife[i].max(classical + of_rests[(i, i)]).max(0.0);
            let freedom = freedom(&clusters, &inverse, i);
            let reach = quantile_975(freedom) * variance.sqrt();
            let (low, high) = fit.free[places[i]].bounds(&fit.model);
            let value = values[places[i]];
            Interval {
                standard_error: variance.sqrt(),
                low: (value - reach).max(low),
                high: (value + reach).min(high),
            }
        })
        .collect();
    let correlation = DMatrix::from_fn(count, count, |r, c| {
        inverse[(r, c)] / (inverse[(r, r)] * inverse[(c, c)]).sqrt()
    });
    Some((intervals, correlation))
}

/// Squared weighted residual for each sample beyond those that the unknowns take up.
fn residual_variance(fit: &Fit) -> f64 {
    let columns = fit
        .jacobian
        .iter()
        .flat_map(|w| w.window_start.column_iter());
    let start_states = columns.filter(|column| column.amax() > 0.0).count();
    let motions = fit.jacobian.chunk_by(|a, b| a.motion == b.motion);
    let of_motions: usize = motions.map(|w| w[0].motion_start.places.len()).sum();
    let unknowns = fit.free.len() + start_states + of_motions;
    let freedom = fit.residuals.count().saturating_sub(unknowns).max(1);
    fit.residuals.cost() / freedom as f64
}

/// Inverse of a normal matrix, scaled to a unit diagonal on the way; none where a value changes
/// nothing.
pub(super) fn inverse(normal: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let count = normal.nrows();
    let scale: Vec<f64> = (0..count).map(|i| normal[(i, i)].sqrt()).collect();
    if scale.iter().any(|s| *s <= 0.0 || !s.is_finite()) {
        return None;
    }
    let scaled = DMatrix::from_fn(count, count, |r, c| normal[(r, c)] / (scale[r] * scale[c]));
    let inverse = scaled.try_inverse()?;
    Some(DMatrix::from_fn(count, count, |r, c| {
        inverse[(r, c)] / (scale[r] * scale[c])
    }))
}

/// Variance of each value by how far it moves when one cluster after another is left out.
fn jackknife(clusters: &[Cluster], normal: &DMatrix<f64>) -> Vec<f64> {
    let mut sum = vec![0.0; normal.nrows()];
    for cluster in clusters {
        if let Some(inverse) = inverse(&(normal - &cluster.information * TAKEN_OUT)) {
            let moved = inverse * &cluster.score;
            for (sum, moved) in sum.iter_mut().zip(moved.iter()) {
                *sum += moved * moved;
            }
        }
    }
    let count = clusters.len() as f64;
    sum.iter().map(|sum| sum * (count - 1.0) / count).collect()
}

/// Degrees of freedom of value `i`'s variance: the number of clusters, fewer where some tell more
/// of it than others (Satterthwaite's, for errors of equal variance).
fn freedom(clusters: &[Cluster], inverse: &DMatrix<f64>, i: usize) -> f64 {
    let row = inverse.row(i);
    let (mut sum, mut squares) = (0.0, 1e-300);
    for cluster in clusters {
        let part = (row * &cluster.information * row.transpose())[(0, 0)];
        sum += part;
        squares += part * part;
    }
    (sum * sum / squares).max(1.0)
}
