//! Fits of laws that jump: their squared error goes down in stairs, and what follows its slope
//! stops on one.
//!
//! A dead zone swallows one command more or not, and every such command is a stair. A fit is
//! resumed from the lowest of the places that lie along its values, as far as these are uncertain.

use super::candidate::Candidate;
use super::covariance::inverse;
use super::data::FitProblem;
use super::fit::{Fit, FitOptions};
use super::jacobian::difference;
use super::residual::residuals;
use super::solve::{fit, fit_start_states};
use super::window_start::WindowStart;
use crate::effects::named;
use crate::model::{Model, ParameterPath};
use rayon::prelude::*;

/// Places looked up on either side of a value.
const PLACES: i32 = 24;
/// Between two of them lies a part of the difference that its derivative is taken over, across
/// stairs, or of the standard error that this gives.
const OF_DIFFERENCE: f64 = 1.0 / 64.0;
const OF_ERROR: f64 = 0.5;
/// Where that many of them lie lowest all else is fitted.
const FITTED: usize = 4;
/// Places whose squared errors are closer than this, in variances of a residual, lie on one stair.
const ONE_STAIR: f64 = 1e-3;
/// Times that the way to the end of a stair is doubled at most, and then halved.
const DOUBLED: usize = 12;
const HALVED: usize = 6;
/// Places on one stair that other motions may tell apart.
const ON_STAIR: i32 = 32;

/// How far down the stairs a fit goes.
#[derive(Debug, Clone, Copy)]
struct Descent {
    /// Share of the squared error that a fit from a place must be lower by.
    share: f64,
    /// The same in variances of a residual: twice the logarithm of the likelihood.
    variances: f64,
    /// Most times that it goes down.
    times: usize,
}

/// Far enough to compare explanations.
const COMPARED: Descent = Descent {
    share: 0.005,
    variances: 0.0,
    times: 4,
};
/// Far enough to state values: what a stair that is left out would move them by, intervals allow.
const STATED: Descent = Descent {
    share: 0.0,
    variances: 1.0,
    times: 5,
};

/// The fit, or one that is lower down by what tells explanations apart. The fit must have its
/// derivatives.
pub fn descend_jumping_law(found: Fit, data: &FitProblem, options: FitOptions) -> Fit {
    COMPARED.from(found, data, options)
}

/// The fit, or one that is lower down by what counts where its values are stated. The fit must have
/// its derivatives.
pub(crate) fn descend_jumping_law_fully(found: Fit, data: &FitProblem, options: FitOptions) -> Fit {
    STATED.from(found, data, options)
}

impl Descent {
    /// From places along those values that belong to laws that jump.
    fn from(self, mut found: Fit, data: &FitProblem, options: FitOptions) -> Fit {
        for _ in 0..self.times {
            let Some((model, window_starts)) = self.lowest(&found, data) else {
                break;
            };
            let lower = fit(&model, &found.free, data, Some(&window_starts), options);
            if !self.is_lower(lower.residuals.cost(), &found) {
                break;
            }
            found = Fit {
                simulations: found.simulations + lower.simulations,
                ..lower
            };
        }
        found
    }

    fn is_lower(self, cost: f64, than: &Fit) -> bool {
        let by = self.share * than.residuals.cost() + self.variances * variance(than);
        cost < than.residuals.cost() - by
    }

    /// The lowest place along those values, all else fitted, if it is lower than the fit.
    fn lowest(self, found: &Fit, data: &FitProblem) -> Option<(Model, Vec<WindowStart>)> {
        let free = found.free.iter().enumerate();
        let jumping: Vec<usize> = free
            .filter(|(_, path)| jumps(path, &found.model))
            .map(|(i, _)| i)
            .collect();
        if jumping.is_empty() {
            return None;
        }
        let steps = found.normal_equations(0.0);
        let inverse = inverse(&steps.matrix)?;
        let places = jumping.par_iter().flat_map(|&value| {
            let error = (variance(found) * inverse[(value, value)]).sqrt();
            let lowest = lowest_alone(found, data, value, error).into_par_iter();
            lowest.filter_map(move |at| found.holding(value, at, data))
        });
        let cost = |place: &Fit| place.residuals.cost();
        let lowest = places.min_by(|a, b| cost(a).total_cmp(&cost(b)))?;
        let is_lower = self.is_lower(cost(&lowest), found);
        is_lower.then_some((lowest.model, lowest.window_starts))
    }
}

/// The fit, or one elsewhere on its stairs, where it suits other motions better: which command a
/// law swallows is told by the motions that have one near, and these may be the ones held out.
pub fn choose_by_other_motions(mut found: Fit, data: &FitProblem, others: &FitProblem) -> Fit {
    let jumping: Vec<ParameterPath> = found
        .free
        .iter()
        .copied()
        .filter(|p| jumps(p, &found.model))
        .collect();
    for path in jumping {
        let predicted = fit_start_states(&found.model, others);
        let places = places_on_stair(&found, data, &path).into_par_iter();
        let costs = places.map(|place| {
            let cost = residuals(&place, others, &predicted.window_starts).cost();
            (place, cost)
        });
        let mut places: Vec<(Model, f64)> = costs.collect();
        let costs = places.iter().map(|(_, cost)| *cost);
        let least = costs.fold(predicted.residuals.cost(), f64::min);
        if least + variance(&predicted) < predicted.residuals.cost() {
            places.retain(|(_, cost)| cost - least < ONE_STAIR * variance(&predicted));
            found.model = places.swap_remove(places.len() / 2).0;
        }
    }
    found
}

/// The model with this value moved alone over the stair on which the fit stands, from end to end.
fn places_on_stair(found: &Fit, data: &FitProblem, path: &ParameterPath) -> Vec<Model> {
    let from = path.get(&found.model).unwrap_or(f64::NAN);
    let (low, high) = path.bounds(&found.model);
    let moved = |at: f64| {
        let mut model = found.model.clone();
        ((low..=high).contains(&at) && path.set(&mut model, at)).then_some(model)
    };
    let (cost, one_stair) = (found.residuals.cost(), ONE_STAIR * variance(found));
    let is_on_stair = |at: f64| {
        let moved = moved(at).map(|model| residuals(&model, data, &found.window_starts).cost());
        moved.is_some_and(|moved| (moved - cost).abs() < one_stair)
    };
    let step = OF_DIFFERENCE * difference(path, from);
    let first = from - farthest(step, |way| is_on_stair(from - way));
    let last = from + farthest(step, |way| is_on_stair(from + way));
    let share = |place: i32| f64::from(place) / f64::from(ON_STAIR);
    let places = (0..=ON_STAIR).map(|place| first + share(place) * (last - first));
    places.filter_map(moved).collect()
}

/// How far something holds, from 0, where it does; looked for from a first `step`.
fn farthest(step: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut within, mut beyond) = (0.0, step);
    for _ in 0..DOUBLED {
        if !holds(beyond) {
            break;
        }
        (within, beyond) = (beyond, 2.0 * beyond);
    }
    for _ in 0..HALVED {
        let middle = 0.5 * (within + beyond);
        if holds(middle) {
            within = middle
        } else {
            beyond = middle
        }
    }
    within
}

/// Where a value that is moved alone, by parts of its standard error, leaves least of those places
/// that lie on other stairs than the fit.
fn lowest_alone(found: &Fit, data: &FitProblem, value: usize, error: f64) -> Vec<f64> {
    let (path, from) = (found.free[value], found.values()[value]);
    let (low, high) = path.bounds(&found.model);
    let between = (OF_ERROR * error).max(OF_DIFFERENCE * difference(&path, from));
    let (cost, one_stair) = (found.residuals.cost(), ONE_STAIR * variance(found));
    let places = (-PLACES..=PLACES).into_par_iter().filter_map(|place| {
        let at = from + f64::from(place) * between;
        let mut model = found.model.clone();
        let is_possible = (low..=high).contains(&at) && path.set(&mut model, at);
        is_possible.then_some(())?;
        let moved = residuals(&model, data, &found.window_starts).cost();
        ((moved - cost).abs() > one_stair).then_some((moved, at))
    });
    let mut places: Vec<(f64, f64)> = places.collect();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    places.dedup_by(|a, b| (a.0 - b.0).abs() <= one_stair);
    let lowest = places.into_iter().take(FITTED);
    lowest.map(|(_, at)| at).collect()
}

/// Variance of a weighted residual: less than the noise is left of a prediction without any.
fn variance(found: &Fit) -> f64 {
    found.residuals.mean_square().max(1.0)
}

/// Whether a value belongs to an effect whose law jumps in this model.
pub(super) fn jumps(path: &ParameterPath, model: &Model) -> bool {
    let ParameterPath::Effect { id, joint, .. } = path else {
        return false;
    };
    let joint = *joint;
    named(id).is_some_and(|effect| Candidate { effect, joint }.jumps(model))
}
