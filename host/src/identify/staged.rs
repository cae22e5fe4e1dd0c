//! Fits from values that are far off: short windows first, then longer ones.
//!
//! Over a short window no wrong value leads far astray, so the cost has few false valleys; over a long one the
//! values are known best. Each stage starts where the one before ended (Bock 1981, multiple shooting; homotopy
//! in the length of the windows).

use super::data::{Data, Horizon};
use super::fit::{Fit, FitOptions, fit};
use crate::model::{Model, ParameterPath};

/// Seconds of one window, stage by stage.
const STAGES_S: [f64; 4] = [0.25, 0.5, 1.0, 2.0];

/// A stage need not end exactly where its cost is least.
const STAGE: FitOptions = FitOptions {
    iterations: 15,
    tolerance: 1e-3,
};

/// Root-mean-square weighted residual that leaves nothing to look for.
const AT_FLOOR: f64 = 1.15;

/// The model after the stages of short windows: near enough for [`super::longest_stable`] and a last fit.
pub fn approach(model: &Model, free: &[ParameterPath], data: &Data) -> Model {
    stages(model, free, data).0
}

fn stages(model: &Model, free: &[ParameterPath], data: &Data) -> (Model, usize) {
    let longest = data.windows.iter().map(|w| w.samples.len()).max();
    let mut at = model.clone();
    let mut simulations = 0;
    for seconds in STAGES_S {
        let stage = data.recut(Horizon::Seconds(seconds));
        if stage.windows.iter().map(|w| w.samples.len()).max() >= longest {
            break;
        }
        let found = fit(&at, free, &stage, None, STAGE);
        at = found.model;
        simulations += found.simulations;
    }
    (at, simulations)
}

/// Fits the free parameters from values that may be several times off; windows as in `data`.
///
/// A plain fit that leaves nothing but noise is taken as it is. Otherwise the better one counts of the plain fit
/// and one that starts where [`approach`] ends.
pub fn fit_staged(model: &Model, free: &[ParameterPath], data: &Data) -> Fit {
    let plain = fit(model, free, data, None, FitOptions::default());
    let mean = plain.residuals.cost() / plain.residuals.count().max(1) as f64;
    if mean.sqrt() < AT_FLOOR {
        return plain;
    }
    let (near, simulations) = stages(model, free, data);
    let mut staged = fit(&near, free, data, None, FitOptions::default());
    staged.simulations += simulations + plain.simulations;
    if staged.residuals.cost() < plain.residuals.cost() {
        staged
    } else {
        Fit {
            simulations: staged.simulations,
            ..plain
        }
    }
}
