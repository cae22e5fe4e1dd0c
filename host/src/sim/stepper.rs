//! One integration step with friction that truly sticks.
//!
//! Between events every joint is free, sliding in a known direction, or held; the equations are then smooth
//! and classical Runge-Kutta of fourth order integrates them. A sliding joint whose speed crosses zero ends
//! the step there; a held joint is released when the torque that holds it exceeds the breakaway torque.

use super::drive::DriveInput;
use super::plant::Plant;
use super::rows::Rows;
use crate::dynamics::Workspace;
use crate::effects::{JointState, Slide};
use crate::model::Drive;

/// How friction acts on a joint until the next event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Contact {
    /// No friction at all.
    Free,
    /// Sliding in this direction, +1 or -1.
    Sliding(f64),
    /// At rest, held.
    Held,
}

/// State and scratch of a simulation; `R` says how its rows of one number per joint are kept.
#[derive(Debug, Clone)]
pub(super) struct Stepper<R: Rows> {
    pub angle: R::Of<f64>,
    pub speed: R::Of<f64>,
    contact: R::Of<Contact>,
    work: Workspace,
    held: R::Of<bool>,
    torque: R::Of<f64>,
    drive_torque: R::Of<f64>,
    loads: R::Of<f64>,
    bearing: R::Of<f64>,
    zeros: R::Of<f64>,
    stage_angle: R::Of<f64>,
    stage_speed: R::Of<f64>,
    slope: [R::Of<f64>; 4],
    speeds: [R::Of<f64>; 3],
    start_angle: R::Of<f64>,
    start_speed: R::Of<f64>,
}

impl<R: Rows> Stepper<R> {
    /// At these relative angles and speeds; joints at speed 0 begin held if anything holds them.
    pub fn new(plant: &Plant, angle: &[f64], speed: &[f64]) -> Self {
        let n = plant.len();
        let zeros = || R::filled(0.0, n);
        let mut stepper: Self = Stepper {
            angle: zeros(),
            speed: zeros(),
            contact: R::filled(Contact::Free, n),
            work: Workspace::new(n),
            held: R::filled(false, n),
            torque: zeros(),
            drive_torque: zeros(),
            loads: zeros(),
            bearing: zeros(),
            zeros: zeros(),
            stage_angle: zeros(),
            stage_speed: zeros(),
            slope: [zeros(), zeros(), zeros(), zeros()],
            speeds: [zeros(), zeros(), zeros()],
            start_angle: zeros(),
            start_speed: zeros(),
        };
        for (joint, plan) in plant.joints.iter().enumerate() {
            stepper.angle[joint] = angle[joint];
            stepper.speed[joint] = speed[joint];
            stepper.contact[joint] = match (plan.friction.is_empty(), speed[joint]) {
                (true, _) => Contact::Free,
                (false, 0.0) => Contact::Held,
                (false, speed) => Contact::Sliding(speed.signum()),
            };
        }
        stepper
    }

    /// Number of joints.
    #[inline]
    fn len(&self) -> usize {
        self.angle.as_ref().len()
    }

    /// Advances by `step_s` under constant inputs.
    pub fn advance(&mut self, plant: &Plant, inputs: &[DriveInput], step_s: f64) {
        let mut left = step_s;
        // Chatter between contacts can't go on for ever: after this many events the step is taken as it comes.
        for _ in 0..8 {
            self.release(plant, inputs);
            self.start_angle.clone_from(&self.angle);
            self.start_speed.clone_from(&self.speed);
            self.runge_kutta(plant, inputs, left);
            let Some((joint, share)) = self.first_stop() else {
                return;
            };
            self.angle.clone_from(&self.start_angle);
            self.speed.clone_from(&self.start_speed);
            self.runge_kutta(plant, inputs, share * left);
            self.speed[joint] = 0.0;
            self.contact[joint] = Contact::Held;
            left *= 1.0 - share;
            if left <= 1e-12 {
                return;
            }
        }
        self.release(plant, inputs);
        self.runge_kutta(plant, inputs, left);
        for joint in 0..self.len() {
            if self.stopped(joint) {
                self.speed[joint] = 0.0;
                self.contact[joint] = Contact::Held;
            }
        }
    }

    fn stopped(&self, joint: usize) -> bool {
        matches!(self.contact[joint], Contact::Sliding(direction) if direction * self.speed[joint] < 0.0)
    }

    /// The joint whose speed first crosses zero in the step just taken, and at which share of it.
    fn first_stop(&self) -> Option<(usize, f64)> {
        (0..self.len())
            .filter(|&joint| self.stopped(joint))
            .map(|joint| {
                let before = self.start_speed[joint];
                (joint, before / (before - self.speed[joint]))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Lets go of held joints that are pushed beyond their breakaway torque, the most pushed first.
    fn release(&mut self, plant: &Plant, inputs: &[DriveInput]) {
        while self.contact.as_ref().contains(&Contact::Held) {
            self.stage_angle.clone_from(&self.angle);
            self.stage_speed.clone_from(&self.speed);
            self.accelerate(plant, inputs, 0);
            let pushed = (0..self.len())
                .filter(|&joint| self.contact[joint] == Contact::Held)
                .map(|joint| {
                    let push = -self.slope[0][joint];
                    let breakaway = self.friction_nm(plant, joint, 0.0, push.signum());
                    (joint, push.signum(), push.abs() - breakaway)
                })
                .max_by(|a, b| a.2.total_cmp(&b.2));
            match pushed {
                Some((joint, direction, excess)) if excess > 0.0 => {
                    self.contact[joint] = Contact::Sliding(direction);
                }
                _ => return,
            }
        }
    }

    fn runge_kutta(&mut self, plant: &Plant, inputs: &[DriveInput], h: f64) {
        let n = self.len();
        self.stage_angle.clone_from(&self.angle);
        self.stage_speed.clone_from(&self.speed);
        for stage in 0..4 {
            self.accelerate(plant, inputs, stage);
            for joint in 0..n {
                if self.held[joint] {
                    self.slope[stage][joint] = 0.0;
                }
            }
            if stage < 3 {
                let share = if stage == 2 { h } else { h / 2.0 };
                for joint in 0..n {
                    self.stage_angle[joint] = self.angle[joint] + share * self.stage_speed[joint];
                    self.stage_speed[joint] = self.speed[joint] + share * self.slope[stage][joint];
                    self.speeds[stage][joint] = self.stage_speed[joint];
                }
            }
        }
        for joint in 0..n {
            let s = |k: usize| self.slope[k][joint];
            let w = |k: usize| self.speeds[k][joint];
            self.angle[joint] += h / 6.0 * (self.speed[joint] + 2.0 * w(0) + 2.0 * w(1) + w(2));
            self.speed[joint] += h / 6.0 * (s(0) + 2.0 * s(1) + 2.0 * s(2) + s(3));
        }
    }

    /// Accelerations at the stage state into `slope[stage]`; for held joints the holding torque.
    fn accelerate(&mut self, plant: &Plant, inputs: &[DriveInput], stage: usize) {
        for (joint, &input) in inputs[..self.len()].iter().enumerate() {
            let plan = &plant.joints[joint];
            let speed = self.stage_speed[joint];
            self.held[joint] = self.contact[joint] == Contact::Held;
            let drive = match plan.drive {
                Drive::Passive => 0.0,
                Drive::Position { .. } => {
                    let reading = plant.encoded_rad(joint, self.stage_angle.as_ref());
                    plan.drive_torque_nm(input, reading, speed)
                }
                _ => plan.drive_torque_nm(input, 0.0, speed),
            };
            let state = JointState {
                angle_rad: self.stage_angle[joint] - if joint == 0 { plant.zero_rad } else { 0.0 },
                speed_rad_s: speed,
                drive_nm: drive,
                shuffled_rad_s: input.shuffled_rad_s,
            };
            self.drive_torque[joint] = drive;
            self.torque[joint] = plan
                .torque
                .iter()
                .fold(drive + input.disturbance_nm, |sum, e| {
                    sum + e.effect.torque(e.values(), &state)
                });
        }
        if plant.needs_gear_load {
            self.find_gear_loads(plant);
        }
        if plant.needs_bearing_load {
            self.find_bearing_loads(plant, stage);
        }
        for joint in 0..self.len() {
            if let Contact::Sliding(direction) = self.contact[joint] {
                let speed = (direction * self.stage_speed[joint]).max(0.0);
                self.torque[joint] -= direction * self.friction_nm(plant, joint, speed, direction);
            }
        }
        self.solve(plant, stage);
    }

    fn solve(&mut self, plant: &Plant, stage: usize) {
        plant.rig.chain.forward(
            &mut self.work,
            plant.base_m_s2,
            self.stage_angle.as_ref(),
            self.stage_speed.as_ref(),
            self.torque.as_ref(),
            self.held.as_ref(),
            self.slope[stage].as_mut(),
        );
    }

    fn friction_nm(&self, plant: &Plant, joint: usize, speed_rad_s: f64, direction: f64) -> f64 {
        let slide = Slide {
            speed_rad_s,
            direction,
            gear_load_nm: self.loads[joint],
            bearing_load_n: self.bearing[joint],
        };
        plant.joints[joint]
            .friction
            .iter()
            .map(|e| e.effect.friction(e.values(), &slide))
            .sum::<f64>()
            .max(0.0)
    }

    /// Motor torque minus outside torque: gravity and velocity coupling at zero acceleration.
    fn find_gear_loads(&mut self, plant: &Plant) {
        plant.rig.chain.inverse(
            plant.rig.gravity_turn_rad,
            self.stage_angle.as_ref(),
            self.stage_speed.as_ref(),
            self.zeros.as_ref(),
            self.loads.as_mut(),
        );
        for joint in 0..self.len() {
            self.loads[joint] = (self.loads[joint] + self.drive_torque[joint]).abs();
        }
    }

    /// Force in the bearings at the accelerations the chain has without friction.
    fn find_bearing_loads(&mut self, plant: &Plant, stage: usize) {
        self.solve(plant, stage);
        for joint in 0..self.len() {
            if self.held[joint] {
                self.slope[stage][joint] = 0.0;
            }
        }
        plant.rig.chain.bearing_forces(
            plant.rig.gravity_turn_rad,
            self.stage_angle.as_ref(),
            self.stage_speed.as_ref(),
            self.slope[stage].as_ref(),
            self.bearing.as_mut(),
        );
    }
}
