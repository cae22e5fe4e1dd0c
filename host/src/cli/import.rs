//! `handstand import ROBOT.urdf|ROBOT.xml -o MODEL.toml`: a model out of another simulator's file.
//!
//! Reads URDF and MJCF. The model is of the whole robot: the planar chain of its joints where they
//! make one, else the robot in space, with all of its hinges and slides but those held by
//! `--lock gripper=0.3`. A model in space names the robot's file, whose shape it keeps, and notes
//! its SHA-256; `--space` makes one of a planar chain too.
//!
//! `--joints` takes the planar chain of the joints named, from the base to the tip, `--planar` that
//! with most hinges; other joints are held where the file has them. Joints that make no planar
//! chain are refused with those of the robot that do.
//!
//! Masses, moments of inertia, armature, damping, friction, springs and actuators are carried over.
//! What is not carried is listed on stderr, and in the file, as are axes that are parallel but for
//! rounding, and moments of inertia that no body has.
//!
//! ```console
//! $ handstand import so101.urdf --drive position --lock gripper=0.3 -o arm.toml
//! $ handstand import robot.urdf --joints shoulder elbow -o arm.toml
//! ```
//!
//! A URDF says with what torque a joint may be driven, not by what: `--drive position` makes servos
//! that take angles of all joints, whose gain, torque, speed and rotor are guesses until a data
//! sheet or a fit tells them.
//!
//! Without `-o` the file's text goes to stdout. `--json` prints `format` (`urdf`, `mjcf`), `file`
//! (or null), `text` (null where a file was written), `joints`, `in_space`, `not_carried` and
//! `notes` (`part`, `name`, `line`, `why`).

use super::{Console, ExitStatus, input};
use handstand::Result;
use handstand::model::Model;
use handstand::model::import::{
    ImportPlan, Imported, JointDrives, Locked, SpacePlan, import, import_whole, told,
};
use handstand::output::vacant;
use serde_json::json;
use std::path::{Path, PathBuf};

/// What can drive a joint.
const DRIVES: [&str; 4] = ["torque", "duty", "position", "speed"];

/// Import a model from another simulator's file.
#[derive(Debug, clap::Args)]
pub struct ImportArgs {
    /// URDF or MJCF file
    #[arg(value_name = "ROBOT")]
    robot: PathBuf,
    /// Take the planar chain of these joints, from the base to the tip
    #[arg(long, num_args = 1.., value_name = "NAME")]
    joints: Vec<String>,
    /// Take the planar chain of the most hinges in a row
    #[arg(long, conflicts_with = "joints")]
    planar: bool,
    /// Take the robot in space, also where its joints make a planar chain
    #[arg(long, conflicts_with_all = ["joints", "planar"])]
    space: bool,
    /// Joint of a robot in space that is held, and where, rad or m
    #[arg(long, num_args = 1.., value_name = "NAME=VALUE")]
    #[arg(conflicts_with_all = ["joints", "planar"])]
    #[arg(value_parser = locked)]
    lock: Vec<Locked>,
    /// Drive joints without an actuator by a torque; they are passive without
    #[arg(long)]
    driven: bool,
    /// What drives the joints, whatever the file says; a servo's figures are guesses
    #[arg(long, value_parser = DRIVES, conflicts_with = "driven")]
    drive: Option<String>,
    /// Model file to write; stdout without it
    #[arg(long, short, value_name = "MODEL.toml")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// `NAME=VALUE`.
pub(super) fn locked(text: &str) -> std::result::Result<Locked, String> {
    let (name, value) = text
        .split_once('=')
        .ok_or("write NAME=VALUE, as gripper=0.3")?;
    let value: f64 = value.parse().map_err(|_| format!("{value} is no number"))?;
    if value.is_finite() {
        Ok((name.to_string(), value))
    } else {
        Err("a joint is held at a finite number".into())
    }
}

/// The robot's file as a model file beside `output` names it: relative where both are.
pub(super) fn seen_from(output: Option<&Path>, robot: &Path) -> String {
    let folder = output.and_then(Path::parent).unwrap_or(Path::new(""));
    if robot.is_absolute() || folder == Path::new("") {
        return robot.display().to_string();
    }
    match robot.strip_prefix(folder) {
        Ok(beside) => beside.display().to_string(),
        Err(_) => std::path::absolute(robot).map_or_else(
            |_| robot.display().to_string(),
            |path| path.display().to_string(),
        ),
    }
}

/// Says which joints there are, and what the model has in another way than the file.
pub(super) fn tell(imported: &Imported, console: &Console) {
    console.say(&format!("joints: {}", imported.joints.join(", ")));
    for note in told(&imported.notes) {
        console.say(&format!("note: {note}"));
    }
    for part in told(&imported.left_out) {
        console.say(&format!("not carried: {part}"));
    }
}

/// Refuses figures that no robot in space has: they are known once its file is read by its name.
pub(super) fn check_in_space(imported: &Imported, output: Option<&Path>) -> Result<()> {
    let file = output.unwrap_or(Path::new("model.toml"));
    Model::parse(&imported.toml, file).map(drop)
}

/// What is asked to drive the joints.
fn drives(args: &ImportArgs) -> JointDrives {
    let named = |own: &str| DRIVES.into_iter().find(|drive| *drive == own);
    match args.drive.as_deref().and_then(named) {
        Some(drive) => JointDrives::All(drive),
        None if args.driven => JointDrives::OrTorque,
        None => JointDrives::OfFile,
    }
}

/// The model that is asked for of a robot's text.
fn taken(args: &ImportArgs, text: &str) -> Result<Imported> {
    let space = SpacePlan {
        robot: seen_from(args.output.as_deref(), &args.robot),
        locked: args.lock.clone(),
    };
    if !args.planar && !args.space && args.joints.is_empty() {
        return import_whole(text, &args.robot, drives(args), &space);
    }
    let plan = ImportPlan {
        joints: args.joints.clone(),
        drives: drives(args),
        space: args.space.then_some(space),
    };
    import(text, &args.robot, &plan)
}

/// Imports, and lists what is not carried.
pub fn run(args: &ImportArgs, console: &Console) -> Result<ExitStatus> {
    if let Some(file) = &args.output {
        vacant(file, args.force)?;
    }
    let imported = taken(args, &input::text(&args.robot)?)?;
    tell(&imported, console);
    if imported.in_space {
        check_in_space(&imported, args.output.as_deref())?;
    }
    if let Some(file) = &args.output {
        console.write(file, &imported.toml, args.force)?;
    }
    let data = json!({
        "format": imported.format,
        "joints": imported.joints,
        "in_space": imported.in_space,
        "not_carried": imported.left_out,
        "notes": imported.notes,
    });
    console.made(args.output.as_deref(), &imported.toml, data)?;
    Ok(ExitStatus::Done)
}
