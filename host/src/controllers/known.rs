//! What a designer knows of the robot: its nominal model and what was measured beforehand, never the truth of a run.

use super::ServoLag;
use crate::error::{Error, Result};
use crate::model::{Drive, Model};
use crate::synth::{Continuous, linearise};
use nalgebra::DMatrix;

/// What a controller may be designed with.
#[derive(Debug, Clone)]
pub struct Known {
    /// The nominal model.
    pub model: Model,
    /// The pose that is held, in the model's own convention, rad.
    pub pose_rad: Vec<f64>,
    /// The nominal plant, linear at the pose; its state is [angles, speeds].
    pub plant: Continuous,
    /// Joints that are driven, counted from 0.
    pub driven: Vec<usize>,
    /// Sampling time, s.
    pub period_s: f64,
    /// Delay from sample to effect, s.
    pub delay_s: f64,
    /// Nominal dead zone, N m; the robot's own may differ by a fifth.
    pub dead_zone_nm: f64,
    /// Torque limit, N m.
    pub limit_nm: f64,
    /// Step of the angles, rad.
    pub position_step_rad: f64,
    /// Step of the gyro, rad/s.
    pub gyro_step_rad_s: f64,
    /// Lag of the servos.
    pub servo: Option<ServoLag>,
}

impl Known {
    /// A robot without any trouble, sampled every `period_s`.
    ///
    /// # Errors
    /// A pose that is no equilibrium, nothing driven, or drives that are not commanded in torque.
    pub fn ideal(model: &Model, pose_rad: &[f64], period_s: f64) -> Result<Known> {
        if let Some(joint) = model
            .joints
            .iter()
            .position(|joint| joint.drive.is_driven() && joint.drive != Drive::Torque)
        {
            return Err(Error::design(
                format!(
                    "{}: joint {} has a {} drive, but the controllers command torques",
                    model.name,
                    joint + 1,
                    model.joints[joint].drive.name()
                ),
                "give the model `drive = \"torque\"`; servo lag, dead zone and limits are conditions here",
            ));
        }
        let driven = (0..model.link_count()).filter(|&joint| model.joints[joint].drive.is_driven());
        Ok(Known {
            model: model.clone(),
            pose_rad: pose_rad.to_vec(),
            plant: linearise(model, pose_rad)?.plant,
            driven: driven.collect(),
            period_s,
            delay_s: 0.0,
            dead_zone_nm: 0.0,
            limit_nm: f64::INFINITY,
            position_step_rad: 0.0,
            gyro_step_rad_s: 0.0,
            servo: None,
        })
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.plant.a.nrows() / 2
    }

    /// Number of drives.
    pub fn drives(&self) -> usize {
        self.plant.b.ncols()
    }

    /// Weights of the paper: Q = 100 I, R = I.
    pub fn paper_weights(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let n = self.plant.a.nrows();
        (
            100.0 * DMatrix::identity(n, n),
            DMatrix::identity(self.drives(), self.drives()),
        )
    }
}
