//! How far apart an experiment puts explanations, in standard errors.

use super::candidates::Experiment;
use super::limits::ExperimentLimits;
use super::prediction::{as_data, predicted_motion};
use super::rival::Rival;
use crate::fitting::{FitData, FitOptions, Horizon, fit, fit_start_states};
use rayon::prelude::*;

/// Iterations of a fit of start states.
const START: usize = 4;
/// Iterations of the fit that confirms a separation.
const CONFIRM: usize = 15;

/// Separation of each pair of rivals `(a, b)`, a before b, in standard errors; `None` where a rival
/// leaves the limits.
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

/// The experiment as each rival predicts it, as data; `None` where one leaves the limits.
fn predictions(
    rivals: &[Rival],
    experiment: &Experiment,
    limits: &ExperimentLimits,
    logs: &FitData,
    horizon: Horizon,
) -> Option<Vec<FitData>> {
    let motions = rivals.iter().map(|rival| {
        let motion = predicted_motion(&rival.fit.model, experiment);
        limits.keeps(&rival.fit.model, &motion).then_some(motion)
    });
    let motions = motions.collect::<Option<Vec<_>>>()?;
    let data = rivals.iter().zip(motions);
    Some(
        data.map(|(rival, motion)| as_data(&rival.fit.model, motion, logs, horizon, 1))
            .collect(),
    )
}

/// Separations by derivatives: each rival moves its free values one Gauss-Newton step towards what
/// the other predicts, as far as the logs let it.
pub(super) fn by_derivatives(
    rivals: &[Rival],
    experiment: &Experiment,
    limits: &ExperimentLimits,
    logs: &FitData,
    horizon: Horizon,
) -> Option<Separations> {
    let data = predictions(rivals, experiment, limits, logs, horizon)?;
    let squared = |truth: usize, other: usize| {
        let rival = &rivals[other];
        let (model, free) = (&rival.fit.model, &rival.fit.free);
        // Where dry friction holds at the start, derivatives are good near the right state alone.
        let start = FitOptions::iterations(START).rough();
        let started = fit(model, &[], &data[truth], None, start);
        let (nodes, options) = (Some(&started.nodes[..]), FitOptions::iterations(0));
        let at = fit(model, free, &data[truth], nodes, options);
        rival.share * at.information().cost_left(&rival.known)
    };
    let of_pairs = pairs(rivals.len()).into_iter();
    let of_pairs = of_pairs.map(|(a, b)| squared(a, b).min(squared(b, a)).sqrt());
    Some(Separations {
        of_pairs: of_pairs.collect(),
    })
}

/// The same by fitting each rival to the logs and to what the other predicts, together.
pub(super) fn by_fits(
    rivals: &[Rival],
    experiment: &Experiment,
    limits: &ExperimentLimits,
    logs: &FitData,
    horizon: Horizon,
) -> Option<Separations> {
    let data = predictions(rivals, experiment, limits, logs, horizon)?;
    let squared = |truth: usize, other: usize| {
        let rival = &rivals[other];
        let (model, free) = (&rival.fit.model, &rival.fit.free);
        let mut nodes = rival.fit.nodes.clone();
        nodes.extend(fit_start_states(model, &data[truth]).nodes);
        let joined = logs.joined(&data[truth]);
        let options = FitOptions::iterations(CONFIRM).rough();
        let found = fit(model, free, &joined, Some(&nodes), options);
        rival.share * (found.residuals.cost() - rival.fit.residuals.cost()).max(0.0)
    };
    let of_pairs = pairs(rivals.len()).into_par_iter();
    let of_pairs = of_pairs.map(|(a, b)| squared(a, b).min(squared(b, a)).sqrt());
    Some(Separations {
        of_pairs: of_pairs.collect(),
    })
}
