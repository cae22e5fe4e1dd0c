//! What a closed-loop comparison found, as plain values.

use serde::Serialize;

/// A simulated closed loop against the measured one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClosedLoopComparison {
    /// Per joint, all motions together; limit cycles are means over motions without a fall.
    pub signals: Vec<LoopSignal>,
    /// Per motion.
    pub motions: Vec<LoopMotion>,
}

/// One motion in closed loop.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoopMotion {
    /// The motion.
    pub motion: String,
    /// Its length, s.
    pub duration_s: f64,
    /// When the measured robot fell, s after the first sample.
    pub measured_fell_s: Option<f64>,
    /// When the simulated robot fell, s.
    pub simulated_fell_s: Option<f64>,
    /// Per joint.
    pub signals: Vec<LoopSignal>,
}

/// One joint in closed loop. Angles are deviations from the pose that the plan holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoopSignal {
    /// Joint counted from 1.
    pub joint: usize,
    /// Root-mean-square difference of measured and simulated angle until one of them falls, rad.
    pub rms_error_rad: f64,
    /// Root-mean-square measured deviation until the fall, rad.
    pub measured_rms_rad: f64,
    /// Root-mean-square simulated deviation until the fall, rad.
    pub simulated_rms_rad: f64,
    /// Measured peak to peak over the last second (of a shorter motion, the last half), rad: the
    /// limit cycle. None after a fall.
    pub measured_limit_cycle_rad: Option<f64>,
    /// The same, simulated.
    pub simulated_limit_cycle_rad: Option<f64>,
}
