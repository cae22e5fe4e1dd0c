//! Predicted readings and weighted residuals of a model, window by window.

use super::data::FitProblem;
use super::window_start::WindowStart;
use crate::model::{MeasuredSignal, Model};
use crate::sim::{KnownRun, Plant, PlantMemory, predict, predict_beside};
use rayon::prelude::*;
use std::ops::Range;

/// Weighted residuals, (measured - predicted) / sigma; one vector per window, signal after signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Residuals {
    /// Per window: `signals * samples` values. A sample that was not measured counts 0.
    pub windows: Vec<Vec<f64>>,
    /// How many of the values were not measured.
    pub gaps: usize,
}

/// A prediction that diverges counts as this far off, rad (m) or rad/s, so that a fit can turn
/// back.
const DIVERGED_RAD: f64 = 10.0;
const DIVERGED_RAD_S: f64 = 100.0;

/// The largest weighted residual that counts.
pub(super) fn worst(signal: MeasuredSignal, sigma: f64) -> f64 {
    match signal {
        MeasuredSignal::Rate => DIVERGED_RAD_S / sigma,
        MeasuredSignal::Angle | MeasuredSignal::Displacement | MeasuredSignal::Nothing => {
            DIVERGED_RAD * (1.0 / sigma)
        }
    }
}

/// Measured less predicted over the noise, capped; 0 where nothing was measured.
pub(super) fn weighted(measured: f64, predicted: f64, sigma: f64, most: f64) -> f64 {
    match (measured.is_nan(), predicted.is_nan()) {
        (true, _) => 0.0,
        (false, true) => most,
        (false, false) => ((measured - predicted) * (1.0 / sigma)).clamp(-most, most),
    }
}

impl Residuals {
    /// Sum of squares.
    pub fn cost(&self) -> f64 {
        self.windows.iter().flatten().map(|r| r * r).sum()
    }

    /// Number of residuals: of samples that were measured.
    pub fn count(&self) -> usize {
        let all: usize = self.windows.iter().map(Vec::len).sum();
        all - self.gaps
    }

    /// Their difference, window by window.
    pub fn less(&self, other: &Residuals) -> Vec<Vec<f64>> {
        let windows = self.windows.iter().zip(&other.windows);
        let difference = windows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect());
        difference.collect()
    }

    /// Mean square; 1 is the noise.
    pub fn mean_square(&self) -> f64 {
        self.cost() / self.count().max(1) as f64
    }
}

/// Residuals of a model from these window starts, motions in parallel.
pub fn residuals(model: &Model, data: &FitProblem, window_starts: &[WindowStart]) -> Residuals {
    let per_motion: Vec<Vec<Vec<f64>>> = (0..data.motions.len())
        .into_par_iter()
        .map(|motion| motion_residuals(model, data, window_starts, motion))
        .collect();
    Residuals {
        gaps: data.gaps(),
        windows: per_motion.into_iter().flatten().collect(),
    }
}

/// What a model predicts for one motion's windows, in order, signal after signal: readings, rad,
/// and rates, rad/s, of joints whose rate alone is logged and of rate sensors beside an angle's.
/// Every window runs from its start, and the memory runs on from window to window.
pub fn predicted(
    model: &Model,
    data: &FitProblem,
    window_starts: &[WindowStart],
    motion: usize,
) -> Vec<Vec<f64>> {
    predicted_seen(model, data, window_starts, motion, |_| {})
}

/// The same, which shows what each window takes over from the one before; the first one that of
/// its first samples.
fn predicted_seen(
    model: &Model,
    data: &FitProblem,
    window_starts: &[WindowStart],
    motion: usize,
    mut sees: impl FnMut(&PlantMemory),
) -> Vec<Vec<f64>> {
    data.halt().begin_run();
    let log = &data.motions[motion];
    let plant = Plant::new(model, log);
    let mut memory = PlantMemory::default();
    let windows = data.windows_of(motion);
    windows
        .map(|(index, window)| {
            let samples = window.samples.clone();
            let mut readings = vec![0.0; samples.len() * plant.signals()];
            let start = window_starts[index].start(&plant);
            sees(&memory);
            memory.begin_with(window_starts[index].hidden(&plant));
            predict(&plant, log, samples, &start, &mut memory, &mut readings);
            readings
        })
        .collect()
}

/// What is hidden where each window begins, in the order of [`Plant::hidden`], as the window before
/// leaves it; where a motion begins, as it is a sample later.
pub(super) fn left_hidden(
    model: &Model,
    data: &FitProblem,
    window_starts: &[WindowStart],
) -> Vec<Vec<f64>> {
    let motions = (0..data.motions.len()).into_par_iter();
    let of_motion = |motion: usize| {
        let plant = Plant::new(model, &data.motions[motion]);
        let mut left = Vec::new();
        predicted_seen(model, data, window_starts, motion, |memory| {
            left.push(memory.hidden(&plant))
        });
        if let (Some((index, window)), Some(first)) =
            (data.windows_of(motion).next(), left.first_mut())
        {
            let (start, mut memory) = (window_starts[index].start(&plant), PlantMemory::default());
            let samples = window.samples.start..window.samples.end.min(window.samples.start + 2);
            let mut readings = vec![0.0; samples.len() * plant.signals()];
            predict(
                &plant,
                &data.motions[motion],
                samples,
                &start,
                &mut memory,
                &mut readings,
            );
            *first = memory.hidden(&plant);
        }
        // What is unknown of the motion is one thing in all of its windows.
        if let Some((first, others)) = left.split_first_mut() {
            for (k, unknown) in plant.hidden().iter().enumerate() {
                if unknown.quantity.is_of_motion() {
                    others.iter_mut().for_each(|left| left[k] = first[k]);
                }
            }
        }
        left
    };
    let left: Vec<Vec<Vec<f64>>> = motions.map(of_motion).collect();
    left.into_iter().flatten().collect()
}

/// Residuals of one motion's windows, in order.
pub(super) fn motion_residuals(
    model: &Model,
    data: &FitProblem,
    window_starts: &[WindowStart],
    motion: usize,
) -> Vec<Vec<f64>> {
    let predicted = predicted(model, data, window_starts, motion);
    weighted_windows(predicted, data, motion)
}

/// The same from starts next to those that left residuals which are known: as those are where the
/// start no longer shows.
pub(super) fn motion_residuals_beside(
    model: &Model,
    data: &FitProblem,
    window_starts: &[WindowStart],
    motion: usize,
    known: &Residuals,
) -> Vec<Vec<f64>> {
    let log = &data.motions[motion];
    let plant = Plant::new(model, log);
    if !plant.forgets_its_start() {
        return motion_residuals(model, data, window_starts, motion);
    }
    data.halt().begin_run();
    let near: Vec<f64> = data.sigma.iter().map(|sigma| MET * sigma).collect();
    let windows = data.windows_of(motion).map(|(index, window)| {
        let samples = window.samples.clone();
        let start = window_starts[index].start(&plant);
        let known = KnownRun {
            readings: &read_back(&known.windows[index], data, motion, samples.clone()),
            near: &near,
        };
        let mut readings = vec![0.0; samples.len() * plant.signals()];
        predict_beside(&plant, log, samples, &start, &known, &mut readings);
        readings
    });
    weighted_windows(windows.collect(), data, motion)
}

/// Readings that differ by no more than this share of the noise have met: a thousandth of the least
/// difference of a start.
const MET: f64 = 1e-4;

/// The predictions that left these residuals in a window; not a number where nothing was measured.
fn read_back(
    residuals: &[f64],
    data: &FitProblem,
    motion: usize,
    samples: Range<usize>,
) -> Vec<f64> {
    let signals = residuals.chunks(samples.len()).enumerate();
    let predicted = signals.flat_map(|(signal, residuals)| {
        let measured = &data.measured(motion, signal)[samples.clone()];
        let sigma = data.sigma[signal];
        let read = residuals.iter().zip(measured);
        read.map(move |(residual, measured)| measured - residual * sigma)
    });
    predicted.collect()
}

/// What is left of these predictions of one motion's windows.
fn weighted_windows(mut windows: Vec<Vec<f64>>, data: &FitProblem, motion: usize) -> Vec<Vec<f64>> {
    for (values, (_, window)) in windows.iter_mut().zip(data.windows_of(motion)) {
        for (signal, part) in values.chunks_mut(window.samples.len()).enumerate() {
            let measured = &data.measured(motion, signal)[window.samples.clone()];
            let sigma = data.sigma[signal];
            let most = worst(data.signals[signal], sigma);
            for (value, measured) in part.iter_mut().zip(measured) {
                *value = weighted(*measured, *value, sigma, most);
            }
        }
    }
    windows
}
