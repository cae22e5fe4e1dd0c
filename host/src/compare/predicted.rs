//! Measured and predicted angles of whole motions, side by side.

use crate::fitting::{Data, Node};
use crate::model::Model;
use crate::sim::{Plant, SensorState, predict};
use rayon::prelude::*;

/// Predicted angles, rad, `[motion][joint][sample]`, every window started from its node.
///
/// Unlike the fit's residuals these are not capped, so an error counts in full however small the noise is. From
/// where a prediction runs away to infinity its last finite value stands.
pub(super) fn predicted(model: &Model, data: &Data, nodes: &[Node]) -> Vec<Vec<Vec<f64>>> {
    (0..data.motions.len())
        .into_par_iter()
        .map(|motion| one_motion(model, data, nodes, motion))
        .collect()
}

fn one_motion(model: &Model, data: &Data, nodes: &[Node], motion: usize) -> Vec<Vec<f64>> {
    let log = &data.motions[motion];
    let plant = Plant::new(model, log);
    let mut memory = SensorState::default();
    let mut angles = vec![Vec::with_capacity(log.len()); plant.len()];
    for (window, node) in data.windows.iter().zip(nodes) {
        if window.motion != motion || window.samples.is_empty() {
            continue;
        }
        let samples = window.samples.len();
        let mut readings = vec![0.0; samples * plant.len()];
        let start = node.start(&plant);
        let stretch = window.samples.clone();
        predict(&plant, log, stretch, &start, &mut memory, &mut readings);
        for (joint, part) in readings.chunks(samples).enumerate() {
            let mut last = node.reading_rad[joint];
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
pub(super) fn residual(data: &Data, predicted: &[Vec<Vec<f64>>], joint: usize) -> Vec<Vec<f64>> {
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
