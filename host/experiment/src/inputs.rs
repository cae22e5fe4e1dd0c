//! From goals to what a drive is sent: a position servo takes the goal itself, the others what a
//! regulator would send that holds the simulated rig at the goal.

use super::condition::Condition;
use super::limits::ExperimentLimits;
use crate::dynamics::{EquationsOfMotion, SpatialTree, TreeAtPose};
use crate::excite::Excitation;
use crate::model::{Drive, Model, hanging};
use crate::motion::Motion;
use crate::sim::{Plant, PlantMemory, StartState, predict};

/// Stiffness and damping of the regulator per inertia: 1/s^2 and 1/s.
const STIFFNESS: f64 = 130.0;
const DAMPING: f64 = 10.0;
/// Largest duty that is sent.
const MOST_DUTY: f64 = 0.9;
/// Speed asked for per error of the angle, 1/s, of a drive that takes speeds.
const SPEED_PER_RAD: f64 = 5.0;

/// Angles that the driven joints are to go through, under a condition.
pub(super) struct Goals<'a> {
    pub excitation: &'a Excitation,
    pub condition: Condition,
}

impl Goals<'_> {
    /// A motion of its times and conditions; nothing is measured, every input is 0.
    fn blank(&self, model: &Model) -> Motion {
        let (count, joints) = (self.excitation.time_s.len(), model.link_count());
        let driven = |joint: usize| model.joints[joint].drive.is_driven();
        let input = |joint: usize| driven(joint).then(|| vec![0.0; count]);
        Motion {
            name: "experiment".to_string(),
            time_s: self.excitation.time_s.clone(),
            position_rad: vec![vec![f64::NAN; count]; joints],
            velocity_rad_s: vec![None; joints],
            input: (0..joints).map(input).collect(),
            supply_v: self.condition.supply_v.map(|volts| vec![volts; count]),
            torque_on: (self.excitation.drops()).then(|| self.excitation.torque_on.clone()),
            payload_kg: self.condition.payload_kg,
            turned: self.condition.turned,
            ..Motion::default()
        }
    }
}

/// The motion that these goals ask of a model, and the angles at which it begins at rest, rad in
/// the log's convention.
pub(super) fn asked(model: &Model, goals: &Goals, limits: &ExperimentLimits) -> (Motion, Vec<f64>) {
    let mut motion = goals.blank(model);
    let driven = model.driven_joints();
    let moved = limits.moved(model);
    // A driven joint that may not move stays where the logs had it.
    let row = |k: usize| -> Vec<f64> {
        let mut of_joints = limits.low_rad.clone();
        for (at, &joint) in moved.iter().enumerate() {
            of_joints[joint] = goals.excitation.angle_rad[k][at];
        }
        driven.iter().map(|&joint| of_joints[joint]).collect()
    };
    let mut start_rad = hanging(model);
    for (&joint, goal) in driven.iter().zip(row(0)) {
        start_rad[joint] = goal;
    }
    let plant = Plant::new(model, &motion).read_on_time();
    let regulator = GoalRegulator::new(model, &motion, limits);
    let mut state = at_rest(&plant, &start_rad);
    let mut memory = PlantMemory::default();
    let mut readings = vec![0.0; 2 * plant.signals()];
    for k in 0..motion.len() {
        let (now, next) = (row(k), row((k + 1).min(motion.len() - 1)));
        let angles = regulator.pose(&plant, &state, &driven, &now);
        for (at, &joint) in driven.iter().enumerate() {
            let goal = now[at];
            let rate = (next[at] - goal) * limits.hz;
            let is_on = goals.excitation.torque_on[k];
            let sent = if is_on {
                regulator.sent(&plant, &state, &angles, joint, (goal, rate))
            } else {
                0.0
            };
            if let Some(input) = &mut motion.input[joint] {
                // As the file has it.
                input[k] = (1e6 * sent).round() / 1e6;
            }
        }
        if k + 1 < motion.len() {
            state = predict(
                &plant,
                &motion,
                k..k + 2,
                &state,
                &mut memory,
                &mut readings,
            );
        }
    }
    (motion, start_rad)
}

/// A simulation's start at rest at these readings, rad in the log's convention.
pub(super) fn at_rest(plant: &Plant, reading_rad: &[f64]) -> StartState {
    StartState {
        angle_rad: plant.decode_rad(reading_rad),
        speed_rad_s: vec![0.0; reading_rad.len()],
        reading_slope: None,
    }
}

/// What a regulator must know of the rig's bodies.
enum Body {
    Chain(EquationsOfMotion),
    Tree(SpatialTree),
}

impl Body {
    fn of(model: &Model, motion: &Motion) -> Body {
        if let Some(tree) = model.tree() {
            return Body::Tree(tree);
        }
        let mut rig = model.rig(motion.turned);
        if motion.payload_kg > 0.0 {
            rig.chain.bolt_on(motion.payload_kg, model.log.payload_at_m);
        }
        Body::Chain(EquationsOfMotion::new(&rig.chain, rig.gravity_turn_rad))
    }

    /// A joint's inertia at a pose, kg m^2, and the torque that holds it there, N m.
    fn inertia_and_hold(&self, pose_rad: &[f64], joint: usize) -> (f64, f64) {
        let (mass, gravity) = match self {
            Body::Chain(equations) => (equations.mass(pose_rad), equations.gravity(pose_rad)),
            Body::Tree(tree) => {
                let at_pose = TreeAtPose::new(tree, pose_rad);
                (at_pose.mass(), at_pose.gravity())
            }
        };
        (mass[(joint, joint)], gravity[joint])
    }
}

/// Holds a simulated rig at goals: gravity fed forward, angle and speed fed back.
struct GoalRegulator<'a> {
    model: &'a Model,
    body: Body,
    torque_nm: f64,
}

impl<'a> GoalRegulator<'a> {
    fn new(model: &'a Model, motion: &Motion, limits: &ExperimentLimits) -> GoalRegulator<'a> {
        GoalRegulator {
            model,
            body: Body::of(model, motion),
            torque_nm: limits.torque_nm.unwrap_or(f64::INFINITY),
        }
    }

    /// Angles of all joints from the link before, rad: the driven ones at their goals.
    fn pose(&self, plant: &Plant, state: &StartState, driven: &[usize], goals: &[f64]) -> Vec<f64> {
        let joints = 0..self.model.link_count();
        let mut reading: Vec<f64> = joints.map(|j| plant.reading(j, state).0).collect();
        for (&joint, &goal) in driven.iter().zip(goals) {
            reading[joint] = goal;
        }
        plant.decode_rad(&reading)
    }

    /// What the drive of a joint is sent, in SI of its kind.
    fn sent(
        &self,
        plant: &Plant,
        state: &StartState,
        pose_rad: &[f64],
        joint: usize,
        (goal_rad, rate_rad_s): (f64, f64),
    ) -> f64 {
        let (angle, speed) = plant.reading(joint, state);
        let drive = &self.model.joints[joint].drive;
        let full_nm = match drive {
            Drive::Passive => return 0.0,
            Drive::Position { .. } => return goal_rad,
            Drive::Speed { .. } => return rate_rad_s + SPEED_PER_RAD * (goal_rad - angle),
            Drive::Torque => None,
            Drive::Duty(motor) => Some(motor.stall_torque_nm),
        };
        let (inertia, hold) = self.body.inertia_and_hold(pose_rad, joint);
        let back = STIFFNESS * (goal_rad - angle) + DAMPING * (rate_rad_s - speed);
        let torque = hold + inertia * back;
        let most = self
            .torque_nm
            .min(full_nm.map_or(f64::INFINITY, |full| MOST_DUTY * full));
        torque.clamp(-most, most) / full_nm.unwrap_or(1.0)
    }
}
