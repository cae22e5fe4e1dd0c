//! The robot that is held up.

use crate::dynamics::{self, Chain, Dense};
use crate::effects::{Rig, Site};
use crate::error::{Error, Result};
use crate::model::{Angles, Model};

/// A chain near a pose: few links by dense equations, many by the O(n) ones, classical Runge-Kutta of fourth order.
#[derive(Debug, Clone)]
pub struct Plant {
    pub(super) equations: Equations,
    /// Joints that are driven, from the base outwards, counted from 0.
    driven: Vec<usize>,
    /// Constant torque on each joint from outside, N m.
    pub disturbance_nm: Vec<f64>,
    /// Longest integration step, s.
    pub step_s: f64,
    /// Pose: relative angles, joint 1 from hanging, rad.
    pose_rad: Vec<f64>,
    chain: Chain,
    base_m_s2: [f64; 2],
}

/// An upright robot is faster than the arms that models' own steps are made for, s.
const LONGEST_STEP_S: f64 = 1e-3;

/// The equations of motion that suit the number of links.
#[derive(Debug, Clone)]
pub(super) enum Equations {
    One(Dense<1>),
    Two(Dense<2>),
    Three(Dense<3>),
    Four(Dense<4>),
    Many,
}

impl Equations {
    pub(super) fn one(&self) -> Option<&Dense<1>> {
        match self {
            Equations::One(dense) => Some(dense),
            _ => None,
        }
    }

    pub(super) fn two(&self) -> Option<&Dense<2>> {
        match self {
            Equations::Two(dense) => Some(dense),
            _ => None,
        }
    }

    pub(super) fn three(&self) -> Option<&Dense<3>> {
        match self {
            Equations::Three(dense) => Some(dense),
            _ => None,
        }
    }

    pub(super) fn four(&self) -> Option<&Dense<4>> {
        match self {
            Equations::Four(dense) => Some(dense),
            _ => None,
        }
    }
}

impl Plant {
    /// The robot of a model around `pose_rad`, one angle per joint in the model's own convention.
    ///
    /// Masses, centres of mass and gravity are those after the model's effects on them; steps are 1 ms at most.
    ///
    /// # Errors
    /// A pose of another length, nothing driven, or effects this simulation does not have.
    pub fn new(model: &Model, pose_rad: &[f64]) -> Result<Plant> {
        if let Some(other) = model
            .effects
            .iter()
            .find(|e| e.effect.info().site != Site::Body)
        {
            let title = other.effect.info().title;
            return Err(Error::design(
                format!(
                    "the closed loop of `{}` cannot have this effect: {title}",
                    model.name
                ),
                "take it out of the model: dead zone, delay, saturation, resolution are conditions of the loop",
            ));
        }
        let rig = Rig::of(model, false);
        let driven: Vec<usize> = (0..model.joints.len())
            .filter(|&joint| model.joints[joint].drive.is_driven())
            .collect();
        let mut pose = pose_rad.to_vec();
        if model.angles == Angles::Absolute {
            for joint in (1..pose.len()).rev() {
                pose[joint] -= pose[joint - 1];
            }
        }
        if let Some(first) = pose.first_mut() {
            *first += model.angle_zero.from_hanging_rad();
        }
        let step_s = model.step_s.min(LONGEST_STEP_S);
        Plant::of(rig.chain, rig.gravity_turn_rad, driven, pose, step_s)
    }

    /// A chain around a pose of relative angles, joint 1 from hanging, rad; `driven` counts joints from 0.
    ///
    /// # Errors
    /// A pose of another length, or nothing driven.
    pub fn of(
        chain: Chain,
        gravity_turn_rad: f64,
        driven: Vec<usize>,
        pose_rad: Vec<f64>,
        step_s: f64,
    ) -> Result<Plant> {
        if pose_rad.len() != chain.len() {
            return Err(Error::design(
                format!("{} angles for {} joints", pose_rad.len(), chain.len()),
                "give the pose one angle per joint",
            ));
        }
        if driven.is_empty() || driven.iter().any(|&joint| joint >= chain.len()) {
            return Err(Error::design(
                "no joint is driven, so nothing can hold the robot up",
                "give at least one joint a drive, such as `drive = \"torque\"`",
            ));
        }
        let mut plant = Plant {
            equations: Equations::Many,
            driven,
            disturbance_nm: vec![0.0; chain.len()],
            step_s,
            pose_rad,
            base_m_s2: chain.base_m_s2(gravity_turn_rad),
            chain,
        };
        let chain = &plant.chain;
        plant.equations = match chain.len() {
            1 => Dense::new(chain, gravity_turn_rad).map(Equations::One),
            2 => Dense::new(chain, gravity_turn_rad).map(Equations::Two),
            3 => Dense::new(chain, gravity_turn_rad).map(Equations::Three),
            4 => Dense::new(chain, gravity_turn_rad).map(Equations::Four),
            _ => None,
        }
        .unwrap_or(Equations::Many);
        Ok(plant)
    }

    /// The same robot with the O(n) equations, whatever its length.
    #[must_use]
    pub fn by_articulated_bodies(mut self) -> Plant {
        self.equations = Equations::Many;
        self
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.chain.len()
    }

    /// Number of driven joints.
    pub fn drives(&self) -> usize {
        self.driven.len()
    }

    /// Deviations from the pose, rad, at which it stands without torque: what holds eccentric masses in balance.
    pub fn balanced_rad(&self) -> Vec<f64> {
        let turn = self.base_m_s2[0].atan2(self.base_m_s2[1]);
        let (mut beyond_kg, mut absolute) = (0.0, vec![0.0; self.chain.len()]);
        for (i, link) in self.chain.links.iter().enumerate().rev() {
            let (sin, cos) = link.com_angle_rad.sin_cos();
            let moment = link.mass_kg * link.com_m;
            let along = moment * cos + link.length_m * beyond_kg;
            absolute[i] = std::f64::consts::PI - (moment * sin).atan2(along) - turn;
            beyond_kg += link.mass_kg;
        }
        let relative = |i: usize| absolute[i] - if i > 0 { absolute[i - 1] } else { 0.0 };
        let off = (0..absolute.len()).map(|i| relative(i) - self.pose_rad[i]);
        // The nearest turn.
        off.map(|a| a - std::f64::consts::TAU * (a / std::f64::consts::TAU).round())
            .collect()
    }

    /// Into how many steps of what length a span is cut, s.
    #[inline]
    pub(super) fn steps(&self, span_s: f64) -> (usize, f64) {
        let steps = (span_s / self.step_s - 1e-6).ceil().max(1.0);
        (steps as usize, span_s / steps)
    }

    /// Goes on for `span_s` under constant drive torques.
    #[inline]
    pub(super) fn advance(&self, body: &mut Body, torque_nm: &[f64], span_s: f64) {
        let (steps, h) = self.steps(span_s);
        match &self.equations {
            Equations::One(dense) => self.few(dense, body, torque_nm, h, steps),
            Equations::Two(dense) => self.few(dense, body, torque_nm, h, steps),
            Equations::Three(dense) => self.few(dense, body, torque_nm, h, steps),
            Equations::Four(dense) => self.few(dense, body, torque_nm, h, steps),
            Equations::Many => {
                self.push(body, torque_nm);
                self.many(body, h, steps);
            }
        }
    }

    /// Torques on the joints: the drives' and those from outside.
    #[inline]
    fn push(&self, body: &mut Body, torque_nm: &[f64]) {
        body.torque.copy_from_slice(&self.disturbance_nm);
        for (&joint, &torque) in self.driven.iter().zip(torque_nm) {
            body.torque[joint] += torque;
        }
    }

    #[inline]
    fn few<const N: usize>(
        &self,
        dense: &Dense<N>,
        body: &mut Body,
        torque_nm: &[f64],
        h: f64,
        steps: usize,
    ) {
        let mut state = self.absolute(body, torque_nm);
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
    pub(super) fn absolute<const N: usize>(
        &self,
        body: &mut Body,
        torque_nm: &[f64],
    ) -> Absolute<N> {
        self.push(body, torque_nm);
        let mut state = Absolute::default();
        let (mut angle, mut speed) = (0.0, 0.0);
        for i in 0..N {
            angle += self.pose_rad[i] + body.angle_rad[i];
            speed += body.speed_rad_s[i];
            (state.angle_rad[i], state.speed_rad_s[i]) = (angle, speed);
            let beyond = if i + 1 < N { body.torque[i + 1] } else { 0.0 };
            state.load_nm[i] = body.torque[i] - beyond;
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

    fn many(&self, body: &mut Body, h: f64, steps: usize) {
        let n = self.chain.len();
        let Body {
            angle_rad,
            speed_rad_s,
            torque,
            many,
        } = body;
        let Some(many) = many else { return };
        for _ in 0..steps {
            for i in 0..n {
                many.angle[i] = self.pose_rad[i] + angle_rad[i];
                many.speed[0][i] = speed_rad_s[i];
            }
            for stage in 0..4 {
                self.chain.forward(
                    &mut many.work,
                    self.base_m_s2,
                    &many.angle,
                    &many.speed[stage],
                    torque,
                    &many.held,
                    &mut many.slope[stage],
                );
                if stage < 3 {
                    let share = if stage == 2 { h } else { h / 2.0 };
                    for i in 0..n {
                        many.angle[i] =
                            self.pose_rad[i] + angle_rad[i] + share * many.speed[stage][i];
                        many.speed[stage + 1][i] = speed_rad_s[i] + share * many.slope[stage][i];
                    }
                }
            }
            for i in 0..n {
                let sum = |k: &[Vec<f64>; 4]| (k[0][i] + k[3][i]) + 2.0 * (k[1][i] + k[2][i]);
                angle_rad[i] += h / 6.0 * sum(&many.speed);
                speed_rad_s[i] += h / 6.0 * sum(&many.slope);
            }
        }
    }
}

/// A state in absolute angles, joint 1's from hanging.
#[derive(Debug, Clone, Copy)]
pub(super) struct Absolute<const N: usize> {
    pub(super) angle_rad: [f64; N],
    pub(super) speed_rad_s: [f64; N],
    pub(super) load_nm: [f64; N],
}

impl<const N: usize> Default for Absolute<N> {
    fn default() -> Self {
        Absolute {
            angle_rad: [0.0; N],
            speed_rad_s: [0.0; N],
            load_nm: [0.0; N],
        }
    }
}

/// The robot's state, as deviations from the pose, and scratch memory.
#[derive(Debug, Clone)]
pub(super) struct Body {
    pub(super) angle_rad: Vec<f64>,
    pub(super) speed_rad_s: Vec<f64>,
    torque: Vec<f64>,
    many: Option<Many>,
}

#[derive(Debug, Clone)]
struct Many {
    work: dynamics::Workspace,
    held: Vec<bool>,
    angle: Vec<f64>,
    speed: [Vec<f64>; 4],
    slope: [Vec<f64>; 4],
}

impl Body {
    pub(super) fn new(plant: &Plant) -> Self {
        let n = plant.joints();
        let zeros = || vec![0.0; n];
        let four = || [zeros(), zeros(), zeros(), zeros()];
        let many = matches!(plant.equations, Equations::Many).then(|| Many {
            work: dynamics::Workspace::new(n),
            held: vec![false; n],
            angle: zeros(),
            speed: four(),
            slope: four(),
        });
        Body {
            angle_rad: zeros(),
            speed_rad_s: zeros(),
            torque: zeros(),
            many,
        }
    }
}
