//! The integration step of a diagnosis and of a check: as coarse as the measurement allows.

use crate::fitting::{FitData, Node, residuals};
use crate::log::Motion;
use crate::model::Model;

/// Change of a prediction, in standard deviations of a reading, that no verdict hangs on.
const NEGLIGIBLE: f64 = 0.03;

/// Longest step that this model may take because its own laws allow it, s: those that are tried on
/// it, a grip that slips for one, remember from step to step.
const LONGEST_S: f64 = 0.0051;

/// The model with the largest step, a whole fraction of the sampling period, whose predictions over
/// these windows differ from those at the model's own step by next to nothing against the noise.
pub(super) fn coarsened(model: &Model, data: &FitData) -> Model {
    let nodes: Vec<Node> = data
        .windows
        .iter()
        .map(|window| data.guessed(window))
        .collect();
    let fine = residuals(model, data, &nodes);
    let period_s = data
        .motions
        .iter()
        .map(period_s)
        .fold(f64::INFINITY, f64::min);
    let steps = (1..=8).map(|parts| period_s / f64::from(parts));
    let steps = steps.take_while(|step_s| *step_s > 1.5 * model.step_s);
    for step_s in steps.filter(|step_s| *step_s < LONGEST_S) {
        let coarse = Model {
            step_s,
            ..model.clone()
        };
        let (mut sum, mut count) = (0.0, 0usize);
        let shifted = residuals(&coarse, data, &nodes);
        for (a, b) in fine
            .windows
            .iter()
            .flatten()
            .zip(shifted.windows.iter().flatten())
        {
            sum += (a - b) * (a - b);
            count += 1;
        }
        if (sum / count.max(1) as f64).sqrt() < NEGLIGIBLE {
            return coarse;
        }
    }
    model.clone()
}

/// Usual time between samples, s.
fn period_s(motion: &Motion) -> f64 {
    motion.duration_s() / motion.len().saturating_sub(1).max(1) as f64
}
