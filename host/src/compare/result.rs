//! What a comparison found, as plain values for every writer.

use super::closed_loop::ClosedLoopComparison;
use crate::fitting::MotionWindow;
use serde::Serialize;

/// One model against a set of motions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Name of the model's file.
    pub model: String,
    /// Longest windows asked for, s; absent where none were.
    pub horizon_s: Option<f64>,
    /// How long the windows of each motion are: no longer than its start errors stay small.
    pub windows: Vec<MotionWindow>,
    /// Per joint, all motions together.
    pub signals: Vec<SignalError>,
    /// How the error grows with the time the model runs without correction, all joints together.
    pub horizons: Vec<HorizonError>,
    /// Conditions under which the model fails, worst first.
    pub failures: Vec<Failure>,
    /// Measured and predicted signals, thinned for drawing.
    pub traces: Vec<Trace>,
    /// The closed loop against the measured one, where the controller is known.
    pub closed_loop: Option<ClosedLoopComparison>,
}

/// Error of one joint's position.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SignalError {
    /// Joint counted from 1.
    pub joint: usize,
    /// Root-mean-square error, rad.
    pub rms_rad: f64,
    /// Largest error, rad.
    pub largest_rad: f64,
    /// 100 (1 - |y - yhat| / |y - mean y|), as MATLAB's `compare` defines it; 100 is perfect.
    pub fit_percent: f64,
    /// What resolution and noise alone leave, rad.
    pub floor_rad: f64,
    /// Share of the squared error above the floor, 0 to 1.
    pub share_above_floor: f64,
    /// Tests of what is left.
    pub tests: Vec<ResidualTest>,
}

/// A test of the residual at 99 %.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResidualTest {
    /// Its name: "whiteness (Ljung-Box)", ...
    pub name: &'static str,
    /// Statistic.
    pub statistic: f64,
    /// Value it may not exceed.
    pub threshold: f64,
    /// Whether the residual passes.
    pub passed: bool,
    /// What that means, in a sentence.
    pub meaning: String,
}

/// Error when the model starts afresh every `horizon_s`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HorizonError {
    /// Window length, s; absent for whole motions.
    pub horizon_s: Option<f64>,
    /// Root-mean-square error, rad.
    pub rms_rad: f64,
}

/// A condition that holds more than its share of the error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Failure {
    /// Joint counted from 1.
    pub joint: usize,
    /// The condition in words: "within 80 ms after a reversal".
    pub condition: String,
    /// Its share of the squared error above the floor, 0 to 1.
    pub error_share: f64,
    /// Its share of the samples, 0 to 1.
    pub sample_share: f64,
    /// The whole sentence, with numbers.
    pub sentence: String,
}

/// One joint of one motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trace {
    /// The motion.
    pub motion: String,
    /// Joint counted from 1.
    pub joint: usize,
    /// Root-mean-square error of this motion, rad.
    pub rms_rad: f64,
    /// Sample times, s.
    pub time_s: Vec<f64>,
    /// Measured, rad.
    pub measured_rad: Vec<f64>,
    /// Predicted, rad.
    pub predicted_rad: Vec<f64>,
}

impl Comparison {
    /// The model's name and its closed loop, where the controller is known.
    pub(crate) fn named_loop(&self) -> Option<(&str, &ClosedLoopComparison)> {
        Some((self.model.as_str(), self.closed_loop.as_ref()?))
    }
}
