//! What the model predicts against what was measured, window by window.

use super::data::Data;
use super::node::Node;
use crate::model::Model;
use crate::sim::{Plant, SensorState, predict};
use rayon::prelude::*;

/// Weighted residuals, (measured - predicted) / sigma; one vector per window, joint after joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Residuals {
    /// Per window: `joints * samples` values. A sample that was not measured counts 0.
    pub windows: Vec<Vec<f64>>,
}

/// A prediction that runs away counts as this far off, rad, so that a fit can turn back.
const RUNAWAY_RAD: f64 = 10.0;

impl Residuals {
    /// Sum of squares.
    pub fn cost(&self) -> f64 {
        self.windows.iter().flatten().map(|r| r * r).sum()
    }

    /// Number of residuals.
    pub fn count(&self) -> usize {
        self.windows.iter().map(Vec::len).sum()
    }
}

/// Residuals of a model from these nodes, motions in parallel.
pub fn residuals(model: &Model, data: &Data, nodes: &[Node]) -> Residuals {
    let per_motion: Vec<Vec<Vec<f64>>> = (0..data.motions.len())
        .into_par_iter()
        .map(|motion| motion_residuals(model, data, nodes, motion))
        .collect();
    Residuals {
        windows: per_motion.into_iter().flatten().collect(),
    }
}

/// Residuals of one motion's windows, in order: sensor memory runs on from window to window.
pub(super) fn motion_residuals(
    model: &Model,
    data: &Data,
    nodes: &[Node],
    motion: usize,
) -> Vec<Vec<f64>> {
    let log = &data.motions[motion];
    let plant = Plant::new(model, log);
    let mut memory = SensorState::default();
    data.windows
        .iter()
        .zip(nodes)
        .filter(|(window, _)| window.motion == motion)
        .map(|(window, node)| {
            let samples = window.samples.len();
            let mut out = vec![0.0; samples * plant.len()];
            let start = node.start(&plant);
            predict(
                &plant,
                log,
                window.samples.clone(),
                &start,
                &mut memory,
                &mut out,
            );
            for (joint, part) in out.chunks_mut(samples).enumerate() {
                let measured = &log.position_rad[joint][window.samples.clone()];
                let weight = 1.0 / data.sigma_rad[joint];
                for (value, measured) in part.iter_mut().zip(measured) {
                    *value = if measured.is_nan() {
                        0.0
                    } else if value.is_nan() {
                        RUNAWAY_RAD * weight
                    } else {
                        ((measured - *value) * weight)
                            .clamp(-RUNAWAY_RAD * weight, RUNAWAY_RAD * weight)
                    };
                }
            }
            out
        })
        .collect()
}
