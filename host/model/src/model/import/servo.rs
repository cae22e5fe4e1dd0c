//! Servos of which nothing is known but what their inputs are.

use super::JointDrives;
use super::remark::Remark;
use super::tree::{JointMotion, TreeDrive, TreeJoint};
use std::fmt;

/// A servo that drives a joint where the robot's file has no drive for its input.
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

impl ServoFigures {
    /// Those of a servo of which nothing is known: about an AX-12 or an STS3215.
    pub fn guessed(drive: &str) -> Self {
        ServoFigures {
            gain: if drive == "speed" { 0.5 } else { 8.0 },
            stall_torque_nm: 1.5,
            no_load_speed_rad_s: 6.0,
            armature_kg_m2: 0.01,
        }
    }
}

impl fmt::Display for ServoFigures {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{} N m at standstill, {} rad/s without load, a rotor of {} kg m^2 at the joint",
            self.stall_torque_nm, self.no_load_speed_rad_s, self.armature_kg_m2
        )
    }
}

/// Gives all joints the drive that is asked for, and notes it; addresses of the values that are
/// guesses.
pub(super) fn all_driven<'a>(
    drives: JointDrives,
    joints: impl IntoIterator<Item = &'a mut TreeJoint>,
    notes: &mut Vec<Remark>,
) -> Vec<String> {
    let JointDrives::All(drive) = drives else {
        return Vec::new();
    };
    let (servo, mut names, mut guessed) = (ServoFigures::guessed(drive), Vec::new(), Vec::new());
    for (index, joint) in joints.into_iter().enumerate() {
        if joint.drive.name() != drive {
            names.push(joint.name.clone());
            guessed.extend(driven_by(index, joint, drive, &servo));
        }
    }
    if !names.is_empty() && drive != "torque" {
        let why = format!(
            "of {}: {servo}, a guess: the data sheet says, or `handstand fit` estimates them",
            names.join(", ")
        );
        notes.push(Remark::new("motors", None, why));
    }
    guessed
}

/// Gives a joint a drive that takes such inputs, where the file has none; addresses of the values
/// that are guesses.
pub(super) fn driven_by(
    index: usize,
    joint: &mut TreeJoint,
    drive: &str,
    servo: &ServoFigures,
) -> Vec<String> {
    if joint.drive.name() == drive {
        return Vec::new();
    }
    joint.drive = of_servo(joint, drive, servo);
    let number = index + 1;
    let slides = joint.motion == JointMotion::Slide;
    let gain = match drive {
        "position" if slides => "gain_per_m",
        "position" => "gain_per_rad",
        "speed" if slides => "gain_s_per_m",
        "speed" => "gain_s_per_rad",
        _ => return Vec::new(),
    };
    let mut guessed = vec![format!("joint{number}.{gain}")];
    if joint.armature_kg_m2 == 0.0 {
        joint.armature_kg_m2 = servo.armature_kg_m2;
        let key = if slides {
            "inertia_kg"
        } else {
            "inertia_kg_m2"
        };
        guessed.push(format!("armature@{number}.{key}"));
    }
    guessed
}

fn of_servo(joint: &TreeJoint, drive: &str, servo: &ServoFigures) -> TreeDrive {
    let (stall_nm, limit_nm) = (servo.stall_torque_nm, servo.stall_torque_nm);
    let damping_nm_s = stall_nm / servo.no_load_speed_rad_s;
    match drive {
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
