//! How far apart an experiment puts explanations, in standard errors.

use super::candidates::Experiment;
use super::limits::ExperimentLimits;
use super::prediction::{as_data, predicted_motion};
use super::rival::Rival;
use crate::fitting::{Fit, FitOptions, FitProblem, Horizon, fit};
use rayon::prelude::*;

/// Iterations of a fit of start states.
const START: usize = 6;
/// Iterations of the fit that confirms a separation.
const CONFIRM: usize = 15;

/// Separation of each pair of rivals `(a, b)`, a before b, in standard errors.
pub(super) struct Separations {
    /// In the order of [`pairs`].
    pub of_pairs: Vec<f64>,
}

/// All pairs of so many rivals.
pub(super) fn pairs(rivals: usize) -> Vec<(usize, usize)> {
    let pairs = (0..rivals).flat_map(|b| (0..b).map(move |a| (a, b)));
    let mut pairs: Vec<(usize, usize)> = pairs.collect();
    pairs.sort_unstable();
    pairs
}

/// An experiment as one rival predicts it.
struct Prediction {
    /// Without noise.
    data: FitProblem,
    /// The rival's own start states fitted to it: what that leaves is no separation. Where dry
    /// friction holds at the start, it is not nothing.
    own: Fit,
}

/// The experiment as each rival predicts it; `None` where one leaves the limits.
fn predictions(
    rivals: &[Rival],
    experiment: &Experiment,
    limits: &ExperimentLimits,
    logs: &FitProblem,
    horizon: Horizon,
) -> Option<Vec<Prediction>> {
    let motions = rivals.iter().map(|rival| {
        let motion = predicted_motion(&rival.fit.model, experiment);
        let keeps = limits.keeps(&rival.fit.model, &motion);
        keeps.then_some((rival, motion))
    });
    let motions = motions.collect::<Option<Vec<_>>>()?.into_iter();
    let predictions = motions.map(|(rival, motion)| {
        let model = &rival.fit.model;
        let data = as_data(model, motion, logs, horizon, 1);
        let own = fit(model, &[], &data, None, FitOptions::iterations(START));
        Prediction { data, own }
    });
    Some(predictions.collect())
}

/// Separations by derivatives: each rival moves its free values one Gauss-Newton step towards what
/// the other predicts, as far as the logs let it.
pub(super) fn by_derivatives(
    rivals: &[Rival],
    experiment: &Experiment,
    limits: &ExperimentLimits,
    logs: &FitProblem,
    horizon: Horizon,
) -> Option<Separations> {
    let predictions = predictions(rivals, experiment, limits, logs, horizon)?;
    let squared = |truth: usize, other: usize| {
        let (rival, Prediction { data, own }) = (&rivals[other], &predictions[truth]);
        let (window_starts, options) = (Some(&own.window_starts[..]), FitOptions::iterations(0));
        let at = fit(
            &rival.fit.model,
            &rival.fit.free,
            data,
            window_starts,
            options,
        );
        let left = at.information().cost_left(&rival.known) - own.information().cost;
        rival.share * left.max(0.0)
    };
    Some(of_pairs(rivals.len(), squared))
}

/// The same by fitting each rival to the logs and to what the other predicts, together.
pub(super) fn by_fits(
    rivals: &[Rival],
    experiment: &Experiment,
    limits: &ExperimentLimits,
    logs: &FitProblem,
    horizon: Horizon,
) -> Option<Separations> {
    let predictions = predictions(rivals, experiment, limits, logs, horizon)?;
    let squared = |truth: usize, other: usize| {
        let (rival, Prediction { data, own }) = (&rivals[other], &predictions[truth]);
        let window_starts = [&rival.fit.window_starts[..], &own.window_starts].concat();
        let options = FitOptions::iterations(CONFIRM).rough();
        let (model, free) = (&rival.fit.model, &rival.fit.free);
        let found = fit(
            model,
            free,
            &logs.joined(data),
            Some(&window_starts),
            options,
        );
        let alone = rival.fit.residuals.cost() + own.residuals.cost();
        rival.share * (found.residuals.cost() - alone).max(0.0)
    };
    Some(of_pairs(rivals.len(), squared))
}

/// The smaller of both directions of each pair, from the squares.
fn of_pairs(rivals: usize, squared: impl Fn(usize, usize) -> f64 + Sync) -> Separations {
    let pairs = pairs(rivals).into_par_iter();
    let apart = pairs.map(|(a, b)| squared(a, b).min(squared(b, a)).sqrt());
    Separations {
        of_pairs: apart.collect(),
    }
}
