//! How much of the motion a model leaves unexplained, on a scale that knows no unit.
//!
//! An error in rad cannot rank two readings of one log: read in degrees, every angle and every
//! error is 57 times smaller. The error is therefore divided by that of the plainest prediction,
//! each joint going on at the speed it starts a window with; of a rate beside an angle, none.

use super::trial::Effort;
use crate::fitting::{
    FitOptions, FitProblem, Horizon, Window, WindowStart, fit, free_parameters,
    guessed_window_starts, predicted,
};
use crate::model::{MeasuredSignal, Model};
use crate::motion::Motion;

/// Longest window, s, and least samples of one where samples are rare.
const WINDOW_S: f64 = 1.0;
const WINDOW_SAMPLES: f64 = 12.0;
/// Iterations of a fit; it is compared, not used.
const ITERATIONS: usize = 8;
/// Those of one that decides whether something else explains as much.
const TO_THE_END: usize = 25;
/// An error counts as at most this many times the plain prediction's.
const MOST: f64 = 2.0;
/// A signal whose movement beyond the plain prediction is less than this many times its noise says
/// nothing.
const LEAST_MOVEMENT: f64 = 5.0;

/// A model with the motions as it reads them.
pub(super) struct ModelReading {
    pub model: Model,
    pub data: FitProblem,
}

impl ModelReading {
    /// Cut into windows of a second, or shorter where start errors grow fast.
    pub fn new(model: Model, motions: Vec<Motion>) -> ModelReading {
        let horizon_s = longest_s(&motions);
        ModelReading::cut(model, motions, horizon_s)
    }

    /// The same of motions in which start errors grow as in another reading's, one by one.
    pub fn growing_like(&self, model: Model, motions: Vec<Motion>) -> ModelReading {
        let horizon = Horizon::Seconds(longest_s(&motions));
        let data = FitProblem::growing_like(&model, motions, horizon, &self.data);
        ModelReading {
            data: data.cut_evenly(horizon),
            model,
        }
    }

    /// Cut evenly into windows of so many seconds, or shorter where start errors grow fast.
    pub fn cut(model: Model, motions: Vec<Motion>, horizon_s: f64) -> ModelReading {
        let horizon = Horizon::Seconds(horizon_s);
        ModelReading {
            data: FitProblem::new(&model, motions, horizon).cut_evenly(horizon),
            model,
        }
    }

    /// The same model and motions, cut as other data of as many samples are.
    pub fn cut_as(&self, windows: &[Window]) -> ModelReading {
        let mut data = self.data.clone();
        data.windows = windows.to_vec();
        ModelReading {
            model: self.model.clone(),
            data,
        }
    }

    /// The windows of whichever reading has shorter ones, motion by motion.
    pub fn common_windows(&self, other: &ModelReading) -> Vec<Window> {
        let motions = 0..self.data.motions.len();
        let shorter = |motion: usize| {
            let pieces = |data: &FitProblem| data.windows_of(motion).count();
            let data = if pieces(&self.data) >= pieces(&other.data) {
                &self.data
            } else {
                &other.data
            };
            data.windows_of(motion)
                .map(|(_, window)| window.clone())
                .collect::<Vec<_>>()
        };
        motions.flat_map(shorter).collect()
    }

    /// Another model that reads the same samples in its own way, cut into the same windows.
    pub fn read_as(&self, model: &Model, motions: Vec<Motion>) -> ModelReading {
        ModelReading {
            model: model.clone(),
            data: self.data.clone().measured_in(motions),
        }
    }

    /// Rated with what the effort fits.
    pub fn rated(&self, effort: Effort) -> Rating {
        self.fitted(effort).0
    }

    /// Rated with what the effort fits, and the model at the fitted values.
    pub fn fitted(&self, effort: Effort) -> (Rating, Model) {
        let free = || free_parameters(&self.model, &[]).unwrap_or_default();
        let rough = FitOptions::iterations(ITERATIONS).rough();
        let (free, options) = match effort {
            Effort::Guess => {
                let window_starts = guessed_window_starts(&self.data);
                let rating = Rating::of(&self.model, &self.data, &window_starts);
                return (rating, self.model.clone());
            }
            Effort::Starts => (Vec::new(), rough),
            Effort::Values => (free(), rough),
            Effort::ValuesToTheEnd => (free(), FitOptions::iterations(TO_THE_END)),
        };
        let fitted = fit(&self.model, &free, &self.data, None, options);
        let rating = Rating::of(&fitted.model, &self.data, &fitted.window_starts);
        (rating, fitted.model)
    }
}

/// The longest window of motions, s.
fn longest_s(motions: &[Motion]) -> f64 {
    let samples: usize = motions.iter().map(Motion::len).sum();
    let seconds: f64 = motions.iter().map(Motion::duration_s).sum();
    WINDOW_S.max(WINDOW_SAMPLES * seconds / samples.max(1) as f64)
}

/// Error of a model, window by window.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rating {
    /// Per window, per signal: error over the signal's plain prediction's, at most 2; none where
    /// the signal says nothing.
    pub shares: Vec<Vec<Option<f64>>>,
    /// Root-mean-square error, rad, over all joints.
    pub rms_rad: f64,
}

impl Rating {
    fn of(model: &Model, data: &FitProblem, window_starts: &[WindowStart]) -> Rating {
        let (joints, signals) = (data.joints(), data.signals.len());
        let mut squares = vec![vec![0.0; signals]; data.windows.len()];
        let mut plain = vec![0.0; signals];
        let guesses = guessed_window_starts(data);
        let (mut sum, mut count) = (0.0, 0usize);
        for motion in 0..data.motions.len() {
            let predicted = predicted(model, data, window_starts, motion);
            let windows = data.windows_of(motion);
            for ((index, window), predicted) in windows.zip(predicted) {
                let log = &data.motions[motion];
                let start_s = log.time_s[window.samples.start];
                let samples = window.samples.len();
                for signal in 0..signals {
                    let guess = &guesses[index].unknowns;
                    let (rate, beside) = (
                        data.signals[signal] == MeasuredSignal::Rate,
                        signal >= joints,
                    );
                    for (k, sample) in window.samples.clone().enumerate() {
                        let measured = data.measured(motion, signal)[sample];
                        if !measured.is_finite() {
                            continue;
                        }
                        let seconds = log.time_s[sample] - start_s;
                        let straight = match rate {
                            true if beside => 0.0,
                            true => guess[joints + signal],
                            false => guess[signal] + guess[joints + signal] * seconds,
                        };
                        let error = measured - predicted[signal * samples + k];
                        let error = if error.is_finite() {
                            error.clamp(-1e3, 1e3)
                        } else {
                            1e3
                        };
                        plain[signal] += (measured - straight).powi(2);
                        squares[index][signal] += error * error / samples as f64;
                        if !beside {
                            sum += error * error;
                            count += 1;
                        }
                    }
                }
            }
        }
        let all = data.samples().max(1) as f64;
        let plain: Vec<f64> = plain.iter().map(|sum| (sum / all).sqrt()).collect();
        let says = |signal: &usize| plain[*signal] > LEAST_MOVEMENT * data.sigma[*signal];
        let share = |squares: &Vec<f64>| {
            let share = |signal: usize| (squares[signal].sqrt() / plain[signal]).min(MOST);
            let signals = 0..signals;
            signals
                .map(|signal| says(&signal).then(|| share(signal)))
                .collect()
        };
        Rating {
            shares: squares.iter().map(share).collect(),
            rms_rad: (sum / count.max(1) as f64).sqrt(),
        }
    }

    /// Root mean square of all shares: 0 where all is explained, 1 where the model does as badly as
    /// going on at constant speed; none where no joint says anything.
    pub fn share(&self) -> Option<f64> {
        root_mean_square(self.shares.iter().flatten().flatten())
    }

    /// The same of one joint alone.
    pub fn share_of(&self, joint: usize) -> Option<f64> {
        let own = self.shares.iter().map(|shares| shares.get(joint));
        root_mean_square(own.flatten().flatten())
    }
}

fn root_mean_square<'a>(shares: impl Iterator<Item = &'a f64> + Clone) -> Option<f64> {
    let count = shares.clone().count();
    let squares: f64 = shares.map(|share| share * share).sum();
    (count > 0).then(|| (squares / count as f64).sqrt())
}
