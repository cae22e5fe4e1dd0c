//! `handstand model export MODEL --to mjcf|urdf [-o FILE]`: a model for other simulators.
//!
//! MJCF is MuJoCo's format; URDF is read by most others. What the format cannot say is listed on
//! stderr. State space is written by `handstand gains MODEL --state-space FILE`, with the gains.
//!
//! ```console
//! $ handstand model export arm.toml --to mjcf -o arm.xml
//! ```
//!
//! Without `-o` the file's text goes to stdout. `--json` prints `format`, `file` (or null), `text`
//! (null where a file was written) and `not_carried` (`part`, `joint`, `why`).

use super::{Console, ExitStatus, input};
use handstand::Result;
use handstand::model::export::{Exported, mjcf, urdf};
use handstand::output::vacant;
use serde_json::json;
use std::path::PathBuf;

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
    if let Some(file) = &args.output {
        vacant(file, args.force)?;
    }
    let model = input::model(&args.model)?;
    model.planar_only("what a model changes is not written back into its robot's file")?;
    let (format, exported) = match args.to {
        ExportFormat::Mjcf => ("mjcf", mjcf(&model)),
        ExportFormat::Urdf => ("urdf", urdf(&model)),
    };
    let Exported { text, not_carried } = exported;
    if let Some(file) = &args.output {
        console.write(file, &text, args.force)?;
    }
    for missing in &not_carried {
        let joint = missing
            .joint
            .map_or(String::new(), |joint| format!(" of joint {joint}"));
        console.say(&format!(
            "not carried: {}{joint} ({})",
            missing.part, missing.why
        ));
    }
    let written = args.output.is_some();
    let data = json!({
        "format": format,
        "file": args.output,
        "text": (!written).then_some(&text),
        "not_carried": not_carried,
    });
    if console.json {
        console.data(&data)?;
    } else if !written {
        console.print(&text)?;
    }
    Ok(ExitStatus::Done)
}
