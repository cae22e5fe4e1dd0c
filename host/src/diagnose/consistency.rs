//! Whether the values an explanation needs are the same in every motion.
//!
//! An effect that stands in for another often fits each motion by itself, and only with another
//! value each time: a wrong torque for a wrong mass, until a payload is bolted on. A law holds in
//! all motions at once (Chow 1960, Econometrica 28, 591; invariance across conditions: Peters,
//! Buehlmann & Meinshausen 2016, JRSS B 78, 947).

use super::block_errors::AT_NOISE_FLOOR;
use super::hypothesis::Hypothesis;
use crate::fitting::{FitData, FitOptions, fit};
use rayon::prelude::*;

/// Iterations of a motion's own fit, from the values found for all.
const ITERATIONS: usize = 8;

/// Share of the squared error above the noise, on the training motions, that goes when every motion
/// has values of its own; `None` with fewer than two motions, and where nothing is left above the
/// noise.
pub(super) fn per_motion_reduction(hypothesis: &Hypothesis, training: &FitData) -> Option<f64> {
    let evaluation = hypothesis.evaluation.as_ref()?;
    if training.motions.len() < 2 || evaluation.training.rms() < AT_NOISE_FLOOR {
        return None;
    }
    let joint = &evaluation.fit;
    let own_cost = |motion: usize| {
        let own = training.only(motion);
        let windows = training.windows_of(motion);
        let nodes: Vec<_> = windows.map(|(w, _)| joint.nodes[w].clone()).collect();
        let options = FitOptions::iterations(ITERATIONS);
        let fit = fit(&joint.model, &joint.free, &own, Some(&nodes), options);
        fit.residuals.cost()
    };
    let motions = (0..training.motions.len()).into_par_iter();
    let alone: f64 = motions.map(own_cost).collect::<Vec<f64>>().iter().sum();
    let together = joint.residuals.cost();
    Some((together - alone) / (together - joint.residuals.count() as f64))
}
