//! A robot in space as the logs of it want its model: drives that take their inputs, their columns.

use super::servo::{ServoFigures, driven_by};
use super::space::{Locked, in_space};
use super::tree::JointMotion;
use super::{Imported, ImportedParts, JointDrives, SpacePlan, robot};
use crate::error::Result;
use std::path::Path;

/// A joint of a robot in space that moves, as the robot's file has it.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingJoint {
    /// Its name in the file.
    pub name: String,
    /// Whether it slides, so that its coordinate is in m.
    pub slides: bool,
    /// Between which coordinates it moves, rad or m, where the file says it.
    pub range: Option<(f64, f64)>,
    /// What drives it in the file: `passive`, `torque`, `duty`, `position` or `speed`.
    pub drive: &'static str,
}

/// What a log holds of one joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPlan {
    /// The lines of its `[[log.joint]]`.
    pub columns: String,
    /// What its input is: `passive`, `torque`, `duty`, `position` or `speed`.
    pub drive: &'static str,
    /// What drives it where the file has another drive.
    pub servo: ServoFigures,
}

/// What a log holds of a robot in space.
#[derive(Debug, Clone, PartialEq)]
pub struct LogPlan {
    /// Name of the robot for reports; that of its file without.
    pub name: Option<String>,
    /// What is written at the head of the model's file, a comment each.
    pub comments: Vec<String>,
    /// The lines of `[log]` above those of the joints.
    pub head: String,
    /// One for each joint of [`moving_joints`], in their order.
    pub joints: Vec<JointPlan>,
}

/// The joints of a robot in space that move, in the order of its model; `path` only names the
/// file, `locked` are held.
///
/// # Errors
/// As [`super::import`], but for joints that make no planar chain.
pub fn moving_joints(text: &str, path: &Path, locked: &[Locked]) -> Result<Vec<MovingJoint>> {
    let (_, tree) = robot(text, path, JointDrives::OfFile)?;
    let found = in_space(&tree, locked, &path.display().to_string())?;
    let joints = found.joints.into_iter().map(|joint| MovingJoint {
        slides: joint.motion == JointMotion::Slide,
        range: joint.range_rad,
        drive: joint.drive.name(),
        name: joint.name,
    });
    Ok(joints.collect())
}

/// The model of a robot in space whose logs are as `log` says; `path` only names the robot's file.
///
/// A joint keeps the drive that its file has where that takes the log's input; another gets the
/// servo of the plan, which is a guess: `[rig] guessed` and `[fit] free` say so.
///
/// # Errors
/// As [`super::import`], but for joints that make no planar chain.
pub fn import_for_log(
    text: &str,
    path: &Path,
    plan: &SpacePlan,
    log: &LogPlan,
) -> Result<Imported> {
    let (format, tree) = robot(text, path, JointDrives::OfFile)?;
    let name = path.display().to_string();
    let mut found = in_space(&tree, &plan.locked, &name)?;
    let mut guessed = Vec::new();
    for (index, (joint, plan)) in found.joints.iter_mut().zip(&log.joints).enumerate() {
        guessed.extend(driven_by(index, joint, plan.drive, &plan.servo));
    }
    let parts = ImportedParts {
        format,
        text,
        tree: &tree,
    };
    Ok(parts.in_space(found, plan, Some(log), &guessed))
}
