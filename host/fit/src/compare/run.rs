//! Comparing one model with motions: nothing is fitted but where each run starts.

use super::failure::{FailingSamples, failing};
use super::model_run::ModelRun;
use super::predicted::{predicted, residual};
use super::residual_tests::residual_tests;
use super::result::{Comparison, HorizonError, SignalError, Trace};
use crate::fitting::{FitProblem, Horizon, fit_start_states};
use crate::model::{MeasuredSignal, Model};
use crate::motion::Motion;

/// Times without correction at which the error is told, s.
const LADDER_S: [f64; 4] = [0.1, 0.3, 1.0, 3.0];
/// A window's start state is fitted to it; with fewer samples than this it would explain most of
/// them.
const LEAST_SAMPLES: f64 = 10.0;
/// Most points of a drawn trace.
const DRAWN: usize = 800;

/// Compares a model as it is with measured motions; `name` stands for it in reports.
///
/// Without a horizon the model runs freely over whole motions where a small start error does not
/// swamp it, else over the longest windows that can bear it.
pub fn compare(
    model: &Model,
    name: &str,
    motions: &[Motion],
    horizon: Option<Horizon>,
) -> Comparison {
    let horizon = horizon.unwrap_or(Horizon::Whole);
    let data = FitProblem::new(model, motions.to_vec(), horizon);
    ModelRun::new(model.clone(), data, horizon).comparison(name)
}

/// Compares several models, each with its name and motions, all over the first one's horizon.
pub fn compare_all<'a>(
    models: impl IntoIterator<Item = (&'a str, &'a Model, &'a [Motion])>,
    mut horizon: Option<Horizon>,
) -> Vec<Comparison> {
    let compared = models.into_iter().map(|(name, model, motions)| {
        let comparison = compare(model, name, motions, horizon);
        horizon = Some(Horizon::from_seconds(comparison.horizon_s));
        comparison
    });
    compared.collect()
}

impl ModelRun {
    /// What the run says of the model; `name` stands for it in reports.
    pub fn comparison(&self, name: &str) -> Comparison {
        let mut comparison = self.at_its_horizon(name);
        let mut shorter = horizons(&self.model, &self.data, self.horizon);
        shorter.append(&mut comparison.horizons);
        comparison.horizons = shorter;
        comparison
    }

    /// The same without the errors over shorter runs, for each of which start states are fitted.
    pub fn at_its_horizon(&self, name: &str) -> Comparison {
        let ModelRun {
            model,
            data,
            horizon,
            ..
        } = self;
        let residuals = self.residuals();
        let signals = self.signals(&residuals);
        Comparison {
            model: name.to_string(),
            horizon_s: horizon.seconds(),
            windows: data.motion_windows(*horizon),
            unobserved: model.log.notes(),
            horizons: vec![HorizonError {
                quantity: data.quantity(),
                horizon_s: horizon.seconds(),
                rms: pooled(data, &residuals),
            }],
            failures: failing(model, data, &residuals, &signals)
                .into_iter()
                .map(|failing| failing.failure)
                .collect(),
            traces: traces(data, &self.predicted),
            closed_loop: None,
            signals,
        }
    }

    /// Conditions under which the model fails, worst first, with the samples that meet them.
    pub fn failing(&self) -> Vec<FailingSamples> {
        let residuals = self.residuals();
        let signals = self.signals(&residuals);
        failing(&self.model, &self.data, &residuals, &signals)
    }

    /// Root-mean-square error of each joint, all motions together, rad or rad/s.
    pub fn joint_rms(&self) -> Vec<f64> {
        let residuals = self.residuals();
        let joints = residuals.iter().take(self.data.joints());
        joints.map(|joint| rms(joint.iter())).collect()
    }

    fn signals(&self, residuals: &[Vec<Vec<f64>>]) -> Vec<SignalError> {
        let signals = residuals.iter().enumerate();
        signals
            .filter(|(index, _)| self.data.signals[*index] != MeasuredSignal::Nothing)
            .map(|(index, residual)| signal(&self.data, index, residual))
            .collect()
    }
}

/// Root-mean-square error of the joints that count together.
fn pooled(data: &FitProblem, residuals: &[Vec<Vec<f64>>]) -> f64 {
    let signals = residuals.iter().enumerate();
    let counted = signals.filter(|(signal, _)| data.counts(*signal));
    rms(counted.flat_map(|(_, motions)| motions))
}

/// Root-mean-square of what was measured.
fn rms<'a>(residuals: impl Iterator<Item = &'a Vec<f64>>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for e in residuals.flatten().filter(|e| e.is_finite()) {
        sum += e * e;
        count += 1.0;
    }
    if count > 0.0 {
        f64::sqrt(sum / count)
    } else {
        0.0
    }
}

fn signal(data: &FitProblem, index: usize, residual: &[Vec<f64>]) -> SignalError {
    let rms = rms(residual.iter());
    let floor = data.sigma[index];
    let motions = 0..data.motions.len();
    let measured: Vec<&[f64]> = motions.map(|motion| data.measured(motion, index)).collect();
    let errors = residual.iter().flatten().map(|e| e.abs());
    SignalError {
        joint: data.joint_of(index) + 1,
        quantity: data.signals[index],
        beside_angle: index >= data.joints(),
        rms,
        largest: errors.fold(0.0, f64::max),
        fit_percent: fit_percent(&measured, residual),
        floor,
        share_above_floor: share_above(rms, floor),
        tests: residual_tests(data, index, residual),
    }
}

/// Share of the mean squared error that the floor does not explain; 0 for a residual that is all
/// noise.
fn share_above(rms: f64, floor: f64) -> f64 {
    if rms > floor {
        1.0 - (floor / rms).powi(2)
    } else {
        0.0
    }
}

/// 100 (1 - |y - yhat| / |y - mean y|) over all motions together; not a number where nothing moves:
/// there a model that predicts nothing is as good as any.
pub fn fit_percent(measured: &[&[f64]], residual: &[Vec<f64>]) -> f64 {
    let values = || measured.iter().copied().flatten().filter(|y| y.is_finite());
    let mean = values().sum::<f64>() / values().count().max(1) as f64;
    let spread: f64 = values().map(|y| (y - mean).powi(2)).sum();
    let error: f64 = residual
        .iter()
        .flatten()
        .filter(|e| e.is_finite())
        .map(|e| e * e)
        .sum();
    if spread > 0.0 {
        100.0 * (1.0 - (error / spread).sqrt())
    } else {
        f64::NAN
    }
}

/// The error over ever longer runs, shorter than the horizon of the comparison.
fn horizons(model: &Model, data: &FitProblem, horizon: Horizon) -> Vec<HorizonError> {
    let longest = data.longest_s();
    let (mut time, mut intervals) = (0.0, 0.0);
    for motion in &data.motions {
        time += motion.duration_s();
        intervals += motion.len().saturating_sub(1) as f64;
    }
    let least_s = LEAST_SAMPLES * time / f64::max(intervals, 1.0);
    let limit_s = horizon.seconds().unwrap_or(longest).min(longest);
    LADDER_S
        .into_iter()
        .filter(|s| *s >= 0.99 * least_s && *s < 0.99 * limit_s)
        .map(|s| {
            let data = data.recut(Horizon::Seconds(s));
            let predicted = predicted(model, &data, &fit_start_states(model, &data).window_starts);
            let signals = 0..data.signals.len();
            let residuals: Vec<_> = signals.map(|s| residual(&data, &predicted, s)).collect();
            HorizonError {
                quantity: data.quantity(),
                horizon_s: Some(s),
                rms: pooled(&data, &residuals),
            }
        })
        .collect()
}

fn traces(data: &FitProblem, predicted: &[Vec<Vec<f64>>]) -> Vec<Trace> {
    let mut traces = Vec::new();
    for (index, predicted) in predicted.iter().enumerate() {
        let motion = &data.motions[index];
        let stride = motion.len().div_ceil(DRAWN).max(1);
        let later = data.windows_of(index).skip(1);
        let restarts_s: Vec<f64> = later
            .map(|(_, window)| motion.time_s[window.samples.start])
            .collect();
        for (signal, predicted) in predicted.iter().enumerate() {
            if data.signals[signal] == MeasuredSignal::Nothing {
                continue;
            }
            let measured = data.measured(index, signal);
            let error: Vec<f64> = measured.iter().zip(predicted).map(|(y, m)| y - m).collect();
            let drawn: Vec<usize> = (0..motion.len())
                .step_by(stride)
                .filter(|k| measured[*k].is_finite())
                .collect();
            let pick = |values: &[f64]| drawn.iter().map(|k| values[*k]).collect();
            traces.push(Trace {
                motion: motion.name.clone(),
                joint: data.joint_of(signal) + 1,
                quantity: data.signals[signal],
                rms: rms(std::iter::once(&error)),
                restarts_s: restarts_s.clone(),
                time_s: pick(&motion.time_s),
                measured: pick(measured),
                predicted: pick(predicted),
            });
        }
    }
    traces
}
