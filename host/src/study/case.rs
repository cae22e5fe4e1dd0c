//! One robot under one set of circumstances, and the controller designed for it.

use super::fixed_controller::FixedController;
use crate::closed_loop::{ClosedLoop, Conditions, Controller, Limits, Plant, StateFeedback};
use crate::error::Result;
use crate::model::Model;
use crate::synth::{self, Format, Ranges};
use nalgebra::DMatrix;

/// How the controller comes about: a sampled regulator for the robot as it is believed to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Design {
    /// Weight of every state.
    pub q: f64,
    /// Weight of every torque.
    pub r: f64,
    /// Delay the design counts on, periods.
    pub delay_periods: f64,
    /// Word length of the law, 8 to 32 bits; 0 computes in floating point.
    pub word_bits: u32,
}

/// What is run.
#[derive(Debug, Clone)]
pub struct Case {
    /// The robot as the design believes it to be.
    pub nominal: Model,
    /// The robot as it is.
    pub robot: Model,
    /// Sensor, drives, clock.
    pub conditions: Conditions,
    /// Constant torque from outside on each joint, N m.
    pub disturbance_nm: Vec<f64>,
    /// The controller.
    pub design: Design,
    /// Whether the controller holds the robot's own balance instead of the pose: the angle compensation.
    pub compensated: bool,
}

/// Speeds that words of the fixed-point law hold, rad/s.
const SPEED_RANGE_RAD_S: f64 = 20.0;

impl Case {
    /// The loop without its controller; a link that leans further off than `fall_rad` has fallen.
    ///
    /// # Errors
    /// As [`Plant::new`].
    pub fn closed_loop(&self, fall_rad: f64) -> Result<ClosedLoop> {
        let mut plant = Plant::new(&self.robot, &synth::upright(&self.robot))?;
        plant.disturbance_nm.copy_from_slice(&self.disturbance_nm);
        Ok(ClosedLoop {
            plant,
            conditions: self.conditions,
            limits: Limits {
                fall_rad,
                ..Limits::default()
            },
        })
    }

    /// Gains for the believed robot, at the clock's period.
    ///
    /// # Errors
    /// Robots that cannot be linearised or stabilised.
    pub fn gains(&self) -> Result<DMatrix<f64>> {
        let plant = synth::linearise(&self.nominal, &synth::upright(&self.nominal))?.plant;
        let period_s = self.conditions.clock.period_s;
        let sampled = synth::zoh(&plant, period_s, self.design.delay_periods * period_s)?;
        let (n, m) = (plant.a.nrows(), plant.b.ncols());
        let q = self.design.q * DMatrix::identity(n, n);
        let r = self.design.r * DMatrix::identity(m, m);
        Ok(synth::dlqr(&sampled, &q, &r)?.k)
    }

    /// The controller with these gains for this loop.
    ///
    /// # Errors
    /// Gains that fit no word of the law's.
    pub fn controller(
        &self,
        gains: &DMatrix<f64>,
        closed: &ClosedLoop,
    ) -> Result<Box<dyn Controller>> {
        let joints = closed.plant.joints();
        let mut hold = vec![0.0; joints];
        if self.compensated {
            hold = closed.plant.balanced_rad();
        }
        if self.design.word_bits == 0 {
            let rows = gains.row_iter().map(|row| row.iter().copied().collect());
            let law = StateFeedback::new(joints, rows.collect());
            return Ok(Box::new(law.holding(&hold)));
        }
        let actuator = self.conditions.actuator;
        // Without a limit, four times the full range still has a word.
        let most = if actuator.saturates { 1.0 } else { 4.0 };
        let torque_nm = most * actuator.full_torque_nm;
        let range = |state: usize| match state {
            _ if state < joints => closed.limits.fall_rad,
            _ if state < 2 * joints => SPEED_RANGE_RAD_S,
            _ => torque_nm,
        };
        let ranges = Ranges {
            state: (0..gains.ncols()).map(range).collect(),
            input: vec![torque_nm; gains.nrows()],
        };
        hold.resize(gains.ncols(), 0.0);
        let format = Format {
            bits: self.design.word_bits,
            ..Format::default()
        };
        let rest = vec![0.0; gains.nrows()];
        let law = synth::quantise(gains, &hold, &rest, &ranges, &format)?;
        Ok(Box::new(FixedController::new(law, 2 * joints)))
    }

    /// Largest magnitude of a pole of the true robot, linearised at its balance, under these gains in floating point:
    /// below 1 it is stable in the small. None where it has no such balance.
    pub fn spectral_radius(&self, gains: &DMatrix<f64>, closed: &ClosedLoop) -> Option<f64> {
        let mut pose = synth::upright(&self.robot);
        let mut turned = 0.0;
        for (angle, off) in pose.iter_mut().zip(closed.plant.balanced_rad()) {
            turned += off;
            *angle += match self.robot.angles {
                crate::model::Angles::Relative => off,
                crate::model::Angles::Absolute => turned,
            };
        }
        let plant = synth::linearise(&self.robot, &pose).ok()?.plant;
        let (n, m) = (plant.a.nrows(), plant.b.ncols());
        let Conditions {
            clock, actuator, ..
        } = self.conditions;
        let sampled = synth::zoh(
            &plant,
            clock.period_s,
            actuator.delay_periods * clock.period_s,
        )
        .ok()?;
        // As many past torques as the plant or the controller remembers.
        let size = sampled.a.nrows().max(gains.ncols());
        let mut a = sampled.a.resize(size, size, 0.0);
        let mut b = sampled.b.resize(size, m, 0.0);
        if size > n {
            b.view_mut((n, 0), (m, m)).fill_with_identity();
            let older = size - n - m;
            a.view_mut((n + m, n), (older, older)).fill_with_identity();
        }
        let supply = actuator.supply;
        // The torque that acts is the one asked for, times the supply; the one remembered is the one asked for.
        a.view_mut((0, n), (n, size - n)).scale_mut(supply);
        b.view_mut((0, 0), (n, m)).scale_mut(supply);
        let k = gains.clone().resize(m, size, 0.0);
        let closed = a - b * k;
        let poles = synth::poles(&closed).ok()?;
        poles.iter().map(|pole| pole.norm()).reduce(f64::max)
    }
}
