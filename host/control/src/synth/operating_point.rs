//! The operating point of a linear model: what holds the robot in a pose, and how each joint
//! answers small changes.

use super::error::DesignError;
use super::joint_slope::{JointAt, JointSlope};
use super::omitted::OmittedEffect;
use super::pose::check_size;
use crate::dynamics::EquationsOfMotion;
use crate::effects::{Scope, Site};
use crate::model::{EffectInstance, Model};

/// Share of the largest gravity torque by which a passive joint may miss its equilibrium.
const SLACK: f64 = 1e-6;

/// A pose with the inputs that hold it, and the first-order change of every joint's torque.
#[derive(Debug, Clone)]
pub(super) struct OperatingPoint {
    /// Inputs of the driven joints that hold the pose, each in the SI unit of its drive.
    pub inputs: Vec<f64>,
    /// Relative angles, the first from hanging, rad.
    pub relative_rad: Vec<f64>,
    pub equations: EquationsOfMotion,
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
        check_size(model, pose_rad)?;
        let relative_rad = model.relative_rad(pose_rad);
        let equations = equations(model);
        let gravity_nm = equations.gravity(&relative_rad);
        let mut level_rad = relative_rad.clone();
        if let Some(hinge) = model.joints.iter().position(|joint| joint.slide.is_none()) {
            level_rad[hinge] += std::f64::consts::FRAC_PI_2;
        }
        let largest_nm = gravity_nm.amax().max(equations.gravity(&level_rad).amax());
        let mut point = OperatingPoint {
            inputs: Vec::new(),
            relative_rad,
            equations,
            joints: Vec::new(),
            omitted: of_base(model).collect(),
        };
        for (joint, &gravity_nm) in gravity_nm.iter().enumerate() {
            let at = JointAt::new(model, joint, &point.relative_rad, pose_rad);
            let held = at.held(gravity_nm, SLACK * largest_nm)?;
            point.inputs.extend(held.input);
            point.joints.push(held.slope);
            point.omitted.extend(held.omitted);
        }
        Ok(point)
    }
}

/// The equations of motion of a model's chain, body effects included, gears that give as if they
/// were rigid.
pub(super) fn equations(model: &Model) -> EquationsOfMotion {
    let mut model = model.clone();
    let rigid: Vec<_> = model.effects.iter().filter_map(|e| e.rigid()).collect();
    model.effects.extend(rigid);
    let rig = model.rig(false);
    EquationsOfMotion::new(&rig.chain, rig.gravity_turn_rad)
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
        Some(other) => Err(DesignError::DelaysDiffer {
            first_s: first,
            other_s: *other,
        }),
    }
}
