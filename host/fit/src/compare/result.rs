//! What a comparison found, as plain values for every writer.

use super::closed_loop::ClosedLoopComparison;
use crate::fitting::MotionWindow;
use crate::model::MeasuredSignal;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// One model against a set of motions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Name of the model's file.
    pub model: String,
    /// Longest windows asked for, s; absent where none were.
    pub horizon_s: Option<f64>,
    /// How long the windows of each motion are: no longer than its start errors stay small.
    pub windows: Vec<MotionWindow>,
    /// What the logs cannot observe of the joints' motion, a sentence each.
    pub unobserved: Vec<String>,
    /// Per measured joint, then per rate sensor beside the one of an angle, all motions together.
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

/// Error of one joint's angle, rad, or of its rate where no angle is measured, or where a sensor of
/// its own measures it beside the angle, rad/s. Keys of JSON end in the unit: `rms_rad`,
/// `rms_rad_s`.
#[derive(Debug, Clone, PartialEq)]
pub struct SignalError {
    /// Joint counted from 1.
    pub joint: usize,
    /// What is measured of it.
    pub quantity: MeasuredSignal,
    /// Whether it is the rate of a joint whose angle is measured, too.
    pub beside_angle: bool,
    /// Root-mean-square error.
    pub rms: f64,
    /// Largest error.
    pub largest: f64,
    /// 100 (1 - |y - yhat| / |y - mean y|), as MATLAB's `compare` defines it; 100 is perfect, not a
    /// number where nothing moves.
    pub fit_percent: f64,
    /// What resolution and noise alone leave.
    pub floor: f64,
    /// Share of the squared error above the floor, 0 to 1.
    pub share_above_floor: f64,
    /// Tests of what is left.
    pub tests: Vec<ResidualTest>,
}

impl SignalError {
    /// "1", "1, rate": the joint, and that its rate is meant where its angle is measured, too.
    pub fn label(&self) -> String {
        let of_rate = if self.beside_angle { ", rate" } else { "" };
        format!("{}{of_rate}", self.joint)
    }
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

/// Error when the model starts afresh every `horizon_s`, of all joints with a measured angle, rad,
/// or of the rates where no angle is measured, rad/s.
#[derive(Debug, Clone, PartialEq)]
pub struct HorizonError {
    /// What it is an error of.
    pub quantity: MeasuredSignal,
    /// Window length, s; absent for whole motions.
    pub horizon_s: Option<f64>,
    /// Root-mean-square error.
    pub rms: f64,
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

/// One joint of one motion: its angle, rad, or its rate where no angle is measured, or where a
/// sensor of its own measures it beside the angle, rad/s.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// The motion.
    pub motion: String,
    /// Joint counted from 1.
    pub joint: usize,
    /// What is measured of it.
    pub quantity: MeasuredSignal,
    /// Root-mean-square error of this motion.
    pub rms: f64,
    /// Where the model restarts from a fitted state: the windows but the first, s.
    pub restarts_s: Vec<f64>,
    /// Sample times, s.
    pub time_s: Vec<f64>,
    /// Measured.
    pub measured: Vec<f64>,
    /// Predicted.
    pub predicted: Vec<f64>,
}

/// The key of a quantity: its name and its unit.
fn key(name: &str, quantity: MeasuredSignal) -> String {
    format!("{name}{}", quantity.suffix())
}

impl Serialize for SignalError {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("joint", &self.joint)?;
        map.serialize_entry(&key("rms", self.quantity), &self.rms)?;
        map.serialize_entry(&key("largest", self.quantity), &self.largest)?;
        map.serialize_entry("fit_percent", &self.fit_percent)?;
        map.serialize_entry(&key("floor", self.quantity), &self.floor)?;
        map.serialize_entry("share_above_floor", &self.share_above_floor)?;
        map.serialize_entry("tests", &self.tests)?;
        map.end()
    }
}

impl Serialize for HorizonError {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("horizon_s", &self.horizon_s)?;
        map.serialize_entry(&key("rms", self.quantity), &self.rms)?;
        map.end()
    }
}

impl Serialize for Trace {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("motion", &self.motion)?;
        map.serialize_entry("joint", &self.joint)?;
        map.serialize_entry(&key("rms", self.quantity), &self.rms)?;
        map.serialize_entry("restarts_s", &self.restarts_s)?;
        map.serialize_entry("time_s", &self.time_s)?;
        map.serialize_entry(&key("measured", self.quantity), &self.measured)?;
        map.serialize_entry(&key("predicted", self.quantity), &self.predicted)?;
        map.end()
    }
}

impl Comparison {
    /// The signals whose errors can be pooled: angles and, 1 mm for 1 mrad, displacements; rates
    /// where neither is measured.
    pub fn pooled(&self) -> impl Iterator<Item = &SignalError> {
        let quantity = self.quantity();
        let signals = self.signals.iter();
        signals.filter(move |s| s.quantity.counts_in(quantity))
    }

    /// Root-mean-square of an error over them; they share their samples.
    pub fn pooled_rms(&self, of: fn(&SignalError) -> f64) -> f64 {
        let squares: f64 = self.pooled().map(|signal| of(signal).powi(2)).sum();
        (squares / self.pooled().count().max(1) as f64).sqrt()
    }

    /// What errors over all joints are of.
    pub fn quantity(&self) -> MeasuredSignal {
        let signals: Vec<MeasuredSignal> = self.signals.iter().map(|s| s.quantity).collect();
        if signals.is_empty() {
            MeasuredSignal::Angle
        } else {
            MeasuredSignal::pooled(&signals)
        }
    }

    /// The model's name and its closed loop, where the controller is known.
    pub fn named_loop(&self) -> Option<(&str, &ClosedLoopComparison)> {
        Some((self.model.as_str(), self.closed_loop.as_ref()?))
    }
}
