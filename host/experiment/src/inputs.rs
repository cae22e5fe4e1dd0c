//! From goals to what a drive is sent: a position servo takes the goal itself, the others what a
//! regulator would send that holds the simulated rig at the goal.

use super::condition::Condition;
use super::limits::ExperimentLimits;
use crate::dynamics::{EquationsOfMotion, SpatialTree, TreeAtPose};
use crate::excite::Excitation;
use crate::model::{Drive, Model, hanging};
use crate::motion::Motion;
use crate::sim::{Plant, PlantMemory, StartState, predict};
use nalgebra::DVector;

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
        let sent = if goals.excitation.torque_on[k] {
            let goals = driven.iter().zip(now.iter().zip(&next));
            let goals = goals.map(|(&joint, (goal, next))| Goal {
                joint,
                angle_rad: *goal,
                rate_rad_s: (next - goal) * limits.hz,
            });
            regulator.sent(&plant, &state, &goals.collect::<Vec<_>>())
        } else {
            vec![0.0; driven.len()]
        };
        for (&joint, sent) in driven.iter().zip(sent) {
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
        let rig = model.rig_with(motion.turned, motion.payload_kg);
        rig.tree.map_or_else(
            || Body::Chain(EquationsOfMotion::new(&rig.chain, rig.gravity_turn_rad)),
            Body::Tree,
        )
    }

    /// Torques that hold the bodies at a pose and speed them up so, N m, other speeds left aside.
    fn torques_nm(&self, pose_rad: &[f64], accelerations_rad_s2: &DVector<f64>) -> DVector<f64> {
        let (mass, gravity) = match self {
            Body::Chain(equations) => (equations.mass(pose_rad), equations.gravity(pose_rad)),
            Body::Tree(tree) => {
                let at_pose = TreeAtPose::new(tree, pose_rad);
                (at_pose.mass(), at_pose.gravity())
            }
        };
        gravity + mass * accelerations_rad_s2
    }
}

/// Where a driven joint is to be, in the log's convention, and how fast.
struct Goal {
    joint: usize,
    angle_rad: f64,
    rate_rad_s: f64,
}

/// Holds a simulated rig at goals: gravity fed forward, angle and speed fed back as accelerations.
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

    /// What the drives are sent, in SI of their kinds.
    fn sent(&self, plant: &Plant, state: &StartState, goals: &[Goal]) -> Vec<f64> {
        let torques_nm = self.torques_nm(plant, state, goals);
        let sent = goals.iter().map(|goal| {
            let full_nm = match &self.model.joints[goal.joint].drive {
                Drive::Passive => return 0.0,
                Drive::Position { .. } => return goal.angle_rad,
                Drive::Speed { .. } => {
                    let (angle_rad, _) = plant.reading(goal.joint, state);
                    return goal.rate_rad_s + SPEED_PER_RAD * (goal.angle_rad - angle_rad);
                }
                Drive::Torque => None,
                Drive::Duty(motor) => Some(motor.stall_torque_nm),
            };
            let most = self
                .torque_nm
                .min(full_nm.map_or(f64::INFINITY, |full| MOST_DUTY * full));
            torques_nm[goal.joint].clamp(-most, most) / full_nm.unwrap_or(1.0)
        });
        sent.collect()
    }

    /// Torques with the driven joints at their goals, N m; of a chain whose drives take none, 0.
    fn torques_nm(&self, plant: &Plant, state: &StartState, goals: &[Goal]) -> DVector<f64> {
        let joints = self.model.link_count();
        let mut back = DVector::zeros(joints);
        let takes_torque = |goal: &Goal| {
            let drive = &self.model.joints[goal.joint].drive;
            matches!(drive, Drive::Torque | Drive::Duty(_))
        };
        if !goals.iter().any(takes_torque) {
            return back;
        }
        let mut reading: Vec<f64> = (0..joints).map(|j| plant.reading(j, state).0).collect();
        for goal in goals {
            let (angle_rad, speed_rad_s) = plant.reading(goal.joint, state);
            back[goal.joint] = STIFFNESS * (goal.angle_rad - angle_rad)
                + DAMPING * (goal.rate_rad_s - speed_rad_s);
            reading[goal.joint] = goal.angle_rad;
        }
        self.body.torques_nm(&plant.decode_rad(&reading), &back)
    }
}
