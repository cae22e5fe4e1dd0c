//! Poses in a model's own convention of angles, and the equilibrium next to one.

use super::error::DesignError;
use super::joint_slope::JointAt;
use super::operating_point::equations;
use crate::model::Model;
use nalgebra::DVector;

/// Of Newton's iteration.
const MOST_STEPS: usize = 100;
const LONGEST_STEP_RAD: f64 = 0.2;
/// The step after one so small is lost in rounding.
const SETTLED_RAD: f64 = 1e-9;

/// The equilibrium next to a pose: driven joints stay as they are, passive ones move to where they
/// balance.
///
/// This is the angle compensation that links with eccentric centres of mass need. Friction and
/// other effects without a derivative do not count: sticking may hold the robot elsewhere too.
///
/// # Errors
/// No equilibrium within reach of Newton's iteration.
pub fn balanced(model: &Model, pose_rad: &[f64]) -> Result<Vec<f64>, DesignError> {
    check_size(model, pose_rad)?;
    let driven = model.driven_joints();
    let joints = 0..model.link_count();
    let passive: Vec<usize> = joints.filter(|joint| !driven.contains(joint)).collect();
    let equations = equations(model);
    let mut angle_rad = model.relative_rad(pose_rad);
    for _ in 0..MOST_STEPS {
        let pose_rad = model.convention_rad(&angle_rad);
        if passive.is_empty() {
            return Ok(pose_rad);
        }
        let gravity_nm = equations.gravity(&angle_rad);
        let slope = equations.gravity_slope(&angle_rad);
        let mut left = DVector::zeros(passive.len());
        let mut slope = slope.select_rows(&passive).select_columns(&passive);
        for (i, &joint) in passive.iter().enumerate() {
            let at = JointAt::new(model, joint, &angle_rad, &pose_rad);
            let (own_nm, own) = at.torque(&mut Vec::new());
            left[i] = gravity_nm[joint] - own_nm;
            slope[(i, i)] -= own.per_rad;
        }
        let Some(step) = slope.lu().solve(&left) else {
            break;
        };
        for (&joint, step) in passive.iter().zip(step.iter()) {
            angle_rad[joint] -= step.clamp(-LONGEST_STEP_RAD, LONGEST_STEP_RAD);
        }
        if step.amax() < SETTLED_RAD {
            return Ok(model.convention_rad(&angle_rad));
        }
    }
    Err(DesignError::EquilibriumNotFound)
}

/// One angle per joint, all of them numbers.
pub(super) fn check_size(model: &Model, pose_rad: &[f64]) -> Result<(), DesignError> {
    if model.is_in_space() {
        return Err(DesignError::InSpace {
            model: model.name.clone(),
        });
    }
    let n = model.link_count();
    if pose_rad.len() != n {
        return Err(DesignError::PoseSize {
            angles: pose_rad.len(),
            joints: n,
        });
    }
    match pose_rad.iter().find(|angle| !angle.is_finite()) {
        None => Ok(()),
        Some(angle) => Err(DesignError::PoseAngle(*angle)),
    }
}
