//! A model of a robot in space, begun from its file and a log.

use super::{LerobotUnit, RobotLog, robot_log};
use crate::RawLog;
use crate::error::Result;
use crate::init::Guess;
use crate::lerobot::Calibration;
use crate::model::import::{Imported, SpacePlan, import_for_log, moving_joints};
use std::path::Path;

/// A robot's file, and what its owner knows of the log.
#[derive(Debug, Clone, Copy)]
pub struct RobotRequest<'a> {
    /// The text of the URDF or MJCF file.
    pub text: &'a str,
    /// What errors call the file.
    pub file: &'a Path,
    /// What the model calls the file, and joints that are held.
    pub space: &'a SpacePlan,
    /// Name of the rig; that of the robot without.
    pub name: Option<&'a str>,
    /// Joints of the robot with what the log calls them, where the names do not tell.
    pub mapped: &'a [(String, String)],
    /// What per cent are of.
    pub calibration: Option<&'a Calibration>,
    /// In what angles are written, where the user knows.
    pub unit: Option<LerobotUnit>,
    /// Which input drives the joints, where the user knows.
    pub drive: Option<&'a str>,
}

/// A model of a robot in space whose `[log]` is a log's, and what was guessed of it.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotDraft {
    /// The model.
    pub imported: Imported,
    /// What was guessed, and why.
    pub guesses: Vec<Guess>,
    drives: Vec<&'static str>,
}

impl RobotDraft {
    /// Begins a model of a robot and of a log that `log_name` names.
    ///
    /// # Errors
    /// As [`crate::init::Draft::of`] and [`import_for_log`]; joints that no name means, or several;
    /// a data set without names; a calibration of another robot, and values that its unit does not
    /// have.
    pub fn of(log: &RawLog, log_name: &str, robot: &RobotRequest) -> Result<RobotDraft> {
        let joints = moving_joints(robot.text, robot.file, &robot.space.locked)?;
        let ask = RobotLog {
            joints: &joints,
            mapped: robot.mapped,
            calibration: robot.calibration,
            unit: robot.unit,
            drive: robot.drive,
        };
        let (mut plan, guesses) = robot_log(log, log_name, &ask)?;
        plan.name = robot.name.map(str::to_string);
        let imported = import_for_log(robot.text, robot.file, robot.space, &plan)?;
        Ok(RobotDraft {
            imported,
            guesses,
            drives: plan.joints.iter().map(|joint| joint.drive).collect(),
        })
    }

    /// Whether the log holds an input that such a drive takes.
    pub fn has_input_of(&self, drive: &str) -> bool {
        drive == "passive" || self.drives.contains(&drive)
    }
}
