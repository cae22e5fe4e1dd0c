//! Motions cut into windows, with the weight of each joint's residual.

use super::assumed::{AssumedStates, assumed};
use super::growth::stable_horizon;
use super::node::{Node, StartGuess};
use super::noise::noise;
use super::windows::MotionWindow;
use crate::log::Motion;
use crate::model::{ColumnMean, MeasuredSignal, Model};
use rayon::prelude::*;
use std::ops::Range;

/// How long the model runs at most before it starts again from a state fitted to the measurement.
/// Where start errors grow fast, it starts again earlier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Horizon {
    /// From the first sample of a motion to the last where that motion is stable: free run.
    Whole,
    /// Windows of about this many seconds, or shorter: multiple shooting.
    Seconds(f64),
}

impl Horizon {
    /// Length of a window, s; absent for whole motions.
    pub fn seconds(self) -> Option<f64> {
        match self {
            Horizon::Whole => None,
            Horizon::Seconds(seconds) => Some(seconds),
        }
    }

    /// Windows of this many seconds; whole motions without.
    pub fn from_seconds(seconds: Option<f64>) -> Self {
        seconds.map_or(Horizon::Whole, Horizon::Seconds)
    }

    /// The shorter of two.
    pub fn shorter(self, other: Horizon) -> Self {
        let seconds = [self, other].into_iter().filter_map(Horizon::seconds);
        Horizon::from_seconds(seconds.min_by(f64::total_cmp))
    }
}

/// A stretch of one motion that is simulated without a restart.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Index of the motion.
    pub motion: usize,
    /// Its samples.
    pub samples: Range<usize>,
}

/// Measured motions ready to be fitted.
#[derive(Debug, Clone)]
pub struct FitData {
    /// The motions.
    pub motions: Vec<Motion>,
    /// Windows in the order of motions and time.
    pub windows: Vec<Window>,
    /// Per joint: what is measured of it.
    pub signals: Vec<MeasuredSignal>,
    /// Per joint: standard deviation of the measurement, rad, of a rate rad/s, by which residuals
    /// are divided.
    pub sigma: Vec<f64>,
    /// Per motion: the longest windows in which start errors stay small.
    stable: Vec<Horizon>,
    /// Per motion: guessed states of the joints whose angle is not measured.
    assumed: Vec<AssumedStates>,
}

/// Stands for the noise of a joint of which nothing is measured.
const NO_NOISE: f64 = 1e-3;

impl FitData {
    /// Cuts motions into windows as long as the horizon and each motion's own growth of errors
    /// allow; the noise is estimated from the motions and the declared resolution.
    pub fn new(model: &Model, motions: Vec<Motion>, horizon: Horizon) -> FitData {
        let columns = model.log.joints.iter();
        let signals: Vec<MeasuredSignal> = columns.map(|columns| columns.signal()).collect();
        let sigma: Vec<f64> = (0..model.link_count())
            .map(|joint| match signals[joint] {
                MeasuredSignal::Nothing => NO_NOISE,
                signal => {
                    let columns = model.log.joints[joint].measured();
                    let resolution = columns.and_then(ColumnMean::resolution);
                    noise(&motions, joint, signal, resolution)
                }
            })
            .collect();
        let prepared = motions.par_iter().map(|motion| {
            let assumed = assumed(model, &signals, &sigma, motion);
            (stable_horizon(model, &sigma, &assumed, motion), assumed)
        });
        let (stable, assumed): (Vec<Horizon>, Vec<AssumedStates>) = prepared.unzip();
        FitData {
            windows: cut(&motions, &stable, horizon),
            motions,
            signals,
            sigma,
            stable,
            assumed,
        }
    }

    /// The same motions with the weights of others: those that decide on a fit are weighted as
    /// those it was fitted to.
    pub fn weighted_like(self, other: &FitData) -> FitData {
        FitData {
            sigma: other.sigma.clone(),
            ..self
        }
    }

    /// The same motions and weights cut at another horizon.
    pub fn recut(&self, horizon: Horizon) -> FitData {
        FitData {
            windows: cut(&self.motions, &self.stable, horizon),
            ..self.clone()
        }
    }

    /// One of the motions, cut as it is here.
    pub fn only(&self, motion: usize) -> FitData {
        self.part(|m| m == motion)
    }

    /// The motions of both, with the weights of this one.
    pub fn joined(&self, other: &FitData) -> FitData {
        let mut joined = self.clone();
        let moved = other.windows.iter().map(|window| Window {
            motion: window.motion + self.motions.len(),
            samples: window.samples.clone(),
        });
        joined.windows.extend(moved);
        joined.motions.extend(other.motions.iter().cloned());
        joined.stable.extend(&other.stable);
        joined.assumed.extend(other.assumed.iter().cloned());
        joined
    }

    /// The same windows with other readings in place of the measured ones, rad: per motion and
    /// window, joint after joint. What was not measured stays so.
    pub fn measuring(mut self, readings: &[Vec<Vec<f64>>]) -> FitData {
        for (motion, readings) in readings.iter().enumerate() {
            let windows: Vec<Range<usize>> = self
                .windows_of(motion)
                .map(|(_, window)| window.samples.clone())
                .collect();
            for (samples, readings) in windows.into_iter().zip(readings) {
                let joints = readings.chunks(samples.len());
                for (position, readings) in self.motions[motion].position_rad.iter_mut().zip(joints)
                {
                    let measured = position[samples.clone()].iter_mut().zip(readings);
                    for (position, reading) in measured.filter(|(p, _)| !p.is_nan()) {
                        *position = *reading;
                    }
                }
            }
        }
        self
    }

    /// Some of the motions, cut as they are here.
    pub fn part(&self, wanted: impl Fn(usize) -> bool) -> FitData {
        let kept: Vec<usize> = (0..self.motions.len()).filter(|&m| wanted(m)).collect();
        let windows = kept.iter().enumerate().flat_map(|(index, &motion)| {
            self.windows_of(motion).map(move |(_, window)| Window {
                motion: index,
                samples: window.samples.clone(),
            })
        });
        FitData {
            windows: windows.collect(),
            motions: kept.iter().map(|&m| self.motions[m].clone()).collect(),
            signals: self.signals.clone(),
            sigma: self.sigma.clone(),
            stable: kept.iter().map(|&m| self.stable[m]).collect(),
            assumed: kept.iter().map(|&m| self.assumed[m].clone()).collect(),
        }
    }

    /// How long the windows of each motion are at this horizon.
    pub fn motion_windows(&self, horizon: Horizon) -> Vec<MotionWindow> {
        let motions = self.motions.iter().zip(&self.stable);
        let windows = motions.map(|(motion, stable)| {
            let seconds = stable.shorter(horizon).seconds();
            MotionWindow {
                motion: motion.name.clone(),
                window_s: seconds.filter(|s| *s < motion.duration_s()),
            }
        });
        windows.collect()
    }

    /// The windows of one motion with their indices, in order of time.
    pub fn windows_of(&self, motion: usize) -> impl Iterator<Item = (usize, &Window)> {
        let windows = self.windows.iter().enumerate();
        windows.filter(move |(_, window)| window.motion == motion)
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.sigma.len()
    }

    /// What is measured of a joint in a motion, rad, of a rate rad/s; not a number in gaps.
    pub fn measured(&self, motion: usize, joint: usize) -> &[f64] {
        self.motions[motion].measured(joint, self.signals[joint])
    }

    /// How many samples of joints in all windows were not measured.
    pub fn gaps(&self) -> usize {
        let of_window = |window: &Window| {
            let gaps = |joint: usize| {
                let values = &self.measured(window.motion, joint)[window.samples.clone()];
                values.iter().filter(|value| value.is_nan()).count()
            };
            (0..self.joints()).map(gaps).sum::<usize>()
        };
        self.windows.iter().map(of_window).sum()
    }

    /// What an error over all joints together is made of: angles and, 1 mm for 1 mrad,
    /// displacements; rates where neither is measured.
    pub fn quantity(&self) -> MeasuredSignal {
        MeasuredSignal::pooled(&self.signals)
    }

    /// Whether a joint counts in an error over all joints together.
    pub fn counts(&self, joint: usize) -> bool {
        self.signals[joint].counts_in(self.quantity())
    }

    /// The start state that the samples around a window's start suggest.
    pub fn guessed(&self, window: &Window) -> Node {
        self.guess(window).node
    }

    /// The same with how sure it is.
    pub(super) fn guess(&self, window: &Window) -> StartGuess {
        let (motion, assumed) = (&self.motions[window.motion], &self.assumed[window.motion]);
        StartGuess::of(motion, &self.sigma, assumed, window)
    }

    /// Number of samples in all windows.
    pub fn samples(&self) -> usize {
        self.windows.iter().map(|w| w.samples.len()).sum()
    }

    /// Duration of the longest window, s.
    pub fn longest_window_s(&self) -> f64 {
        let seconds = |window: &Window| {
            let time = &self.motions[window.motion].time_s[window.samples.clone()];
            time.last()
                .zip(time.first())
                .map_or(0.0, |(end, begin)| end - begin)
        };
        self.windows.iter().map(seconds).fold(0.0, f64::max)
    }

    /// Duration of the longest motion, s.
    pub fn longest_s(&self) -> f64 {
        let durations = self.motions.iter().map(Motion::duration_s);
        durations.fold(0.0, f64::max)
    }

    /// Root-mean-square error that a perfect model would show, rad, all joints together; rad/s
    /// where no angle is measured.
    pub fn floor(&self) -> f64 {
        let joints = (0..self.joints()).filter(|&joint| self.counts(joint));
        let (mut squares, mut count) = (0.0, 0);
        for joint in joints {
            squares += self.sigma[joint] * self.sigma[joint];
            count += 1;
        }
        (squares / f64::from(count.max(1))).sqrt()
    }
}

fn cut(motions: &[Motion], stable: &[Horizon], horizon: Horizon) -> Vec<Window> {
    let mut windows = Vec::new();
    for (motion, (log, stable)) in motions.iter().zip(stable).enumerate() {
        let pieces = match stable.shorter(horizon) {
            Horizon::Whole => 1,
            Horizon::Seconds(seconds) => {
                let most = (log.len() / 5).max(1);
                ((log.duration_s() / seconds).round() as usize).clamp(1, most)
            }
        };
        let edge = |piece: usize| piece * log.len() / pieces;
        windows.extend((0..pieces).map(|piece| Window {
            motion,
            samples: edge(piece)..edge(piece + 1),
        }));
    }
    windows
}
