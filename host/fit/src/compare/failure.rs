//! Where the error is: conditions that hold more of it than their share of the samples.

use super::conditions::{ConditionSamples, met};
use super::result::{Failure, SignalError};
use super::sample_features::features;
use crate::fitting::FitProblem;
use crate::model::{MeasuredSignal, Model};

/// Most failures told.
const MOST: usize = 6;
/// Least share of the samples, and least number of them, from which a condition is judged.
const LEAST_SHARE: f64 = 0.01;
const LEAST_SAMPLES: usize = 5;
/// Error over samples from which a condition stands out.
const LEAST_EXCESS: f64 = 1.3;
/// Overlap (Jaccard) of two sets of samples from which they are one condition said twice.
const SAME: f64 = 0.8;
/// Share of the error above the floor from which a joint is asked about at all.
const LEAST_ABOVE_FLOOR: f64 = 0.1;

/// A condition under which a model fails, and the samples that meet it.
#[derive(Debug, Clone, PartialEq)]
pub struct FailingSamples {
    /// The condition and its shares.
    pub failure: Failure,
    /// Whether each sample meets it, the motions end to end.
    pub holds: Vec<bool>,
}

/// Conditions of all joints, those that hold most of the error beyond their share first.
///
/// It says where the error shows. In a long run an error shows after its cause, where angles move
/// fast or late in the motion; the shorter the horizon, the nearer the two are. `residuals` is
/// `[signal][motion][sample]`, rad or rad/s.
pub(super) fn failing(
    model: &Model,
    data: &FitProblem,
    residuals: &[Vec<Vec<f64>>],
    signals: &[SignalError],
) -> Vec<FailingSamples> {
    let mut all = Vec::new();
    let measured = residuals.iter().zip(&data.signals);
    let measured = measured.filter(|(_, signal)| **signal != MeasuredSignal::Nothing);
    for (signal, (residual, _)) in signals.iter().zip(measured) {
        let joint = signal.joint - 1;
        if signal.share_above_floor > LEAST_ABOVE_FLOOR {
            let error: Vec<f64> = residual.iter().flatten().copied().collect();
            let degrees = model.log.joints[joint].in_degrees();
            let shown = if degrees {
                ("deg", 1f64.to_degrees())
            } else {
                (model.joints[joint].units()[0], 1.0)
            };
            let conditions = met(&features(model, &data.motions, joint), shown);
            let ranked = ranked(&error, signal.floor, conditions);
            all.extend(
                ranked
                    .into_iter()
                    .map(|r| r.told(signal, model.link_count() > 1)),
            );
        }
    }
    all.sort_by(|a, b| excess(&b.failure).total_cmp(&excess(&a.failure)));
    all.truncate(MOST);
    all
}

fn excess(failure: &Failure) -> f64 {
    failure.error_share - failure.sample_share
}

/// A condition and what it holds.
#[derive(Debug)]
pub(super) struct Ranked {
    pub words: String,
    pub error_share: f64,
    pub sample_share: f64,
    holds: Vec<bool>,
}

impl Ranked {
    fn told(self, signal: &SignalError, several: bool) -> FailingSamples {
        let (error, samples) = (percent(self.error_share), percent(self.sample_share));
        let of_rate = if signal.beside_angle {
            " of the rate"
        } else {
            ""
        };
        let of_joint = if several {
            format!("{of_rate} of joint {}", signal.joint)
        } else {
            of_rate.to_string()
        };
        let failure = Failure {
            joint: signal.joint,
            sentence: format!(
                "{error} of the error{of_joint} falls in {samples} of the samples: {}",
                self.words
            ),
            condition: self.words,
            error_share: self.error_share,
            sample_share: self.sample_share,
        };
        FailingSamples {
            failure,
            holds: self.holds,
        }
    }
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// Conditions that stand out, best first, each said once.
pub(super) fn ranked(
    error_rad: &[f64],
    floor_rad: f64,
    conditions: Vec<ConditionSamples>,
) -> Vec<Ranked> {
    let weight: Vec<f64> = error_rad
        .iter()
        .map(|e| (e * e - floor_rad * floor_rad).max(0.0))
        .collect();
    let measured = error_rad.iter().filter(|e| e.is_finite()).count();
    let total: f64 = weight.iter().sum();
    if total <= 0.0 {
        return Vec::new();
    }
    let mut standing_out: Vec<Ranked> = conditions
        .into_iter()
        .filter_map(|condition| {
            let (mut inside, mut samples) = (0.0, 0);
            for ((holds, weight), error) in condition.holds.iter().zip(&weight).zip(error_rad) {
                if *holds && error.is_finite() {
                    inside += weight;
                    samples += 1;
                }
            }
            let (error_share, sample_share) = (inside / total, samples as f64 / measured as f64);
            let judged = samples >= LEAST_SAMPLES && sample_share >= LEAST_SHARE;
            (judged && error_share >= LEAST_EXCESS * sample_share).then_some(Ranked {
                words: condition.words,
                error_share,
                sample_share,
                holds: condition.holds,
            })
        })
        .collect();
    standing_out.sort_by(|a, b| {
        (b.error_share - b.sample_share).total_cmp(&(a.error_share - a.sample_share))
    });
    let mut kept: Vec<Ranked> = Vec::new();
    for candidate in standing_out {
        if kept
            .iter()
            .all(|better| overlap(&better.holds, &candidate.holds) <= SAME)
        {
            kept.push(candidate);
        }
    }
    kept
}

/// Samples in both sets over samples in either.
fn overlap(a: &[bool], b: &[bool]) -> f64 {
    let both = a.iter().zip(b).filter(|(a, b)| **a && **b).count();
    let either = a.iter().zip(b).filter(|(a, b)| **a || **b).count();
    both as f64 / either.max(1) as f64
}
