//! Intervals where the error is no smooth function of a value.
//!
//! A dead zone swallows one command more or not, an arm breaks away at one sample or the next: the
//! squared error goes up and down in steps, and its slope at the least tells too little. So it is
//! looked up along the way: farther values that fit as well as the interval's ends should belong to
//! the interval (profile likelihood: Bates & Watts 1988, Nonlinear Regression Analysis, ch. 6).

use super::cluster::clusters;
use super::covariance::{Interval, inverse};
use super::data::FitProblem;
use super::fit::Fit;
use super::jumping_law;
use super::normal::NormalEquations;
use super::residual::residuals;
use super::window_start::WindowStart;
use crate::model::Model;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Where the squared error is looked up, in reaches of the interval.
const REACHES: [f64; 8] = [1.3, 1.7, 2.2, 2.8, 3.6, 4.6, 6.0, 8.0];

/// The intervals, each end moved out to the farthest value at which the squared error is no larger
/// than a smooth one would be at the end. The other values and the start states go along as they
/// would if all were straight, or, where a law jumps, are fitted there.
pub fn profile_intervals(fit: &Fit, data: &FitProblem, intervals: &[Interval]) -> Vec<Interval> {
    let sum = |sum: DMatrix<f64>, cluster: &super::cluster::Cluster| sum + &cluster.information;
    let known = DMatrix::from_diagonal(&fit.value_prior().precision);
    let normal = clusters(fit, data).iter().fold(known, sum);
    let Some(inverse) = inverse(&normal) else {
        return intervals.to_vec();
    };
    let steps = fit.normal_equations(0.0);
    let least = fit.residuals.cost();
    let jumps = (fit.free.iter()).any(|path| jumping_law::jumps(path, &fit.model));
    intervals
        .par_iter()
        .enumerate()
        .map(|(i, interval)| {
            let value = fit.values()[i];
            let (low, high) = fit.free[i].bounds(&fit.model);
            let straight = inverse.column(i) / inverse[(i, i)];
            let end = |reach: f64| {
                let allowed = least + reach * reach / inverse[(i, i)];
                let holding = |moved: f64| fit.holding(i, value + moved, data);
                let is_allowed = |moved: f64| {
                    cost(fit, data, &steps, &(&straight * moved)) <= allowed
                        || jumps && holding(moved).is_some_and(|f| f.residuals.cost() <= allowed)
                };
                let farthest = REACHES.iter().rev().find(|times| {
                    let moved = *times * reach;
                    (low..=high).contains(&(value + moved)) && is_allowed(moved)
                });
                value + farthest.unwrap_or(&1.0) * reach
            };
            Interval {
                standard_error: interval.standard_error,
                low: end(interval.low - value).max(low),
                high: end(interval.high - value).min(high),
            }
        })
        .collect()
}

/// Squared weighted residuals with the values moved; infinite where one leaves its bounds.
fn cost(fit: &Fit, data: &FitProblem, steps: &NormalEquations, by: &DVector<f64>) -> f64 {
    moved(fit, steps, by).map_or(f64::INFINITY, |(model, window_starts)| {
        residuals(&model, data, &window_starts).cost()
    })
}

/// The model with its values moved and the start states that go along; none where a value leaves
/// its bounds.
fn moved(
    fit: &Fit,
    steps: &NormalEquations,
    by: &DVector<f64>,
) -> Option<(Model, Vec<WindowStart>)> {
    let mut model = fit.model.clone();
    for (path, by) in fit.free.iter().zip(by.iter()) {
        let value = path.get(&fit.model)? + by;
        let (low, high) = path.bounds(&fit.model);
        let is_possible = (low..=high).contains(&value) && path.set(&mut model, value);
        is_possible.then_some(())?;
    }
    let mut window_starts = fit.window_starts.clone();
    for (window, window_start) in window_starts.iter_mut().enumerate() {
        window_start.unknowns += steps.start_step(window, by);
    }
    Some((model, window_starts))
}
