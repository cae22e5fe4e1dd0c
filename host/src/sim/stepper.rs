//! One integration step with friction that truly sticks.
//!
//! Between events every joint is free, sliding in a known direction, or held; the equations are then smooth
//! and classical Runge-Kutta of fourth order integrates them. A sliding joint whose speed crosses zero ends
//! the step there; a held joint is released when the torque that holds it exceeds the breakaway torque.

use super::drive::Told;
use super::plant::Plant;
use crate::dynamics::Workspace;
use crate::effects::{JointState, Slide};

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

/// State and scratch of a simulation.
#[derive(Debug, Clone)]
pub(super) struct Stepper {
    pub angle: Vec<f64>,
    pub speed: Vec<f64>,
    pub contact: Vec<Contact>,
    work: Workspace,
    held: Vec<bool>,
    torque: Vec<f64>,
    drive_torque: Vec<f64>,
    loads: Vec<f64>,
    bearing: Vec<f64>,
    zeros: Vec<f64>,
    stage_angle: Vec<f64>,
    stage_speed: Vec<f64>,
    slope: [Vec<f64>; 4],
    speeds: [Vec<f64>; 3],
    start_angle: Vec<f64>,
    start_speed: Vec<f64>,
}

impl Stepper {
    /// At these relative angles and speeds; joints at speed 0 begin held if anything holds them.
    pub fn new(plant: &Plant, angle: &[f64], speed: &[f64]) -> Stepper {
        let n = plant.len();
        let zeros = || vec![0.0; n];
        let contact = plant
            .joints
            .iter()
            .zip(speed)
            .map(|(joint, &speed)| match (joint.friction.is_empty(), speed) {
                (true, _) => Contact::Free,
                (false, 0.0) => Contact::Held,
                (false, speed) => Contact::Sliding(speed.signum()),
            })
            .collect();
        Stepper {
            angle: angle.to_vec(),
            speed: speed.to_vec(),
            contact,
            work: Workspace::new(n),
            held: vec![false; n],
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
        }
    }

    /// Advances by `step_s` under constant inputs.
    pub fn advance(&mut self, plant: &Plant, told: &[Told], step_s: f64) {
        let mut left = step_s;
        // Chatter between contacts can't go on for ever: after this many events the step is taken as it comes.
        for _ in 0..8 {
            self.release(plant, told);
            self.start_angle.copy_from_slice(&self.angle);
            self.start_speed.copy_from_slice(&self.speed);
            self.runge_kutta(plant, told, left);
            let Some((joint, share)) = self.first_stop() else {
                return;
            };
            self.angle.copy_from_slice(&self.start_angle);
            self.speed.copy_from_slice(&self.start_speed);
            self.runge_kutta(plant, told, share * left);
            self.speed[joint] = 0.0;
            self.contact[joint] = Contact::Held;
            left *= 1.0 - share;
            if left <= 1e-12 {
                return;
            }
        }
        self.release(plant, told);
        self.runge_kutta(plant, told, left);
        for joint in 0..self.speed.len() {
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
        (0..self.speed.len())
            .filter(|&joint| self.stopped(joint))
            .map(|joint| {
                let before = self.start_speed[joint];
                (joint, before / (before - self.speed[joint]))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Lets go of held joints that are pushed beyond their breakaway torque, the most pushed first.
    fn release(&mut self, plant: &Plant, told: &[Told]) {
        while self.contact.contains(&Contact::Held) {
            self.stage_angle.copy_from_slice(&self.angle);
            self.stage_speed.copy_from_slice(&self.speed);
            self.accelerate(plant, told, 0);
            let pushed = (0..plant.len())
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

    fn runge_kutta(&mut self, plant: &Plant, told: &[Told], h: f64) {
        let n = plant.len();
        self.stage_angle.copy_from_slice(&self.angle);
        self.stage_speed.copy_from_slice(&self.speed);
        for stage in 0..4 {
            self.accelerate(plant, told, stage);
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
    fn accelerate(&mut self, plant: &Plant, told: &[Told], stage: usize) {
        for (joint, plan) in plant.joints.iter().enumerate() {
            let speed = self.stage_speed[joint];
            self.held[joint] = self.contact[joint] == Contact::Held;
            let drive = match plan.drive {
                crate::model::Drive::Passive => 0.0,
                _ => {
                    let reading = plant.encoded_rad(joint, &self.stage_angle);
                    plan.drive_torque_nm(told[joint], reading, speed)
                }
            };
            let state = JointState {
                angle_rad: self.stage_angle[joint] - if joint == 0 { plant.zero_rad } else { 0.0 },
                speed_rad_s: speed,
                drive_nm: drive,
                shuffled_rad_s: told[joint].shuffled_rad_s,
            };
            self.drive_torque[joint] = drive;
            self.torque[joint] = plan
                .torque
                .iter()
                .fold(drive, |sum, e| sum + e.effect.torque(e.values(), &state));
        }
        if plant.needs_gear_load {
            self.find_gear_loads(plant);
        }
        if plant.needs_bearing_load {
            self.find_bearing_loads(plant, stage);
        }
        for joint in 0..plant.len() {
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
            plant.rig.gravity_turn_rad,
            &self.stage_angle,
            &self.stage_speed,
            &self.torque,
            &self.held,
            &mut self.slope[stage],
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
            &self.stage_angle,
            &self.stage_speed,
            &self.zeros,
            &mut self.loads,
        );
        for (load, drive) in self.loads.iter_mut().zip(&self.drive_torque) {
            *load = (*load + drive).abs();
        }
    }

    /// Force in the bearings at the accelerations the chain has without friction.
    fn find_bearing_loads(&mut self, plant: &Plant, stage: usize) {
        self.solve(plant, stage);
        for joint in 0..plant.len() {
            if self.held[joint] {
                self.slope[stage][joint] = 0.0;
            }
        }
        let mut forces = std::mem::take(&mut self.bearing);
        plant.rig.chain.bearing_forces(
            plant.rig.gravity_turn_rad,
            &self.stage_angle,
            &self.stage_speed,
            &self.slope[stage],
            &mut forces,
        );
        self.bearing = forces;
    }
}
