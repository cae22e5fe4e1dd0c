//! What a design is asked for.

use super::quantise::Format;
use super::weight::Weight;
use crate::model::{Model, upright};
use crate::sim::closed_loop::Velocity;

/// What is asked for.
#[derive(Debug, Clone)]
pub struct Request {
    /// Angles in the model's own convention, rad.
    pub pose_rad: Vec<f64>,
    /// Weight of the states.
    pub q: Weight,
    /// Weight of the inputs.
    pub r: Weight,
    /// Weight of the sums of the driven joints' angles, where the law shall have them, 1/(rad s)^2.
    pub integral: Option<Weight>,
    /// How the gains will run.
    pub time: Time,
    /// Sensors and noise, for an estimator.
    pub sensors: Option<Sensors>,
    /// What a law without an estimator is given in the simulated loop.
    pub readings: Readings,
    /// Largest departure of the states, SI; of the plant's own states.
    pub state_range: Weight,
    /// Largest inputs, SI; from the drives where not given.
    pub input_range: Option<Weight>,
    /// Words of the fixed-point law.
    pub format: Format,
}

impl Request {
    /// Upright; Q = 100 I, R = I; every 10 ms, the inputs as late as the model has them; departures
    /// within 0.5 rad and 10 rad/s; words of 16 bits.
    pub fn standard(model: &Model) -> Request {
        let joints = model.link_count();
        Request {
            pose_rad: upright(model),
            q: Weight::Scalar(100.0),
            r: Weight::Scalar(1.0),
            integral: None,
            time: Time::Sampled {
                ts_s: 0.01,
                delay_s: None,
            },
            sensors: None,
            readings: Readings::default(),
            state_range: Weight::Diagonal([vec![0.5; joints], vec![10.0; joints]].concat()),
            input_range: None,
            format: Format {
                bits: 16,
                state_step: None,
                input_step: None,
            },
        }
    }
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

/// How the states of a law without an estimator are measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Readings {
    /// Step of the angles, rad; without it the coarsest `resolution_rad` of the model's positions.
    pub position_step_rad: Option<f64>,
    /// Where the speeds come from.
    pub speeds: Velocity,
}

impl Default for Readings {
    fn default() -> Self {
        Readings {
            position_step_rad: None,
            speeds: Velocity::Direct,
        }
    }
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
    /// Loop transfer recovery: the filter is designed as if the inputs erred by so large a share of
    /// their ranges, too (standard deviation); 0 is the filter of least variance.
    pub recovery: f64,
}
