//! Motions cut into windows, with the weight of each joint's residual.

use super::growth::stable_horizon;
use super::noise::noise_rad;
use super::windows::MotionWindow;
use crate::log::Motion;
use crate::model::Model;
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
    /// Per joint: standard deviation of the measurement, rad, by which residuals are divided.
    pub sigma_rad: Vec<f64>,
    /// Per motion: the longest windows in which start errors stay small.
    stable: Vec<Horizon>,
}

impl FitData {
    /// Cuts motions into windows as long as the horizon and each motion's own growth of errors
    /// allow; the noise is estimated from the motions and the declared resolution.
    pub fn new(model: &Model, motions: Vec<Motion>, horizon: Horizon) -> FitData {
        let resolution = |joint: usize| model.log.joints[joint].position.resolution;
        let sigma_rad: Vec<f64> = (0..model.link_count())
            .map(|joint| noise_rad(&motions, joint, resolution(joint)))
            .collect();
        let stable = motions
            .par_iter()
            .map(|motion| stable_horizon(model, &sigma_rad, motion));
        let stable: Vec<Horizon> = stable.collect();
        FitData {
            windows: cut(&motions, &stable, horizon),
            motions,
            sigma_rad,
            stable,
        }
    }

    /// The same motions with the weights of others: those that decide on a fit are weighted as those
    /// it was fitted to.
    pub fn weighted_like(self, other: &FitData) -> FitData {
        FitData {
            sigma_rad: other.sigma_rad.clone(),
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
            sigma_rad: self.sigma_rad.clone(),
            stable: kept.iter().map(|&m| self.stable[m]).collect(),
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
        self.sigma_rad.len()
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

    /// Root-mean-square error that a perfect model would show, rad, all joints together.
    pub fn floor_rad(&self) -> f64 {
        let squares: f64 = self.sigma_rad.iter().map(|sigma| sigma * sigma).sum();
        (squares / self.joints().max(1) as f64).sqrt()
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
