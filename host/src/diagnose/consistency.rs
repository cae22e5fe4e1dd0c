//! Whether the values an explanation needs are the same in every motion.
//!
//! An effect that stands in for another often fits each motion by itself, and only with another value each time:
//! a wrong torque for a wrong mass, until a payload is bolted on. A law holds in all motions at once (Chow 1960,
//! Econometrica 28, 591; invariance across conditions: Peters, Buehlmann & Meinshausen 2016, JRSS B 78, 947).

use super::score::AT_FLOOR;
use super::trial::Trial;
use crate::fitting::{Data, FitOptions, fit};
use rayon::prelude::*;

/// Iterations of a motion's own fit, from the values found for all.
const ITERATIONS: usize = 8;

/// Share of the squared error above the noise, on the training motions, that goes when every motion has values of
/// its own; `None` with fewer than two motions, and where nothing is left above the noise.
pub(super) fn own_values_share(trial: &Trial, training: &Data) -> Option<f64> {
    let judged = trial.judged.as_ref()?;
    if training.motions.len() < 2 || judged.training.rms() < AT_FLOOR {
        return None;
    }
    let options = FitOptions {
        iterations: ITERATIONS,
        ..FitOptions::default()
    };
    let alone: f64 = (0..training.motions.len())
        .into_par_iter()
        .map(|motion| {
            let own = training.only(motion);
            let nodes: Vec<_> = training
                .windows
                .iter()
                .zip(&judged.fit.nodes)
                .filter(|(window, _)| window.motion == motion)
                .map(|(_, node)| node.clone())
                .collect();
            fit(
                &judged.fit.model,
                &judged.fit.free,
                &own,
                Some(&nodes),
                options,
            )
            .residuals
            .cost()
        })
        .collect::<Vec<f64>>()
        .iter()
        .sum();
    let together = judged.fit.residuals.cost();
    let noise = judged.fit.residuals.count() as f64;
    Some((together - alone) / (together - noise))
}
