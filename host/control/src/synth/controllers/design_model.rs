//! What a designer knows of the robot: its nominal model and what was measured beforehand, never
//! the truth of a run.

use super::ServoLag;
use crate::error::Result;
use crate::model::Model;
use crate::sim::bare_motors;
use crate::sim::closed_loop::Drives;
use crate::synth::{Continuous, OmittedEffect, Weight, linearise};
use nalgebra::DMatrix;

/// What a controller may be designed with.
#[derive(Debug, Clone)]
pub struct DesignModel {
    /// The nominal model.
    pub model: Model,
    /// The pose that is held, in the model's own convention, rad.
    pub pose_rad: Vec<f64>,
    /// The nominal plant, linear at the pose; its state is [angles, speeds], its inputs are
    /// torques, N m.
    pub plant: Continuous,
    /// Effects that the linear plant leaves out.
    pub omitted: Vec<OmittedEffect>,
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
    /// Weight of the states.
    pub q: Weight,
    /// Weight of the torques.
    pub r: Weight,
    /// Word length of the law, bits; 0 computes in floating point.
    pub word_bits: u32,
}

impl DesignModel {
    /// What a designer knows from a model, its servos commanded in torque: masses and lengths,
    /// smooth effects linearised, dead zone, delay and torque limit of its drives.
    ///
    /// # Errors
    /// A pose that is no equilibrium, nothing driven, joints that slide, or a robot in space.
    pub fn new(model: &Model, pose_rad: &[f64], period_s: f64) -> Result<DesignModel> {
        model.hinges_only("this design is one of robots on hinges")?;
        model.planar_only("this design is one of planar chains (`gains` takes both)")?;
        let model = bare_motors(model);
        let driven = model.driven_joints();
        let full_nm = |joint: usize| model.joints[joint].drive.motor().map(|m| m.stall_torque_nm);
        let linearised = linearise(&model, pose_rad)?;
        let mut plant = linearised.plant;
        // Per N m instead of per duty.
        for (input, &joint) in driven.iter().enumerate() {
            let mut column = plant.b.column_mut(input);
            column /= full_nm(joint).unwrap_or(1.0);
        }
        let values = |id: &str, joint: usize| {
            let mut of = model.effects_at(joint);
            of.find(|e| e.effect.info().id == id).map(|e| e.values[0])
        };
        let largest = |of: &dyn Fn(usize) -> Option<f64>| {
            let known = driven.iter().filter_map(|&joint| of(joint));
            known.fold(0.0, f64::max)
        };
        let dead_zone_nm =
            largest(&|joint| Some(values("dead_zone", joint)? * full_nm(joint).unwrap_or(1.0)));
        let limit_nm = driven
            .iter()
            .flat_map(|&joint| [full_nm(joint), values("torque_saturation", joint)]);
        Ok(DesignModel {
            delay_s: largest(&|joint| values("delay", joint)),
            limit_nm: limit_nm.flatten().fold(f64::INFINITY, f64::min),
            pose_rad: pose_rad.to_vec(),
            plant,
            driven,
            period_s,
            dead_zone_nm,
            position_step_rad: 0.0,
            gyro_step_rad_s: 0.0,
            servo: None,
            q: Weight::Scalar(100.0),
            r: Weight::Scalar(1.0),
            word_bits: 0,
            omitted: linearised.omitted,
            model,
        })
    }

    /// The same with drives that are further from ideal.
    #[must_use]
    pub fn with_drives(mut self, drives: &Drives) -> DesignModel {
        self.delay_s += drives.delay_periods * self.period_s;
        self.dead_zone_nm += drives.dead_zone * drives.full_torque_nm;
        if drives.saturates {
            self.limit_nm = self.limit_nm.min(drives.full_torque_nm);
        }
        self
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.plant.a.nrows() / 2
    }

    /// Number of drives.
    pub fn drives(&self) -> usize {
        self.plant.b.ncols()
    }

    /// Weights of states and torques; the paper's are Q = 100 I and R = I.
    ///
    /// # Errors
    /// Weights of another size than the plant's.
    pub fn weights(&self) -> Result<(DMatrix<f64>, DMatrix<f64>)> {
        Ok((
            self.q.matrix("Q", self.plant.a.nrows(), "states")?,
            self.r.matrix("R", self.drives(), "inputs")?,
        ))
    }
}
