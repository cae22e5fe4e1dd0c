//! Measured and predicted angles of whole motions, side by side.

use crate::fitting::{FitData, Node, predicted_rad};
use crate::model::Model;
use rayon::prelude::*;

/// Predicted angles, rad, `[motion][joint][sample]`, every window started from its node.
///
/// Unlike the fit's residuals these are not capped, so an error counts in full however small the
/// noise is. From where a prediction runs away to infinity its last finite value stands.
pub(super) fn predicted(model: &Model, data: &FitData, nodes: &[Node]) -> Vec<Vec<Vec<f64>>> {
    (0..data.motions.len())
        .into_par_iter()
        .map(|motion| one_motion(model, data, nodes, motion))
        .collect()
}

fn one_motion(model: &Model, data: &FitData, nodes: &[Node], motion: usize) -> Vec<Vec<f64>> {
    let log = &data.motions[motion];
    let mut angles = vec![Vec::with_capacity(log.len()); data.joints()];
    let windows = predicted_rad(model, data, nodes, motion);
    for ((index, window), readings) in data.windows_of(motion).zip(windows) {
        for (joint, part) in readings.chunks(window.samples.len()).enumerate() {
            let mut last = nodes[index].unknowns[joint];
            angles[joint].extend(part.iter().map(|value| {
                if value.is_finite() {
                    last = *value;
                }
                last
            }));
        }
    }
    angles
}

/// Measured minus predicted, rad, per motion; not a number where nothing was measured.
pub(super) fn residual(data: &FitData, predicted: &[Vec<Vec<f64>>], joint: usize) -> Vec<Vec<f64>> {
    let pairs = data.motions.iter().zip(predicted);
    pairs
        .map(|(motion, predicted)| {
            let measured = &motion.position_rad[joint];
            measured
                .iter()
                .zip(&predicted[joint])
                .map(|(y, model)| y - model)
                .collect()
        })
        .collect()
}
