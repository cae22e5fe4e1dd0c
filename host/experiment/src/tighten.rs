//! How much an experiment tightens values: optimality of the Fisher information.

use super::candidates::Experiment;
use super::limits::ExperimentLimits;
use super::prediction::{as_data, predicted_motion};
use super::proposal::{ExperimentProposal, TightenedValue};
use super::propose::{ProposeOptions, all_experiments, nothing, proposed};
use super::rival::Rival;
use crate::error::Result;
use crate::fitting::{FitOptions, FitProblem, Horizon, fit, intervals};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// What a design makes small.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Criterion {
    /// The volume of the confidence ellipsoid of the values: D-optimality.
    #[default]
    D,
    /// The sum of their variances, each as a share of what it is with the logs alone: A-optimality.
    A,
}

/// Covariance of the free values, start states eliminated, with the logs and one experiment more;
/// `None` where the model leaves the limits, or where it is not determined.
fn covariance_with(
    rival: &Rival,
    experiment: &Experiment,
    limits: &ExperimentLimits,
    logs: &FitProblem,
    horizon: Horizon,
) -> Option<DMatrix<f64>> {
    let model = &rival.fit.model;
    let motion = predicted_motion(model, experiment);
    if !limits.keeps(model, &motion) {
        return None;
    }
    let data = as_data(model, motion, logs, horizon, 1);
    let at = fit(
        model,
        &rival.fit.free,
        &data,
        None,
        FitOptions::iterations(0),
    );
    (at.information().matrix + &rival.known).try_inverse()
}

impl Criterion {
    /// How much smaller a covariance is than before, for the values at `places`: above 0 is better.
    pub(super) fn gain(self, before: &DMatrix<f64>, after: &DMatrix<f64>, places: &[usize]) -> f64 {
        let count = places.len();
        match self {
            Criterion::D => {
                let part = |c: &DMatrix<f64>| {
                    DMatrix::from_fn(count, count, |i, k| {
                        // Scaled by the size before: determinants of raw units underflow.
                        let (i, k) = (places[i], places[k]);
                        c[(i, k)] / (before[(i, i)] * before[(k, k)]).sqrt()
                    })
                };
                0.5 * (part(before).determinant() / part(after).determinant()).ln()
            }
            Criterion::A => {
                let ratio = |&i: &usize| 1.0 - after[(i, i)] / before[(i, i)];
                places.iter().map(ratio).sum()
            }
        }
    }
}

/// The experiment that tightens the values at `places` most.
pub(super) fn tightened(
    rival: &Rival,
    places: &[usize],
    logs: &FitProblem,
    horizon: Horizon,
    options: &ProposeOptions,
) -> Result<ExperimentProposal> {
    let mut proposal = nothing(std::slice::from_ref(rival));
    let before = rival.known.clone().try_inverse();
    let Some(before) = before.filter(|_| !places.is_empty()) else {
        return Ok(proposal);
    };
    let experiments = all_experiments(rival, options)?;
    let judged = experiments.par_iter().filter_map(|experiment| {
        let after = covariance_with(rival, experiment, &options.limits, logs, horizon)?;
        let gain = options.criterion.gain(&before, &after, places);
        Some((experiment, after, gain))
    });
    let judged: Vec<(&Experiment, DMatrix<f64>, f64)> = judged.collect();
    proposal.simulated = experiments.len();
    proposal.within_limits = judged.len();
    let best = judged.iter().max_by(|(a, _, gain_a), (b, _, gain_b)| {
        gain_a.total_cmp(gain_b).then(b.effort().cmp(&a.effort()))
    });
    let Some((experiment, after, _)) = best else {
        return Ok(proposal);
    };
    proposal.experiment = Some(proposed(experiment, rival, &options.limits));
    proposal.values = tighter(rival, places, logs, &before, after);
    Ok(proposal)
}

/// Standard errors before, as the logs have them, and after, smaller by the ratio of covariances.
fn tighter(
    rival: &Rival,
    places: &[usize],
    logs: &FitProblem,
    before: &DMatrix<f64>,
    after: &DMatrix<f64>,
) -> Vec<TightenedValue> {
    let known = intervals(&rival.fit, logs).map(|(intervals, _)| intervals);
    let values = rival.fit.values();
    let tightened = places.iter().map(|&i| {
        let path = rival.fit.free[i];
        let error = match &known {
            Some(intervals) => intervals[i].standard_error,
            None => before[(i, i)].sqrt(),
        };
        TightenedValue {
            path: path.to_string(),
            unit: path.unit().to_string(),
            value: values[i],
            standard_error_before: error,
            standard_error_after: error * (after[(i, i)] / before[(i, i)]).sqrt(),
        }
    });
    tightened.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_criteria_see_only_the_values_that_are_asked_for() {
        let before = DMatrix::from_row_slice(2, 2, &[4.0, 0.0, 0.0, 1.0]);
        let first = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 1.0]);
        let second = DMatrix::from_row_slice(2, 2, &[4.0, 0.0, 0.0, 0.01]);
        for criterion in [Criterion::D, Criterion::A] {
            let gain = |after, places: &[usize]| criterion.gain(&before, after, places);
            assert!(gain(&first, &[0]) > gain(&second, &[0]) + 0.5);
            assert!(gain(&second, &[1]) > gain(&first, &[1]) + 0.5);
            assert!(gain(&before, &[0, 1]).abs() < 1e-12);
        }
        // Half the standard error of one value: ln 2.
        assert!((Criterion::D.gain(&before, &first, &[0]) - 2f64.ln()).abs() < 1e-12);
    }
}
