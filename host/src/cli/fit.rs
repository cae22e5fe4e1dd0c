//! `handstand fit MODEL LOG... -o NEW.toml`: a model's free values, fitted to logs.
//!
//! Free are the values the model's `[fit]` names, or those that `--free` names instead. The new file is the old
//! one with new values; comments and layout stay.
//!
//! ```console
//! $ handstand fit arm.toml swing.csv --free coulomb@1.torque_nm -o fitted.toml
//! ```
//!
//! Exit code 1, and no file, when the logs do not determine the values. `--json` prints `model` (the new file),
//! `values` (`path`, `key`, `unit`, `value`, `low`, `high`, `on_bound`), `error` (`unit`, `before`, `after`,
//! `floor`, `held_out`), `horizon_s`, `converged`, `warnings`; or `refused` and `blind`.

use super::fitting::Fitting;
use super::talk::Talk;
use super::{Outcome, input, show};
use handstand::fitting::{Extension, Undetermined, refit};
use handstand::log::LogRequest;
use handstand::model::ParameterPath;
use handstand::{Error, Model, Result, model::edit, output};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Fit a model's free parameters to logs.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Model file
    model: PathBuf,
    /// Logs to fit
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    /// Value to fit instead of those the model frees: `link1.com_m`, `coulomb@1.torque_nm`
    #[arg(long, value_name = "PATH")]
    free: Vec<String>,
    #[command(flatten)]
    fitting: Fitting,
}

/// Fits, writes, prints.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let text = input::text(&args.model)?;
    let model = Model::parse(&text, &args.model)?;
    let free = free(&model, &args.free)?;
    args.fitting.vacant()?;
    let split = input::motions(&model, &args.logs, &args.fitting.holdout)?;
    let extension = match refit(&model, &free, &split, args.fitting.horizon) {
        Ok(extension) => extension,
        Err(why) => return refuse(&why, talk),
    };
    let text = edit::set_values(&text, &args.model, &values(&extension))?;
    output::write_new(&args.fitting.output, &text, args.fitting.force)?;
    report(
        &extension,
        "for the model as it was",
        &args.fitting.output,
        talk,
    )
}

/// The values to fit: those named, or the model's own.
fn free(model: &Model, named: &[String]) -> Result<Vec<ParameterPath>> {
    let mut free: Vec<ParameterPath> = Vec::new();
    for text in named {
        let path: ParameterPath = text.parse()?;
        match path.get(model) {
            None => {
                return Err(Error::usage(
                    format!("`{text}` is not in this model"),
                    "add its link, drive or effect to the model, or name another value",
                ));
            }
            Some(value) if !value.is_finite() => {
                return Err(Error::usage(
                    format!("`{text}` is infinite, so nothing can be fitted"),
                    "give it a value to start from in the model",
                ));
            }
            Some(_) if free.contains(&path) => {}
            Some(_) => free.push(path),
        }
    }
    if named.is_empty() {
        free.clone_from(&model.free);
    }
    if free.is_empty() {
        return Err(Error::usage(
            "no value is free to be fitted",
            "name one by --free link1.com_m, or under [fit] in the model",
        ));
    }
    Ok(free)
}

/// Addresses and values, for the model file.
pub fn values(extension: &Extension) -> Vec<(ParameterPath, f64)> {
    let values = extension.values.iter().map(|value| value.value);
    extension.free.iter().copied().zip(values).collect()
}

/// Says why there is no new model.
pub fn refuse(why: &Undetermined, talk: &Talk) -> Result<Outcome> {
    if talk.json {
        talk.data(&json!({ "refused": why.to_string(), "blind": why.blind }))?;
    } else {
        talk.print(&show::undetermined(why))?;
    }
    Ok(Outcome::Refused)
}

/// Says what the new model holds; `before` says which model left the error before.
pub fn report(extension: &Extension, before: &str, file: &Path, talk: &Talk) -> Result<Outcome> {
    if talk.json {
        let mut data = show::extension_json(extension);
        data["model"] = json!(file.to_string_lossy());
        talk.data(&data)?;
    } else {
        talk.print(&show::extension(extension, before))?;
        talk.say(&format!("wrote {}", file.display()));
    }
    Ok(Outcome::Done)
}
