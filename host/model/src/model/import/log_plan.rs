//! A robot in space as the logs of it want its model: drives that take their inputs, their columns.

use super::space::{InSpace, Locked, in_space};
use super::tree::{JointMotion, TreeDrive, TreeJoint};
use super::{Imported, ImportedParts, SpacePlan, robot};
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

/// A servo that drives a joint where the robot's file has no drive for the log's input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoFigures {
    /// Duty per rad, or per rad/s, of error.
    pub gain: f64,
    /// Torque at standstill, N m.
    pub stall_torque_nm: f64,
    /// Speed without load, rad/s.
    pub no_load_speed_rad_s: f64,
    /// Moment of inertia of its rotor times the gear's ratio squared, kg m^2; that of the file is
    /// kept where it has one.
    pub armature_kg_m2: f64,
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
    let (_, tree) = robot(text, path, false)?;
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
    let (format, tree) = robot(text, path, false)?;
    let name = path.display().to_string();
    let mut found = in_space(&tree, &plan.locked, &name)?;
    let free = given_drives(&mut found, log);
    let parts = ImportedParts {
        format,
        text,
        tree: &tree,
    };
    Ok(parts.in_space(found, plan, Some((log, &free))))
}

/// Gives the joints the drives that take the log's inputs; addresses of the values that are
/// guesses.
fn given_drives(found: &mut InSpace, log: &LogPlan) -> Vec<String> {
    let mut free = Vec::new();
    for (index, (joint, plan)) in found.joints.iter_mut().zip(&log.joints).enumerate() {
        if joint.drive.name() == plan.drive {
            continue;
        }
        joint.drive = drive(joint, plan);
        let number = index + 1;
        let slides = joint.motion == JointMotion::Slide;
        let gain = match plan.drive {
            "position" if slides => "gain_per_m",
            "position" => "gain_per_rad",
            "speed" if slides => "gain_s_per_m",
            "speed" => "gain_s_per_rad",
            _ => continue,
        };
        free.push(format!("joint{number}.{gain}"));
        if joint.armature_kg_m2 == 0.0 {
            joint.armature_kg_m2 = plan.servo.armature_kg_m2;
            let key = if slides {
                "inertia_kg"
            } else {
                "inertia_kg_m2"
            };
            free.push(format!("armature@{number}.{key}"));
        }
    }
    free
}

fn drive(joint: &TreeJoint, plan: &JointPlan) -> TreeDrive {
    let servo = &plan.servo;
    let (stall_nm, limit_nm) = (servo.stall_torque_nm, servo.stall_torque_nm);
    let damping_nm_s = stall_nm / servo.no_load_speed_rad_s;
    match plan.drive {
        "torque" => TreeDrive::Torque(joint.most_nm),
        "duty" => TreeDrive::Duty {
            stall_nm,
            damping_nm_s,
            limit_nm: None,
        },
        "position" => TreeDrive::Position {
            stiffness_nm: servo.gain * stall_nm,
            damping_nm_s,
            limit_nm,
        },
        "speed" => TreeDrive::Speed {
            gain_nm_s: servo.gain * stall_nm,
            limit_nm,
        },
        _ => TreeDrive::None,
    }
}
