//! Measured and predicted angles (rates of joints without a measured angle, and of rate sensors
//! beside an angle's) of whole motions.

use crate::fitting::{self, FitProblem, WindowStart};
use crate::model::MeasuredSignal;
use crate::model::Model;
use rayon::prelude::*;

/// Predicted signals, rad or rad/s, `[motion][signal][sample]`, every window from its start.
///
/// Unlike the fit's residuals these are not capped, so an error counts in full however small the
/// noise is. From where a prediction runs away to infinity its last finite value stands.
pub(super) fn predicted(
    model: &Model,
    data: &FitProblem,
    window_starts: &[WindowStart],
) -> Vec<Vec<Vec<f64>>> {
    (0..data.motions.len())
        .into_par_iter()
        .map(|motion| one_motion(model, data, window_starts, motion))
        .collect()
}

fn one_motion(
    model: &Model,
    data: &FitProblem,
    window_starts: &[WindowStart],
    motion: usize,
) -> Vec<Vec<f64>> {
    let log = &data.motions[motion];
    let mut series = vec![Vec::with_capacity(log.len()); data.signals.len()];
    let windows = fitting::predicted(model, data, window_starts, motion);
    for ((index, window), readings) in data.windows_of(motion).zip(windows) {
        for (signal, part) in readings.chunks(window.samples.len()).enumerate() {
            let order = usize::from(data.signals[signal] == MeasuredSignal::Rate);
            let mut last =
                window_starts[index].unknowns[order * data.joints() + data.joint_of(signal)];
            series[signal].extend(part.iter().map(|value| {
                if value.is_finite() {
                    last = *value;
                }
                last
            }));
        }
    }
    series
}

/// Measured minus predicted, rad or rad/s, per motion; not a number where nothing was measured.
pub(super) fn residual(
    data: &FitProblem,
    predicted: &[Vec<Vec<f64>>],
    signal: usize,
) -> Vec<Vec<f64>> {
    let motions = predicted.iter().enumerate();
    motions
        .map(|(motion, predicted)| {
            let measured = data.measured(motion, signal);
            measured
                .iter()
                .zip(&predicted[signal])
                .map(|(y, model)| y - model)
                .collect()
        })
        .collect()
}
