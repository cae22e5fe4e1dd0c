//! What a design is asked for.

use super::quantise::Format;
use super::weight::Weight;

/// What is asked for.
#[derive(Debug, Clone)]
pub struct Request {
    /// Angles in the model's own convention, rad.
    pub pose_rad: Vec<f64>,
    /// Weight of the states.
    pub q: Weight,
    /// Weight of the inputs.
    pub r: Weight,
    /// How the gains will run.
    pub time: Time,
    /// Sensors and noise, for an estimator.
    pub sensors: Option<Sensors>,
    /// Largest departure of the states, SI; of the plant's own states.
    pub state_range: Weight,
    /// Largest inputs, SI; from the drives where not given.
    pub input_range: Option<Weight>,
    /// Words of the fixed-point law.
    pub format: Format,
}

/// In which time the controller runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Time {
    /// All the time.
    Continuous,
    /// Every `ts_s`, its inputs `delay_s` late: the model's own delay where not given.
    Sampled {
        /// Sampling time, s.
        ts_s: f64,
        /// Delay of the inputs, s.
        delay_s: Option<f64>,
    },
}

/// What is measured: every angle, and the first link's angular velocity by a gyro.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensors {
    /// Step of the angles, rad.
    pub position_step_rad: f64,
    /// Step of the gyro, rad/s.
    pub gyro_step_rad_s: f64,
    /// Covariance of the process noise; without it, that of inputs that err by a hundredth of their
    /// range.
    pub process: Option<Weight>,
}
