//! Fitted values with their intervals.

use super::covariance::{Interval, intervals};
use super::data::FitProblem;
use super::fit::Fit;
use super::profile::profile_intervals;
use crate::output::number::measured;
use nalgebra::DMatrix;
use serde::Serialize;
use std::fmt;

/// A value with its 95 % interval.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FittedValue {
    /// Address in the model: `coulomb@1.torque_nm`.
    pub path: String,
    /// Key alone: `torque_nm`.
    pub key: String,
    /// Unit for people.
    pub unit: String,
    /// Fitted value.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
    /// Whether the value lies on a bound: a warning, not a result.
    pub on_bound: bool,
}

/// "0.0821 N m (0.0794 to 0.0851)".
impl fmt::Display for FittedValue {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&measured(self.value, self.low, self.high, &self.unit))
    }
}

/// The fitted values with intervals by profile likelihood, and their correlation matrix. Where the
/// data do not determine the values there is no matrix, and the bounds stand for the intervals.
pub fn fitted_values(fit: &Fit, data: &FitProblem) -> (Vec<FittedValue>, Option<DMatrix<f64>>) {
    with_intervals(fit, data, |local| profile_intervals(fit, data, &local))
}

/// The same with the intervals that the derivatives give, without a simulation.
pub fn locally_fitted_values(
    fit: &Fit,
    data: &FitProblem,
) -> (Vec<FittedValue>, Option<DMatrix<f64>>) {
    with_intervals(fit, data, |local| local)
}

fn with_intervals(
    fit: &Fit,
    data: &FitProblem,
    widened: impl FnOnce(Vec<Interval>) -> Vec<Interval>,
) -> (Vec<FittedValue>, Option<DMatrix<f64>>) {
    let (intervals, correlation) = match intervals(fit, data) {
        Some((local, correlation)) => (widened(local), Some(correlation)),
        None => {
            let bounds = fit.free.iter().map(|path| path.bounds(&fit.model));
            let unknown = bounds.map(|(low, high)| Interval {
                standard_error: f64::INFINITY,
                low,
                high,
            });
            (unknown.collect(), None)
        }
    };
    let rows = fit.free.iter().zip(fit.values()).zip(intervals);
    let values = rows
        .zip(fit.on_bound())
        .map(|(((path, value), interval), on_bound)| FittedValue {
            path: path.to_string(),
            key: path.key().to_string(),
            unit: path.unit().to_string(),
            value,
            low: interval.low,
            high: interval.high,
            on_bound,
        });
    (values.collect(), correlation)
}
