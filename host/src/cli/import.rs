//! `handstand import ROBOT.urdf|ROBOT.xml [--joints NAME...] -o MODEL.toml`: a model out of another
//! simulator's file.
//!
//! Reads URDF and MJCF. The model is the planar chain of the joints named, from the base to the
//! tip; without names that with most hinges. Masses, moments of inertia, armature, damping,
//! friction, springs and actuators are carried over; other joints are held where the file has
//! them. What is not carried is listed on stderr, and in the file, as are axes that are parallel
//! but for rounding, and moments of inertia that no body has. Joints that make no planar chain are
//! refused with those of the robot that do.
//!
//! ```console
//! $ handstand import robot.urdf --joints shoulder elbow -o arm.toml
//! ```
//!
//! Without `-o` the file's text goes to stdout. `--json` prints `format` (`urdf`, `mjcf`), `file`
//! (or null), `text` (null where a file was written), `joints`, `not_carried` and `notes` (`part`,
//! `name`, `line`, `why`).

use super::{Console, ExitStatus, input};
use handstand::Result;
use handstand::model::import::{ImportPlan, import};
use handstand::output::vacant;
use serde_json::json;
use std::path::PathBuf;

/// Import a model from another simulator's file.
#[derive(Debug, clap::Args)]
pub struct ImportArgs {
    /// URDF or MJCF file
    #[arg(value_name = "ROBOT")]
    robot: PathBuf,
    /// Joints of the chain, from the base to the tip; the most hinges in a row without
    #[arg(long, num_args = 1.., value_name = "NAME")]
    joints: Vec<String>,
    /// Drive joints without an actuator by a torque; they are passive without
    #[arg(long)]
    driven: bool,
    /// Model file to write; stdout without it
    #[arg(long, short, value_name = "MODEL.toml")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// Imports, and lists what is not carried.
pub fn run(args: &ImportArgs, console: &Console) -> Result<ExitStatus> {
    if let Some(file) = &args.output {
        vacant(file, args.force)?;
    }
    let plan = ImportPlan {
        joints: args.joints.clone(),
        driven: args.driven,
    };
    let imported = import(&input::text(&args.robot)?, &args.robot, &plan)?;
    console.say(&format!("joints: {}", imported.joints.join(", ")));
    for note in &imported.notes {
        console.say(&format!("note: {note}"));
    }
    for part in &imported.left_out {
        console.say(&format!("not carried: {part}"));
    }
    if let Some(file) = &args.output {
        console.write(file, &imported.toml, args.force)?;
    }
    let written = args.output.is_some();
    let data = json!({
        "format": imported.format,
        "file": args.output,
        "text": (!written).then_some(&imported.toml),
        "joints": imported.joints,
        "not_carried": imported.left_out,
        "notes": imported.notes,
    });
    if console.json {
        console.data(&data)?;
    } else if !written {
        console.print(&imported.toml)?;
    }
    Ok(ExitStatus::Done)
}
