//! The robot under its table, in steps of 0.1 ms: Runge and Kutta's fourth order, dry friction as
//! impulses that bring a joint to rest and no further.

use super::chain::{Equations, Joints, solve};
use super::robot::{NonIdeality, Robot};
use super::table::Table;
use std::collections::VecDeque;

/// Step, s.
const STEP_S: f64 = 1e-4;
/// Steps in the period of the law, 10 ms.
const PERIOD: usize = 100;
/// Sweeps over the joints in which the impulses of dry friction settle.
const SWEEPS: usize = 20;
/// A link that leans further has fallen, rad.
const FALLEN_RAD: f64 = std::f64::consts::FRAC_PI_4;
/// Every joint has to be this near to upright, rad: 10 deg, ..
const NEAR_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// .. over the last of a run, s.
const LAST_S: f64 = 2.0;

/// A run on its way.
#[derive(Debug)]
pub struct Simulation<'a> {
    robot: &'a Robot,
    q: Joints,
    w: Joints,
    /// What the encoders read, rad.
    reading: Joints,
    /// Torques of shoulder and hip, N m.
    torque: [f64; 2],
    /// Commands that are due at a step.
    due: VecDeque<(usize, [f64; 2])>,
    /// The latest inputs, the newest first.
    past: Vec<f64>,
    coulomb: Joints,
    viscous: Joints,
    delay: usize,
}

impl<'a> Simulation<'a> {
    /// At rest at these angles, rad.
    pub fn new(robot: &'a Robot, q: Joints) -> Simulation<'a> {
        let (mut coulomb, mut viscous, mut delay) = ([0.0; 3], [0.0; 3], 0);
        for effect in &robot.effects {
            match *effect {
                NonIdeality::Coulomb(joint, nm) => coulomb[joint] = nm,
                NonIdeality::Viscous(joint, c) => viscous[joint] = c,
                NonIdeality::Delay(s) => delay = (s / STEP_S).round() as usize,
                _ => {}
            }
        }
        Simulation {
            robot,
            q,
            w: [0.0; 3],
            reading: q,
            torque: [0.0; 2],
            due: VecDeque::new(),
            past: Vec::new(),
            coulomb,
            viscous,
            delay,
        }
    }

    /// Whether it stands to the end, under the table or without any command.
    pub fn stands(mut self, table: Option<&Table>, seconds: f64) -> bool {
        self.past = vec![0.0; table.map_or(0, Table::past)];
        let steps = (seconds / STEP_S).round() as usize;
        let last = steps - (LAST_S / STEP_S).round() as usize;
        for step in 0..steps {
            if let (Some(table), 0) = (table, step % PERIOD) {
                self.command(table, step);
            }
            while let Some((_, duty)) = self.due.front().copied().filter(|(at, _)| *at <= step) {
                self.due.pop_front();
                self.torque = [0, 1].map(|drive| self.drive_nm(drive, duty[drive]));
            }
            self.step();
            let mut lean = 0.0;
            let upright = self.q.iter().all(|angle| {
                lean += angle;
                f64::abs(lean) <= FALLEN_RAD
            });
            let near = self.q.iter().all(|angle| angle.abs() <= NEAR_RAD);
            if !upright || (step >= last && !near) {
                return false;
            }
        }
        true
    }

    /// The law's inputs, on their way to the drives.
    fn command(&mut self, table: &Table, step: usize) {
        let x = [&self.reading[..], &self.w, &self.past].concat();
        let inputs = table.inputs(&x);
        let duty = [inputs[0], inputs[1]];
        if !self.past.is_empty() {
            self.past.truncate(self.past.len() - 2);
            self.past.splice(0..0, duty);
        }
        self.due.push_back((step + self.delay, duty));
    }

    /// Torque of a drive, 0 for the shoulder's, at this duty.
    fn drive_nm(&self, drive: usize, duty: f64) -> f64 {
        let mut duty = duty.clamp(-1.0, 1.0);
        let mut torque_scale = 1.0;
        let mut limit_nm = f64::INFINITY;
        for effect in &self.robot.effects {
            match *effect {
                NonIdeality::DeadZone(joint, width, punch) if joint == drive + 1 => {
                    let beyond = f64::min((duty.abs() + punch).max(0.0), 1.0);
                    duty = if duty.abs() <= width {
                        0.0
                    } else {
                        beyond * duty.signum()
                    };
                }
                NonIdeality::Scale(factor) => torque_scale = factor,
                NonIdeality::Saturation(nm) => limit_nm = nm,
                _ => {}
            }
        }
        (torque_scale * self.robot.full_nm * duty).clamp(-limit_nm, limit_nm)
    }

    fn step(&mut self) {
        let before = self.q;
        let slope = |q: &Joints, w: &Joints| {
            let torque = std::array::from_fn(|j| {
                let drive = if j > 0 { self.torque[j - 1] } else { 0.0 };
                drive - self.viscous[j] * w[j]
            });
            Equations::at(&self.robot.links, q, w).accelerate(&torque)
        };
        let ahead = |of: &Joints, rate: &Joints, h: f64| -> Joints {
            std::array::from_fn(|j| of[j] + h * rate[j])
        };
        let (q, w, h) = (self.q, self.w, STEP_S);
        let a1 = slope(&q, &w);
        let w2 = ahead(&w, &a1, 0.5 * h);
        let a2 = slope(&ahead(&q, &w, 0.5 * h), &w2);
        let w3 = ahead(&w, &a2, 0.5 * h);
        let a3 = slope(&ahead(&q, &w2, 0.5 * h), &w3);
        let w4 = ahead(&w, &a3, h);
        let a4 = slope(&ahead(&q, &w3, h), &w4);
        for j in 0..3 {
            self.q[j] += h / 6.0 * (w[j] + 2.0 * w2[j] + 2.0 * w3[j] + w4[j]);
            self.w[j] += h / 6.0 * (a1[j] + 2.0 * a2[j] + 2.0 * a3[j] + a4[j]);
        }
        if self.coulomb.iter().any(|nm| *nm > 0.0) {
            let free = self.w;
            self.w = self.rubbed(free);
            // The impulse acts over the step: half of its change of speed counts for the way.
            for ((q, w), free) in self.q.iter_mut().zip(&self.w).zip(&free) {
                *q += 0.5 * h * (w - free);
            }
        }
        self.read(&before);
    }

    /// Speeds after the impulses of dry friction: each joint's is the one that brings it to rest,
    /// or the largest that its friction has. Gauss and Seidel's sweeps find them all.
    fn rubbed(&self, free: Joints) -> Joints {
        let mass = Equations::at(&self.robot.links, &self.q, &[0.0; 3]).mass;
        let unit = |j: usize| solve(&mass, std::array::from_fn(|k| f64::from(u8::from(j == k))));
        let inverse = [unit(0), unit(1), unit(2)];
        let (mut w, mut impulse) = (free, [0.0_f64; 3]);
        for _ in 0..SWEEPS {
            for j in 0..3 {
                let most = self.coulomb[j] * STEP_S;
                let wanted = impulse[j] - w[j] / inverse[j][j];
                let change = wanted.clamp(-most, most) - impulse[j];
                impulse[j] += change;
                for k in 0..3 {
                    w[k] += inverse[k][j] * change;
                }
            }
        }
        w
    }

    /// What the encoders read after the step: the filter's exact answer to a straight line, play
    /// that drags the reading along.
    fn read(&mut self, before: &Joints) {
        let mut reading = self.q;
        for effect in &self.robot.effects {
            match *effect {
                NonIdeality::Lag(joint, constant_s) => {
                    let rate = (self.q[joint] - before[joint]) / STEP_S;
                    let trail = constant_s * rate;
                    let off = self.reading[joint] - (before[joint] - trail);
                    reading[joint] = self.q[joint] - trail + off * (-STEP_S / constant_s).exp();
                }
                NonIdeality::Backlash(joint, gap_rad) => {
                    let half = 0.5 * gap_rad;
                    let angle = self.q[joint];
                    reading[joint] = self.reading[joint].clamp(angle - half, angle + half);
                }
                _ => {}
            }
        }
        self.reading = reading;
    }
}
