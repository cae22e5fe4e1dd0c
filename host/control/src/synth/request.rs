//! What a design is asked for.

use super::cost_weights::CostWeights;
use super::error::DesignError;
use super::linearise::linearise;
use super::quantise::{Format, positive};
use super::signal::{Signal, default_limit, input};
use super::weight::Weight;
use crate::model::{Model, default_pose};
use crate::sim::closed_loop::Velocity;

/// What is asked for.
#[derive(Debug, Clone)]
pub struct Request {
    /// Angles in the model's own convention, rad.
    pub pose_rad: Vec<f64>,
    /// Weights of states and inputs.
    pub weights: CostWeights,
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
    /// At the [`default_pose`]; weights by Bryson's rule; every 10 ms, the inputs as late as the
    /// model has them; departures within 0.5 rad and 10 rad/s; words of 16 bits.
    pub fn standard(model: &Model) -> Request {
        let joints = model.link_count();
        Request {
            pose_rad: default_pose(model),
            weights: CostWeights::BRYSON,
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

    /// Q and R for `model`, as two weights.
    ///
    /// # Errors
    /// Ranges for another number of states or inputs; a pose that nothing holds.
    pub fn weights_for(&self, model: &Model) -> Result<[Weight; 2], DesignError> {
        let states = self.state_ranges(2 * model.link_count())?;
        let held = linearise(model, &self.pose_rad)?.inputs;
        let inputs = self.input_ranges(model, &held)?;
        Ok(self.weights.resolved(&states, &inputs))
    }

    /// Largest departures of so many states, SI.
    pub(super) fn state_ranges(&self, states: usize) -> Result<Vec<f64>, DesignError> {
        let ranges = self.state_range.diagonal("the range of states", states)?;
        positive("range", "state", &ranges, states)?;
        Ok(ranges)
    }

    /// Largest inputs of the driven joints of `model`, whose pose these inputs hold, SI: those
    /// asked for, else the drives' own.
    pub(super) fn input_ranges(
        &self,
        model: &Model,
        held: &[f64],
    ) -> Result<Vec<f64>, DesignError> {
        let driven = model.driven_joints();
        let ranges = match &self.input_range {
            Some(range) => range.diagonal("the range of inputs", driven.len())?,
            None => {
                let joints = driven.iter().zip(held);
                joints
                    .map(|(&joint, held)| default_limit(model, joint, *held))
                    .collect()
            }
        };
        positive("range", "input", &ranges, driven.len())?;
        for ((limit, held), &joint) in ranges.iter().zip(held).zip(&driven) {
            if held.abs() >= *limit {
                let Signal { name, unit, .. } = input(model, joint);
                return Err(DesignError::request(
                    format!(
                        "{name} of {held:.4} {unit} holds the pose, and its limit is {limit} {unit}"
                    ),
                    "raise the limit (--limit), or choose a pose that asks less of the drive",
                ));
            }
        }
        Ok(ranges)
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
