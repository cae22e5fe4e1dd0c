//! `handstand model export MODEL --to mjcf|urdf [-o FILE]`: a model for other simulators.
//!
//! MJCF is MuJoCo's format; URDF is read by most others. What the format cannot say is listed on
//! stderr. State space is written by `handstand gains MODEL --state-space FILE`, with the gains.
//!
//! Of a robot in space the robot's own file is written with what the model changes: masses,
//! friction, rotors, gains. All else in it stays byte for byte, and the file itself as it is.
//!
//! ```console
//! $ handstand model export arm.toml --to mjcf -o arm.xml
//! ```
//!
//! Without `-o` the file's text goes to stdout. `--json` prints `format`, `file` (or null), `text`
//! (null where a file was written) and `not_carried` (`part`, `joint`, `why`); of a robot in space
//! `not_carried` has `joint_name`, too, and `relative_files` lists the meshes and the like that the
//! text names relative to the robot's folder.

use super::{Console, ExitStatus, input};
use handstand::model::export::{Exported, NotCarried, mjcf, robot_file, urdf};
use handstand::model::{Model, Robot};
use handstand::output::vacant;
use handstand::{Error, Result};
use serde_json::json;
use std::path::{Path, PathBuf};

/// What can be done with a model file.
#[derive(Debug, clap::Subcommand)]
pub enum ModelCommand {
    /// Export a model for other simulators
    Export(ModelExportArgs),
}

/// A format of another program.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub enum ExportFormat {
    /// MuJoCo's
    Mjcf,
    /// Of most other simulators
    Urdf,
}

/// Export a model for other simulators.
#[derive(Debug, clap::Args)]
pub struct ModelExportArgs {
    /// Model file
    model: PathBuf,
    /// Format
    #[arg(long, value_enum)]
    to: ExportFormat,
    /// File to write; stdout without it
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// Exports, and lists what is not carried.
pub fn export(args: &ModelExportArgs, console: &Console) -> Result<ExitStatus> {
    let model = input::model(&args.model)?;
    if let Some(file) = &args.output {
        spare_robot(args, file, &model)?;
        vacant(file, args.force)?;
    }
    let format = match args.to {
        ExportFormat::Mjcf => "mjcf",
        ExportFormat::Urdf => "urdf",
    };
    let exported = exported(args, &model, format)?;
    let Exported {
        text, not_carried, ..
    } = &exported;
    if let Some(file) = &args.output {
        console.write(file, text, args.force)?;
    }
    for missing in not_carried {
        console.say(&told(missing));
    }
    tell_files(args, &model, &exported, console);
    let mut data = json!({ "format": format, "not_carried": not_carried });
    if model.is_in_space() {
        data["relative_files"] = json!(exported.relative_files);
    }
    console.made(args.output.as_deref(), text, data)?;
    Ok(ExitStatus::Done)
}

/// The model's text in a format.
fn exported(args: &ModelExportArgs, model: &Model, format: &str) -> Result<Exported> {
    if model.is_in_space() {
        return robot_file(model, &args.model, format);
    }
    Ok(match args.to {
        ExportFormat::Mjcf => mjcf(model),
        ExportFormat::Urdf => urdf(model),
    })
}

/// Refuses to write the robot's file that the model is relative to, whatever `--force` says: read
/// with it, the model would be another.
fn spare_robot(args: &ModelExportArgs, output: &Path, model: &Model) -> Result<()> {
    let own = model.robot.as_ref().map(|robot| robot_path(args, robot));
    let same = |own: &PathBuf| match (own.canonicalize(), output.canonicalize()) {
        (Ok(own), Ok(output)) => own == output,
        _ => false,
    };
    match own.filter(same) {
        None => Ok(()),
        Some(own) => Err(Error::usage(
            format!(
                "{} is the robot's file that the model starts from",
                own.display()
            ),
            "write another file: its values would count twice, and `robot_sha256` refuses it",
        )),
    }
}

/// Where the robot's file is.
fn robot_path(args: &ModelExportArgs, robot: &Robot) -> PathBuf {
    let folder = args.model.parent().unwrap_or(Path::new(""));
    folder.join(&robot.file)
}

fn told(missing: &NotCarried) -> String {
    let joint = match (missing.joint, &missing.joint_name) {
        (Some(joint), Some(name)) => format!(" of joint {joint} {name}"),
        (Some(joint), None) => format!(" of joint {joint}"),
        (None, _) => String::new(),
    };
    format!("not carried: {}{joint} ({})", missing.part, missing.why)
}

/// Says that meshes are looked for beside the new file, where that is not beside the robot's.
fn tell_files(args: &ModelExportArgs, model: &Model, exported: &Exported, console: &Console) {
    let (Some(output), Some(robot)) = (&args.output, &model.robot) else {
        return;
    };
    let folder = |file: &Path| {
        let folder = file.parent().filter(|own| !own.as_os_str().is_empty());
        folder.unwrap_or(Path::new(".")).canonicalize().ok()
    };
    let elsewhere = folder(output) != folder(&robot_path(args, robot));
    let files = &exported.relative_files;
    if let Some(first) = files.first().filter(|_| elsewhere) {
        let more = match files.len() {
            1 => String::new(),
            count => format!(" and {} more", count - 1),
        };
        console.say(&format!(
            "{first}{more}: names relative to the folder of {}; copy the files, or write the \
             export there",
            robot.file
        ));
    }
}
