//! Poses in a model's own convention of angles, and the equilibrium next to one.

use super::error::DesignError;
use super::joint_slope::JointAt;
use super::operating_point::SLACK;
use super::pose_text::check_pose;
use super::rigid::Rigid;
use crate::model::Model;
use nalgebra::DVector;

/// Of Newton's iteration.
const MOST_STEPS: usize = 100;
const LONGEST_STEP_RAD: f64 = 0.2;
/// The step after one so small is lost in rounding.
const SETTLED_RAD: f64 = 1e-9;
/// Slopes below this share of the steepest one are none.
const NO_SLOPE: f64 = 1e-9;

/// The equilibrium next to a pose: driven joints stay as they are, passive ones move to where they
/// balance.
///
/// This is the angle compensation that links with eccentric centres of mass need. Friction and
/// other effects without a derivative do not count: sticking may hold the robot elsewhere too.
///
/// # Errors
/// No equilibrium within reach of Newton's iteration.
pub fn balanced(model: &Model, pose_rad: &[f64]) -> Result<Vec<f64>, DesignError> {
    check_pose(model, pose_rad)?;
    let driven = model.driven_joints();
    let joints = 0..model.link_count();
    let passive: Vec<usize> = joints.filter(|joint| !driven.contains(joint)).collect();
    let rigid = Rigid::of(model);
    let mut angle_rad = model.relative_rad(pose_rad);
    for _ in 0..MOST_STEPS {
        let pose_rad = model.convention_rad(&angle_rad);
        if passive.is_empty() {
            return Ok(pose_rad);
        }
        let at_pose = rigid.at(&angle_rad);
        let mut left = DVector::zeros(passive.len());
        let slope = at_pose.gravity_slope;
        let mut slope = slope.select_rows(&passive).select_columns(&passive);
        for (i, &joint) in passive.iter().enumerate() {
            let at = JointAt::new(model, joint, &angle_rad, &pose_rad);
            let (own_nm, own) = at.torque(&mut Vec::new());
            left[i] = at_pose.gravity_nm[joint] - own_nm;
            slope[(i, i)] -= own.per_rad;
        }
        // A joint that gravity leaves alone, as one about a plumb axis, balances where it is.
        let split = slope.clone().svd(true, true);
        let least = NO_SLOPE * split.singular_values.max();
        let Ok(step) = split.solve(&left, least) else {
            break;
        };
        let unmoved_nm = (&slope * &step - &left).amax();
        for (&joint, step) in passive.iter().zip(step.iter()) {
            angle_rad[joint] -= step.clamp(-LONGEST_STEP_RAD, LONGEST_STEP_RAD);
        }
        if step.amax() < SETTLED_RAD {
            if unmoved_nm > SLACK * rigid.largest_gravity_nm(&angle_rad) {
                break;
            }
            return Ok(model.convention_rad(&angle_rad));
        }
    }
    Err(DesignError::model(
        "no equilibrium was found near this pose",
        "start from a pose nearer to balance",
    ))
}
