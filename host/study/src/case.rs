//! One robot under one set of circumstances, and the controller designed for it.

use crate::error::Result;
use crate::model::{Angles, Model};
use crate::sim::closed_loop::{
    Clock, ClosedLoop, Commands, Controller, Drives, KnownEquilibrium, Sensor, StabilityCriteria,
};
use crate::synth::controllers::{
    ControllerDesign, DesignModel, LinearLaw, ServoLag, ThroughServos,
};
use crate::synth::{self, Weight};

/// What is run.
#[derive(Debug, Clone)]
pub struct Case {
    /// The robot as the design believes it to be.
    pub nominal: Model,
    /// The robot as it is, with all its effects.
    pub robot: Model,
    /// What limits its drives, on top of the model's effects.
    pub drives: Drives,
    /// How it is measured.
    pub sensor: Sensor,
    /// When the controller is called.
    pub clock: Clock,
    /// Constant torque from outside on each joint, N m.
    pub disturbance_nm: Vec<f64>,
    /// Lag of the servos, if they have one.
    pub servo: Option<ServoLag>,
    /// The controller.
    pub control: Control,
    /// What counts as fallen and as stabilised.
    pub limits: StabilityCriteria,
}

/// A controller, its settings, and what its designer assumes.
#[derive(Debug, Clone)]
pub struct Control {
    /// Which one.
    pub design: &'static dyn ControllerDesign,
    /// Weight of the states, for the designs that let it be chosen.
    pub q: Weight,
    /// Weight of the torques, likewise.
    pub r: Weight,
    /// Word length of the law, 8 to 32 bits; 0 computes in floating point.
    pub word_bits: u32,
    /// Whether it is given the angles at which the robot balances: the angle compensation.
    pub known_equilibrium: bool,
    /// Drives that the design counts on.
    pub drives: Drives,
    /// Sensors that the design counts on.
    pub sensor: Sensor,
}

/// A controller designed for a case, and its linear form.
#[derive(Debug)]
pub struct Designed {
    /// For the nominal robot.
    pub controller: Box<dyn Controller>,
    linear: LinearLaw,
}

impl Case {
    /// A robot without further non-idealities under this controller, sampled every `period_s`.
    pub fn ideal(model: Model, design: &'static dyn ControllerDesign, period_s: f64) -> Case {
        Case {
            disturbance_nm: vec![0.0; model.link_count()],
            nominal: model.clone(),
            robot: model,
            drives: Drives::IDEAL,
            sensor: Sensor::EXACT,
            clock: Clock::every(period_s),
            servo: None,
            control: Control {
                design,
                q: Weight::Scalar(100.0),
                r: Weight::Scalar(1.0),
                word_bits: 0,
                known_equilibrium: false,
                drives: Drives::IDEAL,
                sensor: Sensor::EXACT,
            },
            limits: StabilityCriteria::default(),
        }
    }

    /// What the designer knows.
    ///
    /// # Errors
    /// Robots that cannot be linearised.
    pub fn design_model(&self) -> Result<DesignModel> {
        let pose_rad = synth::upright(&self.nominal);
        let period_s = self.clock.period_s;
        let control = &self.control;
        let own = DesignModel::new(&self.nominal, &pose_rad, period_s)?;
        let sensor = control.sensor;
        Ok(DesignModel {
            q: control.q.clone(),
            r: control.r.clone(),
            word_bits: control.word_bits,
            position_step_rad: sensor.position_resolution_rad,
            gyro_step_rad_s: sensor.gyro.map_or(0.0, |gyro| gyro.resolution_rad_s),
            servo: self.servo,
            ..own.with_drives(&control.drives)
        })
    }

    /// Designs the controller.
    ///
    /// # Errors
    /// Robots that cannot be linearised or stabilised.
    pub fn designed(&self) -> Result<Designed> {
        let model = self.design_model()?;
        let controller = self.control.design.build(&model)?;
        Ok(Designed {
            linear: LinearLaw::of(controller.as_ref(), &model),
            controller,
        })
    }

    /// The loop without its controller.
    ///
    /// # Errors
    /// As [`ClosedLoop::new`].
    pub fn closed_loop(&self) -> Result<ClosedLoop> {
        let period_s = self.clock.period_s;
        let robot = self.drives.on(&self.robot, period_s);
        let pose_rad = synth::upright(&self.robot);
        let mut closed = ClosedLoop::new(&robot, &pose_rad, Commands::Torque, period_s)?;
        closed
            .plant
            .disturbance_nm
            .copy_from_slice(&self.disturbance_nm);
        closed.sensor = self.sensor;
        closed.clock = self.clock;
        closed.limits = self.limits;
        closed.command_step = self.drives.resolution * self.drives.full_torque_nm;
        Ok(closed)
    }

    /// The controller as it acts on this loop: with the equilibrium that it may know, behind the
    /// servos' lag.
    pub fn controller<'a>(
        &self,
        designed: &'a Designed,
        closed: &ClosedLoop,
    ) -> Box<dyn Controller + 'a> {
        let mut controller: Box<dyn Controller + 'a> = Box::new(&*designed.controller);
        if self.control.known_equilibrium || self.control.design.info().known_equilibrium {
            let equilibrium_rad = closed.plant.in_convention(&closed.plant.balanced_rad());
            controller = Box::new(KnownEquilibrium::new(controller, equilibrium_rad));
        }
        if let Some(servo) = self.servo {
            controller = Box::new(ThroughServos {
                inner: controller,
                servo,
                drives: closed.plant.drives(),
                limit_nm: if self.drives.saturates {
                    self.drives.full_torque_nm
                } else {
                    f64::INFINITY
                },
            });
        }
        controller
    }

    /// Largest magnitude of a pole of the true robot, linearised at its balance, under this
    /// controller: below 1 it is stable in the small. None where it has no such balance.
    pub fn spectral_radius(&self, designed: &Designed, closed: &ClosedLoop) -> Option<f64> {
        let mut pose_rad = synth::upright(&self.robot);
        let mut turned = 0.0;
        for (angle, off) in pose_rad.iter_mut().zip(closed.plant.balanced_rad()) {
            turned += off;
            *angle += match self.robot.angles {
                Angles::Relative => off,
                Angles::Absolute => turned,
            };
        }
        let period_s = self.clock.period_s;
        let mut truth = DesignModel::new(&self.robot, &pose_rad, period_s).ok()?;
        truth.plant.b *= self.drives.supply;
        let delay_s = truth.delay_s + self.drives.delay_periods * period_s;
        designed.linear.spectral_radius(&truth, delay_s).ok()
    }
}
