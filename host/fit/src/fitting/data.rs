//! Motions cut into windows, with the weight of each signal's residual.

mod signals;

use super::assumed::{AssumedStates, assumed};
use super::cut::{cut, cut_evenly};
use super::growth::stable_horizon;
use super::halt::Halt;
use super::horizon::{Horizon, Window};
use super::student::quantile_975;
use super::window_start::{StartGuess, WindowStart};
use super::windows::MotionWindow;
use crate::model::{MeasuredSignal, Model};
use crate::motion::Motion;
use crate::sim::{HiddenUnknown, Plant};
use rayon::prelude::*;
use std::collections::HashMap;

/// Measured motions ready to be fitted.
#[derive(Debug, Clone)]
pub struct FitProblem {
    /// The motions.
    pub motions: Vec<Motion>,
    /// Windows in the order of motions and time.
    pub windows: Vec<Window>,
    /// Per joint: what is measured of it. Behind the joints come the rates of those that have a
    /// sensor of rates beside the one of their angle.
    pub signals: Vec<MeasuredSignal>,
    /// Per signal: standard deviation of the measurement, rad, of a rate rad/s, by which residuals
    /// are divided.
    pub sigma: Vec<f64>,
    /// Per signal: standard error of that estimate; 0 where it is a known rounding.
    sigma_error: Vec<f64>,
    /// The joints of the signals behind those of the joints.
    rate_joints: Vec<usize>,
    /// Per motion: the longest windows in which start errors stay small.
    stable: Vec<Horizon>,
    /// Per motion: guessed states of the joints whose angle is not measured.
    assumed: Vec<AssumedStates>,
    /// What ends fits to these data before they are done.
    halt: Halt,
}

impl FitProblem {
    /// Cuts motions into windows as long as the horizon and each motion's own growth of errors
    /// allow; the noise is estimated from the motions and the declared resolution.
    pub fn new(model: &Model, motions: Vec<Motion>, horizon: Horizon) -> FitProblem {
        FitProblem::growing(model, motions, horizon, None)
    }

    /// The same of motions in which start errors grow as in those of `other`, one by one.
    pub fn growing_like(
        model: &Model,
        motions: Vec<Motion>,
        horizon: Horizon,
        other: &FitProblem,
    ) -> FitProblem {
        FitProblem::growing(model, motions, horizon, Some(&other.stable))
    }

    fn growing(
        model: &Model,
        motions: Vec<Motion>,
        horizon: Horizon,
        stable: Option<&[Horizon]>,
    ) -> FitProblem {
        let rate_joints = model.log.rate_joints();
        let motions = motions.into_iter();
        let motions: Vec<Motion> = motions.map(|m| m.with_rates(&rate_joints)).collect();
        let (signals, noise) = signals::of(model, &motions, &rate_joints);
        let sigma: Vec<f64> = noise.iter().map(|noise| noise.deviation).collect();
        let prepared = motions.par_iter().enumerate().map(|(index, motion)| {
            let assumed = assumed(model, &signals, &sigma, motion);
            let stable = match stable {
                Some(stable) => stable[index],
                None => stable_horizon(model, &sigma, &assumed, motion),
            };
            (stable, assumed)
        });
        let (stable, assumed): (Vec<Horizon>, Vec<AssumedStates>) = prepared.unzip();
        FitProblem {
            windows: cut(&motions, &stable, &sigma, horizon),
            motions,
            signals,
            sigma,
            sigma_error: noise.iter().map(|noise| noise.error).collect(),
            rate_joints,
            stable,
            assumed,
            halt: Halt::default(),
        }
    }

    /// The same data, all of whose runs this ends.
    pub fn halted_by(self, halt: &Halt) -> FitProblem {
        FitProblem {
            halt: halt.clone(),
            ..self
        }
    }

    /// What ends fits to these data.
    pub(crate) fn halt(&self) -> &Halt {
        &self.halt
    }

    /// The same motions with the weights of others: those that decide on a fit are weighted as
    /// those it was fitted to.
    pub fn weighted_like(self, other: &FitProblem) -> FitProblem {
        FitProblem {
            sigma: other.sigma.clone(),
            sigma_error: other.sigma_error.clone(),
            ..self
        }
    }

    /// The same motions and weights in the longest windows, up to the horizon, in which start
    /// errors stay small for this model, too; none where more than half as many are left.
    pub(super) fn lengthened(&self, model: &Model, horizon: Horizon) -> Option<FitProblem> {
        if self
            .stable
            .iter()
            .all(|own| own.shorter(horizon) == horizon)
        {
            return None;
        }
        let motions = self.motions.par_iter().zip(&self.assumed).zip(&self.stable);
        let stable: Vec<Horizon> = motions
            .map(|((motion, assumed), own)| {
                own.longer(stable_horizon(model, &self.sigma, assumed, motion))
            })
            .collect();
        let longer = FitProblem {
            windows: cut(&self.motions, &stable, &self.sigma, horizon),
            stable,
            ..self.clone()
        };
        (2 * longer.windows.len() <= self.windows.len()).then_some(longer)
    }

    /// The same motions and weights cut at another horizon.
    pub fn recut(&self, horizon: Horizon) -> FitProblem {
        FitProblem {
            windows: cut(&self.motions, &self.stable, &self.sigma, horizon),
            ..self.clone()
        }
    }

    /// The same cut at even places, whatever the samples there tell of a start: where windows are
    /// counted, each is to weigh alike.
    pub fn cut_evenly(&self, horizon: Horizon) -> FitProblem {
        FitProblem {
            windows: cut_evenly(&self.motions, &self.stable, horizon),
            ..self.clone()
        }
    }

    /// One of the motions, cut as it is here.
    pub fn only(&self, motion: usize) -> FitProblem {
        self.part(|m| m == motion)
    }

    /// The motions of both, with the weights of this one.
    pub fn joined(&self, other: &FitProblem) -> FitProblem {
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

    /// Some of the motions, cut as they are here.
    pub fn part(&self, wanted: impl Fn(usize) -> bool) -> FitProblem {
        let kept: Vec<usize> = (0..self.motions.len()).filter(|&m| wanted(m)).collect();
        let windows = kept.iter().enumerate().flat_map(|(index, &motion)| {
            self.windows_of(motion).map(move |(_, window)| Window {
                motion: index,
                samples: window.samples.clone(),
            })
        });
        FitProblem {
            windows: windows.collect(),
            motions: kept.iter().map(|&m| self.motions[m].clone()).collect(),
            signals: self.signals.clone(),
            sigma: self.sigma.clone(),
            sigma_error: self.sigma_error.clone(),
            rate_joints: self.rate_joints.clone(),
            stable: kept.iter().map(|&m| self.stable[m]).collect(),
            assumed: kept.iter().map(|&m| self.assumed[m].clone()).collect(),
            halt: self.halt.clone(),
        }
    }

    /// The same motions with so many of the windows, spread evenly over all, or all of fewer.
    pub fn with_windows(mut self, wanted: usize) -> FitProblem {
        let all = self.windows.len();
        if wanted < all {
            let kept = (0..wanted).map(|k| (2 * k + 1) * all / (2 * wanted));
            self.windows = kept.map(|at| self.windows[at].clone()).collect();
        }
        self
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

    /// What an error over all joints together is made of: angles and, 1 mm for 1 mrad,
    /// displacements; rates where neither is measured.
    pub fn quantity(&self) -> MeasuredSignal {
        MeasuredSignal::pooled(&self.signals)
    }

    /// Whether a signal counts in an error over all joints together.
    pub fn counts(&self, signal: usize) -> bool {
        self.signals[signal].counts_in(self.quantity())
    }

    /// What no reading tells of where a window of this model begins.
    pub(super) fn hidden(&self, model: &Model) -> Vec<HiddenUnknown> {
        let plant = self.motions.first().map(|motion| Plant::new(model, motion));
        plant.map_or(Vec::new(), |plant| plant.hidden().to_vec())
    }

    /// The start state that the samples around a window's start suggest.
    pub fn guessed(&self, window: &Window) -> WindowStart {
        self.guess(window).window_start
    }

    /// The same with how sure it is.
    pub(super) fn guess(&self, window: &Window) -> StartGuess {
        let (motion, assumed) = (&self.motions[window.motion], &self.assumed[window.motion]);
        StartGuess::of(motion, &self.sigma, assumed, window)
    }

    /// The start states of windows of `other`, the same motions cut otherwise, that begin where
    /// windows of this data do; elsewhere what the samples suggest.
    pub fn window_starts_from(
        &self,
        other: &FitProblem,
        window_starts: &[WindowStart],
    ) -> Vec<WindowStart> {
        let begins = |window: &Window| (window.motion, window.samples.start);
        let known: HashMap<(usize, usize), &WindowStart> = other
            .windows
            .iter()
            .map(begins)
            .zip(window_starts)
            .collect();
        let window_start = |window: &Window| match known.get(&begins(window)) {
            Some(&window_start) => window_start.clone(),
            None => self.guessed(window),
        };
        self.windows.iter().map(window_start).collect()
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
        let squares = self.pooled().map(|signal| self.sigma[signal].powi(2));
        (squares.sum::<f64>() / self.pooled().count().max(1) as f64).sqrt()
    }

    /// 95 % interval of the floor; none where it is the rounding of a known resolution.
    pub fn floor_interval(&self) -> Option<[f64; 2]> {
        let (floor, count) = (self.floor(), self.pooled().count() as f64);
        let moved = |signal: usize| self.sigma[signal] * self.sigma_error[signal] / (count * floor);
        let variance: f64 = self.pooled().map(|signal| moved(signal).powi(2)).sum();
        let reach = quantile_975(f64::INFINITY) * variance.sqrt();
        (reach > 0.0).then(|| [(floor - reach).max(0.0), floor + reach])
    }

    /// The signals whose errors are one figure.
    fn pooled(&self) -> impl Iterator<Item = usize> {
        (0..self.signals.len()).filter(|&signal| self.counts(signal))
    }
}
