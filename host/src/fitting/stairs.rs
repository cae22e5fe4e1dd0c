//! Fits of laws that jump: their squared error goes down in stairs, and what follows its slope
//! stops on one.
//!
//! A dead zone swallows one command more or not, and every such command is a stair. A fit is
//! resumed from the lowest of the places that lie along its values, as far as these are uncertain.

use super::covariance::inverse;
use super::data::FitData;
use super::fit::{Fit, FitOptions};
use super::node::Node;
use super::normal::NormalEquations;
use super::profile::moved;
use super::residual::residuals;
use super::solve::fit;
use crate::effects::{SMOOTH_DIFFERENCE, named};
use crate::model::{Model, ParameterPath};
use rayon::prelude::*;

/// Where the squared error is looked up, in standard errors.
const ERRORS: [f64; 6] = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0];
/// Share of the squared error that a place must be lower by, and a fit from there.
const LOWER: f64 = 0.005;
/// Most times that it goes down.
const TIMES: usize = 4;

/// The fit, or one that is lower down: from places along those of its values that belong to laws
/// that jump. The fit must have its derivatives.
pub(crate) fn down_the_stairs(mut found: Fit, data: &FitData, options: FitOptions) -> Fit {
    for _ in 0..TIMES {
        let Some((model, nodes)) = lowest(&found, data) else {
            break;
        };
        let lower = fit(&model, &found.free, data, Some(&nodes), options);
        if !is_lower(lower.residuals.cost(), &found) {
            break;
        }
        found = Fit {
            simulations: found.simulations + lower.simulations,
            ..lower
        };
    }
    found
}

/// Whether a value belongs to an effect whose law jumps.
fn jumps(path: &ParameterPath) -> bool {
    let ParameterPath::Effect { id, .. } = path else {
        return false;
    };
    named(id).is_some_and(|effect| effect.difference() > SMOOTH_DIFFERENCE)
}

fn is_lower(cost: f64, than: &Fit) -> bool {
    cost < (1.0 - LOWER) * than.residuals.cost()
}

/// The lowest place along those values, if it is lower than the fit; the other values and the start
/// states go along as they would if all were straight.
fn lowest(found: &Fit, data: &FitData) -> Option<(Model, Vec<Node>)> {
    let free = found.free.iter().enumerate();
    let jumping: Vec<usize> = free
        .filter(|(_, path)| jumps(path))
        .map(|(i, _)| i)
        .collect();
    if jumping.is_empty() {
        return None;
    }
    let steps = NormalEquations::assemble(found.free.len(), &found.jacobian, 0.0);
    let inverse = inverse(&steps.matrix)?;
    // Less than the noise is left of a prediction without any.
    let variance = found.residuals.mean_square().max(1.0);
    let places = jumping.par_iter().flat_map_iter(|&value| {
        let error = (variance * inverse[(value, value)]).sqrt();
        let along = inverse.column(value) / inverse[(value, value)];
        let ways = ERRORS.iter().flat_map(|errors| [-*errors, *errors]);
        let places = ways.filter_map(|errors| {
            let (model, nodes) = moved(found, &steps, &(&along * (errors * error)))?;
            let cost = residuals(&model, data, &nodes).cost();
            Some((cost, model, nodes))
        });
        places.collect::<Vec<_>>()
    });
    let lowest = places.min_by(|a, b| a.0.total_cmp(&b.0))?;
    is_lower(lowest.0, found).then_some((lowest.1, lowest.2))
}
