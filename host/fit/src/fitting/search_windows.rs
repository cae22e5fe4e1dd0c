//! Windows in which values are looked for: short ones, over which no wrong value leads far astray.

use super::data::FitProblem;
use super::fit::Fit;
use super::horizon::Horizon;
use crate::model::Model;
use crate::motion::Motion;

/// Windows to search on, s: the first that the base model follows.
const SEARCH_S: [f64; 3] = [1.0, 0.5, 0.25];
/// What a model may leave of the readings' departures from their mean, and follow them.
const MOST_LOST: f64 = 0.5;

/// Lengths of the windows to search on, the longest first: a second and less, none with fewer than
/// forty samples or longer than wanted. Few samples are searched from many starts instead, over the
/// horizon that counts.
pub fn search_horizons(whole: &FitProblem, longest: Horizon, few: bool) -> Vec<Horizon> {
    let samples: usize = whole.motions.iter().map(Motion::len).sum();
    let seconds: f64 = whole.motions.iter().map(Motion::duration_s).sum();
    if few {
        return vec![longest];
    }
    let least = 40.0 * seconds / samples.max(1) as f64;
    let mut lengths = SEARCH_S.map(|wanted| wanted.max(least)).to_vec();
    lengths.dedup();
    let lengths = lengths.into_iter().map(Horizon::Seconds);
    lengths.map(|length| longest.shorter(length)).collect()
}

/// Readings that a search among the effects of a robot in space needs at most, and windows that it
/// has at least: each of its steps costs several times what one of a planar chain does, and what
/// is missing shows in a part of the windows. What is found is fitted to all of them.
const SPATIAL_READINGS: usize = 3500;
const LEAST_WINDOWS: usize = 16;

/// As many of the windows, spread evenly over all motions, as a search among effects needs; all of
/// a planar chain.
pub fn enough_to_search(data: FitProblem, model: &Model) -> FitProblem {
    if model.robot.is_none() {
        return data;
    }
    let (readings, windows) = (data.samples() * data.joints(), data.windows.len());
    let wanted = (windows * SPATIAL_READINGS).div_ceil(readings.max(1));
    data.with_windows(wanted.max(LEAST_WINDOWS))
}

/// Whether a fitted model still follows the windows of these data: what it leaves is less than half
/// of how far the readings are from their mean in each window. Where it is not, a fit only damps
/// the motion that it loses, and derivatives there say nothing of what is missing.
pub fn is_followed(fit: &Fit, data: &FitProblem) -> bool {
    let mut spread = 0.0;
    for window in &data.windows {
        for (signal, sigma) in data.sigma.iter().enumerate() {
            let readings = &data.measured(window.motion, signal)[window.samples.clone()];
            let known = readings.iter().filter(|reading| reading.is_finite());
            let mean = known.clone().sum::<f64>() / known.clone().count().max(1) as f64;
            spread += known.map(|y| ((y - mean) / sigma).powi(2)).sum::<f64>();
        }
    }
    fit.residuals.cost() < MOST_LOST * MOST_LOST * spread
}
