//! `handstand init LOG --robot ROBOT.urdf`: a model of a robot in space whose `[log]` is the log's.

use super::InitArgs;
use crate::cli::import::{check_in_space, locked, seen_from, tell};
use crate::cli::{Console, ExitStatus, input};
use handstand::Result;
use handstand::log::RawLog;
use handstand::log::init::{LerobotUnit, RobotDraft, RobotRequest};
use handstand::log::lerobot::Calibration;
use handstand::model::import::{Locked, SpacePlan};
use serde_json::json;
use std::path::{Path, PathBuf};

/// A robot's file beside the log.
#[derive(Debug, clap::Args)]
pub struct RobotArgs {
    /// URDF or MJCF file of the robot: a model in space, its columns by the joints' names
    #[arg(long, value_name = "ROBOT")]
    #[arg(conflicts_with_all = ["angle_zero", "angles", "length", "mass"])]
    pub robot: Option<PathBuf>,
    /// Joint of the robot that is held, and where, rad or m
    #[arg(long, num_args = 1.., value_name = "NAME=VALUE", requires = "robot")]
    #[arg(value_parser = locked)]
    lock: Vec<Locked>,
    /// Joint of the robot, and what the log calls it
    #[arg(long, num_args = 1.., value_name = "JOINT=NAME", requires = "robot")]
    #[arg(value_parser = mapped)]
    map: Vec<(String, String)>,
    /// LeRobot's calibration of the robot, which per cent of a joint's range refer to
    #[arg(long, value_name = "FILE.json", requires = "robot")]
    calibration: Option<PathBuf>,
    /// In what LeRobot's code wrote the angles, in a data set or any table
    #[arg(long, value_parser = ["rad", "deg", "percent"], requires = "robot")]
    unit: Option<String>,
}

/// `JOINT=NAME`.
fn mapped(text: &str) -> std::result::Result<(String, String), String> {
    let pair = text
        .split_once('=')
        .filter(|(joint, name)| !joint.is_empty() && !name.is_empty());
    let (joint, name) = pair.ok_or("write JOINT=NAME, as gripper=main_gripper")?;
    Ok((joint.to_string(), name.to_string()))
}

/// Matches, imports, writes.
pub(super) fn run(
    args: &InitArgs,
    robot: &Path,
    log: &RawLog,
    console: &Console,
) -> Result<ExitStatus> {
    let own = &args.robot;
    let text = input::text(robot)?;
    let calibration = own
        .calibration
        .as_deref()
        .map(Calibration::read)
        .transpose()?;
    let space = SpacePlan {
        robot: seen_from(args.output.as_deref(), robot),
        locked: own.lock.clone(),
    };
    let request = RobotRequest {
        text: &text,
        file: robot,
        space: &space,
        name: args.name.as_deref(),
        mapped: &own.map,
        calibration: calibration.as_ref(),
        unit: own.unit.as_deref().and_then(LerobotUnit::named),
        drive: args.drive.as_deref(),
    };
    let draft = RobotDraft::of(log, &args.log.name(), &request)?;
    if let Some(drive) = args.drive.as_deref().filter(|own| !draft.has_input_of(own)) {
        return Err(super::no_input(args, drive, log));
    }
    let RobotDraft {
        imported, guesses, ..
    } = draft;
    super::tell(&guesses, console);
    tell(&imported, console);
    check_in_space(&imported, args.output.as_deref())?;
    if let Some(file) = &args.output {
        console.write(file, &imported.toml, args.force)?;
        let (model, log) = (file.display(), &args.log);
        console.say(&format!("next: handstand compare {model} {log}"));
    }
    let data = json!({
        "guesses": guesses,
        "values": [],
        "joints": imported.joints,
        "not_carried": imported.left_out,
        "notes": imported.notes,
    });
    console.made(args.output.as_deref(), &imported.toml, data)?;
    Ok(ExitStatus::Done)
}
