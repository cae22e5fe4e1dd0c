//! The plant about the pose that a controller holds.
//!
//! Where the torques are constant between commands (no friction, no drive that follows the speed,
//! at most four links), dense equations advance it, several runs at once; else the simulation that
//! serves measuring does.

use super::body::Body;
use super::equations::{Absolute, Equations};
use crate::dynamics::Dense;
use crate::error::{Error, Result};
use crate::model::{Drive, Model};
use crate::motion::Motion;
use crate::sim::drive::DriveInput;
use crate::sim::stepper::steps;
use crate::sim::{Plant, bare_motors};

/// An upright robot is faster than the arms that models' own steps are made for, s.
const LONGEST_STEP_S: f64 = 1e-3;

/// What a controller commands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Commands {
    /// Torques at standstill and nominal supply, N m: a servo is its bare motor, commanded in duty.
    Torque,
    /// What the drives of the model take: N m, duty, rad or rad/s.
    Own,
}

/// A plant and the pose about which its state counts.
#[derive(Debug, Clone)]
pub struct PosedPlant {
    pub(super) plant: Plant,
    pub(super) equations: Equations,
    pub(super) drives: Vec<DrivenJoint>,
    /// Constant torque on each joint from outside, N m.
    pub disturbance_nm: Vec<f64>,
    /// Longest integration step, s.
    pub step_s: f64,
    /// Relative angles, joint 1 from hanging, rad.
    pub(super) pose_rad: Vec<f64>,
}

/// A driven joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DrivenJoint {
    /// Which one, from 0.
    pub joint: usize,
    /// Drive input per command.
    input_per_command: f64,
    /// Largest input that the drive takes.
    largest_input: f64,
    /// How late it obeys, s.
    pub delay_s: f64,
}

impl PosedPlant {
    /// The plant of a model, all its effects included, about `pose_rad`: one angle per joint in the
    /// model's own convention, rad. Steps are 1 ms at most.
    ///
    /// # Errors
    /// A pose of another length, or nothing driven.
    pub fn new(model: &Model, pose_rad: &[f64], commands: Commands) -> Result<PosedPlant> {
        let motors;
        let model = match commands {
            Commands::Own => model,
            Commands::Torque => {
                motors = bare_motors(model);
                &motors
            }
        };
        let plant = Plant::without_log(model);
        PosedPlant::around(plant, model, pose_rad, commands)
    }

    /// The plant of a model under the conditions of a motion (payload, attitude), commanded as its
    /// own drives are.
    ///
    /// # Errors
    /// As [`PosedPlant::new`].
    pub fn of_motion(model: &Model, pose_rad: &[f64], motion: &Motion) -> Result<PosedPlant> {
        let plant = Plant::new(model, motion);
        PosedPlant::around(plant, model, pose_rad, Commands::Own)
    }

    fn around(
        plant: Plant,
        model: &Model,
        pose_rad: &[f64],
        commands: Commands,
    ) -> Result<PosedPlant> {
        if pose_rad.len() != plant.len() {
            return Err(Error::design(
                format!("{} angles for {} joints", pose_rad.len(), plant.len()),
                "give the pose one angle per joint",
            ));
        }
        let driven = |joint: usize| {
            let plan = &plant.joints[joint];
            let is_duty = matches!(plan.drive, Drive::Duty(_));
            DrivenJoint {
                joint,
                input_per_command: match (commands, is_duty) {
                    (Commands::Torque, true) => 1.0 / plan.full_torque_nm,
                    _ => 1.0,
                },
                largest_input: if is_duty { 1.0 } else { f64::INFINITY },
                delay_s: plan.delay_s,
            }
        };
        let drives: Vec<DrivenJoint> = model.driven_joints().into_iter().map(driven).collect();
        if drives.is_empty() {
            return Err(Error::design(
                "no joint is driven, so nothing can hold the robot up",
                "give at least one joint a drive, such as `drive = \"torque\"`",
            ));
        }
        Ok(PosedPlant {
            equations: Equations::of(&plant),
            drives,
            disturbance_nm: vec![0.0; plant.len()],
            step_s: model.step_s.min(LONGEST_STEP_S),
            pose_rad: model.relative_rad(pose_rad),
            plant,
        })
    }

    /// The same plant by the general simulation, whatever acts on it.
    #[must_use]
    pub fn by_general_simulation(mut self) -> PosedPlant {
        self.equations = Equations::General;
        self
    }

    /// Whether the dense equations advance it.
    pub fn is_dense(&self) -> bool {
        !matches!(self.equations, Equations::General)
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.plant.len()
    }

    /// Whether a joint slides.
    #[inline]
    pub fn slides(&self, joint: usize) -> bool {
        self.plant.slides[joint]
    }

    /// Whether it is a robot in space.
    #[inline]
    pub fn is_in_space(&self) -> bool {
        self.plant.tree.is_some()
    }

    /// Number of driven joints.
    pub fn drives(&self) -> usize {
        self.drives.len()
    }

    /// The driven joints from the base outwards, counted from 0.
    pub fn driven_joints(&self) -> impl Iterator<Item = usize> {
        self.drives.iter().map(|drive| drive.joint)
    }

    /// Gives a drive its command: its input, and its torque at the state.
    #[inline]
    pub(super) fn obey(
        &self,
        drive: usize,
        command: f64,
        inputs: &mut [DriveInput],
        body: &mut Body,
    ) {
        let driven = &self.drives[drive];
        let joint = driven.joint;
        let input = driven.input_per_command * command;
        let input = DriveInput {
            input: input.clamp(-driven.largest_input, driven.largest_input),
            disturbance_nm: self.disturbance_nm[joint],
            ..DriveInput::ZERO
        };
        inputs[joint] = input;
        let plan = &self.plant.joints[joint];
        body.drive_nm[drive] = match &body.general {
            None => plan.drive_torque_nm(input, 0.0.into(), 0.0, &[]),
            Some(general) => {
                let reading = self.plant.encoded_rad(joint, general.angle_rad());
                let cells = general.memory();
                let motor_speed = plan.motor_speed_rad_s(cells, body.speed_rad_s[joint]);
                plan.drive_torque_nm(input, reading.into(), motor_speed, cells)
            }
        };
    }

    /// Readings of the encoders as deviations from those of the pose, in the model's convention:
    /// rad and rad/s.
    #[inline]
    pub(super) fn readings(&self, body: &Body, angle_rad: &mut [f64], speed_rad_s: &mut [f64]) {
        let (mut angle, mut speed) = (0.0, 0.0);
        for (joint, plan) in self.plant.joints.iter().enumerate() {
            let carry = if self.plant.absolute { 1.0 } else { 0.0 };
            angle = carry * angle + body.angle_rad[joint];
            speed = carry * speed + body.speed_rad_s[joint];
            let slope = plan.reading_slope();
            angle_rad[joint] = slope * angle;
            speed_rad_s[joint] = slope * speed;
        }
        if let Some(general) = body.general.as_ref().filter(|_| self.plant.senses) {
            let readings = general.reading_rad().iter().enumerate();
            for (joint, reading) in readings {
                angle_rad[joint] = reading - self.plant.encoded_rad(joint, &self.pose_rad);
            }
        }
    }

    /// Into how many steps of what length a span is cut, s.
    #[inline]
    pub(super) fn steps(&self, span_s: f64) -> (usize, f64) {
        steps(span_s, self.step_s)
    }

    /// Advances by `span_s` under constant inputs.
    #[inline]
    pub(super) fn advance(&self, body: &mut Body, inputs: &[DriveInput], span_s: f64) {
        let (steps, h) = self.steps(span_s);
        match &self.equations {
            Equations::One(dense) => self.by_dense(dense, body, h, steps),
            Equations::Two(dense) => self.by_dense(dense, body, h, steps),
            Equations::Three(dense) => self.by_dense(dense, body, h, steps),
            Equations::Four(dense) => self.by_dense(dense, body, h, steps),
            Equations::General => self.by_general(body, inputs, h, steps),
        }
    }

    #[inline]
    fn by_dense<const N: usize>(&self, dense: &Dense<N>, body: &mut Body, h: f64, steps: usize) {
        let mut state = self.absolute(body);
        let load = state.load_nm;
        dense.advance(
            &mut state.angle_rad,
            &mut state.speed_rad_s,
            &load,
            h,
            steps,
        );
        self.relative(&state, body);
    }

    /// The state in absolute angles, with the moment on each link.
    #[inline]
    pub(super) fn absolute<const N: usize>(&self, body: &Body) -> Absolute<N> {
        let mut torque: [f64; N] = std::array::from_fn(|joint| self.disturbance_nm[joint]);
        for (driven, drive_nm) in self.drives.iter().zip(&body.drive_nm) {
            torque[driven.joint] += drive_nm;
        }
        let mut state = Absolute::default();
        let (mut angle, mut speed) = (0.0, 0.0);
        for i in 0..N {
            angle += self.pose_rad[i] + body.angle_rad[i];
            speed += body.speed_rad_s[i];
            (state.angle_rad[i], state.speed_rad_s[i]) = (angle, speed);
            let beyond = if i + 1 < N { torque[i + 1] } else { 0.0 };
            state.load_nm[i] = torque[i] - beyond;
        }
        state
    }

    /// Back from absolute angles.
    #[inline]
    pub(super) fn relative<const N: usize>(&self, state: &Absolute<N>, body: &mut Body) {
        let (mut angle, mut speed) = (0.0, 0.0);
        for i in 0..N {
            body.angle_rad[i] = (state.angle_rad[i] - angle) - self.pose_rad[i];
            body.speed_rad_s[i] = state.speed_rad_s[i] - speed;
            (angle, speed) = (state.angle_rad[i], state.speed_rad_s[i]);
        }
    }

    fn by_general(&self, body: &mut Body, inputs: &[DriveInput], h: f64, steps: usize) {
        let Some(general) = &mut body.general else {
            return;
        };
        general.advance(&self.plant, inputs, h, steps);
        for (joint, pose) in self.pose_rad.iter().enumerate() {
            body.angle_rad[joint] = general.angle_rad()[joint] - pose;
            body.speed_rad_s[joint] = general.speed_rad_s()[joint];
        }
    }
}
