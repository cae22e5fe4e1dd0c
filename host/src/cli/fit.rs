//! `handstand fit MODEL LOG... -o NEW.toml`: a model's free values, fitted to logs.
//!
//! Free are the values the model's `[fit]` names, or those that `--free` names instead. `--bounds`
//! keeps a value between two others, and writes that into the new file, where later fits and
//! diagnoses heed it. The new file is the old one with new values, and where they came from;
//! comments and layout stay.
//!
//! ```console
//! $ handstand fit arm.toml swing.csv --free coulomb@1.torque_nm -o fitted.toml
//! ```
//!
//! Exit code 1, and no file, when the logs do not determine the values. `--json` prints `model`
//! (the new file), `values` (`path`, `key`, `unit`, `value`, `low`, `high`, `on_bound`), `error`
//! (`before_rad`, `after_rad`, `floor_rad`, `held_out`), `horizon_s`, `converged`, `warnings`; or
//! `refused`, `blind` and `mixed`.

use super::{Console, ExitStatus, input, show};
use handstand::fitting::{Refitted, Undetermined, freed, refit, with_refitted};
use handstand::log::LogRequest;
use handstand::model::edit::{moved, set_bounds};
use handstand::model::{JointNames, ParameterPath};
use handstand::report::{refitted_json, refitted_text};
use handstand::{Model, Result, output};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Fit a model's free parameters to logs.
#[derive(Debug, clap::Args)]
pub struct FitArgs {
    /// Model file
    model: PathBuf,
    /// Logs to fit
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    /// Value to fit instead of those the model frees: `link1.com_m`, `coulomb@1.torque_nm`
    #[arg(long, value_name = "PATH")]
    free: Vec<String>,
    /// Bounds that a value is kept in, also by later fits and diagnoses: `link1.com_m=0.05..0.2`,
    /// `joint1.gain_per_rad=4..inf`
    #[arg(long, value_name = "PATH=LOW..HIGH")]
    bounds: Vec<String>,
    #[command(flatten)]
    fit: input::RefitArgs,
}

/// Fits, writes, prints.
pub fn run(args: &FitArgs, console: &Console) -> Result<ExitStatus> {
    let text = bounded(args)?;
    let mut model = Model::parse(&text, &args.model)?;
    input::tell_joints(&model, console);
    let free = freed(&mut model, &args.free)?;
    let split = args.fit.motions(&model, &args.logs, console)?;
    let horizon = args.fit.judging.run.horizon;
    let refitted = refit(&model, &free, &split, horizon, &console.progress());
    let names = JointNames::of(&model);
    let refitted = match refitted {
        Ok(refitted) => refitted,
        Err(why) => return refuse(&why, &names, console),
    };
    let text = with_refitted(&text, &args.model, &model, &refitted, &split)?;
    let before = "for the model as it was";
    let text = (text.as_str(), args.model.as_path());
    let written = (&[][..], before, &names);
    write(&refitted, text, written, &args.fit, console)
}

/// The model's text with the bounds that were asked for.
fn bounded(args: &FitArgs) -> Result<String> {
    let text = input::model_text(&args.model)?;
    let model = Model::parse(&text, &args.model)?;
    let bounds = args.bounds.iter().map(|asked| {
        let (path, range) = asked.split_once('=').unwrap_or((asked, ""));
        let path = ParameterPath::read(path, &model)?;
        Ok((path, Some(input::range("bounds", range)?)))
    });
    match bounds.collect::<Result<Vec<_>>>()?.as_slice() {
        [] => Ok(text),
        bounds => set_bounds(&text, &args.model, bounds),
    }
}

/// Says why there is no new model.
pub fn refuse(why: &Undetermined, names: &JointNames, console: &Console) -> Result<ExitStatus> {
    let data = json!({
        "refused": why.to_string(),
        "blind": why.blind,
        "mixed": why.mixed,
        "hold": why.hold,
    });
    console.result(&data, || names.in_text(&show::undetermined(why)))?;
    Ok(ExitStatus::Refused)
}

/// Writes the new model and says what it holds: the effects that were added, which model left the
/// error before, and what the joints are called.
pub fn write(
    refitted: &Refitted,
    (text, model): (&str, &Path),
    (added, before, names): (&[String], &str, &JointNames),
    args: &input::RefitArgs,
    console: &Console,
) -> Result<ExitStatus> {
    let text = moved(text, model, &args.output)?;
    output::write_new(&args.output, &text, args.force)?;
    if console.json {
        let mut data = refitted_json(refitted);
        data["model"] = json!(args.output.to_string_lossy());
        if !added.is_empty() {
            data["effects"] = json!(added);
        }
        console.data(&data)?;
    } else {
        console.print(&refitted_text(refitted, before, names))?;
        console.say(&format!("wrote {}", args.output.display()));
    }
    Ok(ExitStatus::Done)
}
