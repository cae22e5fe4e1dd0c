//! The operating point of a linear model: what holds the robot in a pose, and how each joint
//! answers small changes.

use super::error::DesignError;
use super::joint_slope::{JointAt, JointSlope};
use super::omitted::OmittedEffect;
use super::pose_text::check_pose;
use super::rigid::{Rigid, RigidAtPose};
use crate::effects::{Scope, Site};
use crate::model::{EffectInstance, Model};

/// Share of the largest gravity torque by which a passive joint may miss its equilibrium.
pub(super) const SLACK: f64 = 1e-6;

/// A pose with the inputs that hold it, and the first-order change of every joint's torque.
#[derive(Debug, Clone)]
pub(super) struct OperatingPoint {
    /// Inputs of the driven joints that hold the pose, each in the SI unit of its drive.
    pub inputs: Vec<f64>,
    pub rigid: RigidAtPose,
    /// One per joint.
    pub joints: Vec<JointSlope>,
    /// Effects without a derivative here; they count neither in `inputs` nor in `joints`.
    pub omitted: Vec<OmittedEffect>,
}

impl OperatingPoint {
    /// The operating point of a model in `pose_rad` (the model's convention of angles), by its
    /// smooth effects.
    ///
    /// # Errors
    /// A pose that is no equilibrium of the smooth effects, or that asks more of a drive than it
    /// can give.
    pub fn of(model: &Model, pose_rad: &[f64]) -> Result<OperatingPoint, DesignError> {
        check_pose(model, pose_rad)?;
        let relative_rad = model.relative_rad(pose_rad);
        let rigid = Rigid::of(model);
        let slack_nm = SLACK * rigid.largest_gravity_nm(&relative_rad);
        let mut point = OperatingPoint {
            inputs: Vec::new(),
            rigid: rigid.at(&relative_rad),
            joints: Vec::new(),
            omitted: of_base(model).collect(),
        };
        for joint in 0..model.link_count() {
            let at = JointAt::new(model, joint, &relative_rad, pose_rad);
            let held = at.held(point.rigid.gravity_nm[joint], slack_nm)?;
            point.inputs.extend(held.input);
            point.joints.push(held.slope);
            point.omitted.extend(held.omitted);
        }
        Ok(point)
    }
}

/// Effects by which the base gives way: states that the equations do not have.
fn of_base(model: &Model) -> impl Iterator<Item = OmittedEffect> {
    let gives_way = |e: &&EffectInstance| {
        let mut rig = model.rig(false);
        rig.base_spring = None;
        let info = e.effect.info();
        if (info.site, info.scope) == (Site::Body, Scope::WholeRig) {
            e.effect.body(&e.values, 0, &mut rig);
        }
        rig.base_spring.is_some()
    };
    let instances = model.effects.iter().filter(gives_way);
    instances.map(|e| OmittedEffect::new(e.effect, None))
}

/// The delay of the drives, s: the same for all of them.
///
/// # Errors
/// Drives that differ in delay.
pub fn input_delay_s(model: &Model) -> Result<f64, DesignError> {
    let delay = |joint: usize| -> f64 {
        // An empty sum would be -0.
        model
            .effects_at(joint)
            .fold(0.0, |sum, e| sum + e.effect.delay_s(&e.values))
    };
    let delays: Vec<f64> = model.driven_joints().into_iter().map(delay).collect();
    let first = delays.first().copied().unwrap_or(0.0);
    match delays.iter().find(|&&delay| delay != first) {
        None => Ok(first),
        Some(other) => Err(DesignError::model(
            format!("the drives differ in delay: {first} s and {other} s"),
            "give every driven joint the same delay, or choose one with --delay",
        )),
    }
}
