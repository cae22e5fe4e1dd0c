//! `handstand add MODEL EFFECT[@JOINT] --fit LOG... -o NEW.toml`: a model with one more effect.
//!
//! The effect's values are fitted along with the model's free ones, from every start value of the effect; the best is
//! kept. The new file is the old one with the refitted values and, at its end, the effect with its intervals,
//! the logs it was fitted to, and the error without and with it. The error without it is that of the model
//! refitted without it, so that the fall is the effect's alone; `handstand compare` sets models side by side as
//! they are, where the fall is also the refit's.
//!
//! ```console
//! $ handstand add arm.toml delay --fit a.csv b.csv --holdout c.csv -o better.toml
//! ```
//!
//! Exit code 1, and no file, when the logs do not determine the values. `--json` prints what `handstand fit`
//! prints, and `effect`, as `delay@1`.

use super::fitting::Fitting;
use super::talk::Talk;
use super::{Outcome, fit, input, name, show};
use handstand::diagnose::Candidate;
use handstand::fitting::{Extension, extend};
use handstand::log::LogRequest;
use handstand::model::edit::{self, Fitted};
use handstand::model::{EffectInstance, ParameterPath};
use handstand::{Model, Result, output};
use serde_json::json;
use std::path::PathBuf;

/// Add an effect to a model, its values fitted to logs.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Model file
    model: PathBuf,
    /// The effect: `delay`, or `coulomb@2` where there are several joints
    effect: String,
    /// Logs to fit
    #[arg(long = "fit", required = true, num_args = 1.., value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    #[command(flatten)]
    fitting: Fitting,
}

/// Fits, writes, prints.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let text = input::text(&args.model)?;
    let model = Model::parse(&text, &args.model)?;
    let candidate = name::candidate(&args.effect, &model)?;
    args.fitting.vacant()?;
    let split = input::motions(&model, &args.logs, &args.fitting.holdout)?;
    let bar = talk.bar().with_message(format!("starts of {candidate}"));
    let extension = extend(
        &model,
        candidate,
        &split,
        args.fitting.horizon,
        &|done, all| {
            bar.set_length(all as u64);
            bar.set_position(done as u64);
        },
    );
    bar.finish_and_clear();
    let extension = match extension {
        Ok(extension) => extension,
        Err(why) => return fit::refuse(&why, talk),
    };
    let base: Vec<(ParameterPath, f64)> = fit::values(&extension)
        .into_iter()
        .filter(|(path, _)| path.get(&model).is_some())
        .collect();
    let text = edit::set_values(&text, &args.model, &base)?;
    let fitted = fitted(&extension, candidate, input::files(&split.training));
    let effect = instance(&extension, candidate);
    let text = edit::add_effect(&text, &args.model, &effect, Some(&fitted))?;
    output::write_new(&args.fitting.output, &text, args.fitting.force)?;
    if talk.json {
        let mut data = show::extension_json(&extension);
        data["model"] = json!(args.fitting.output.to_string_lossy());
        data["effect"] = json!(candidate.to_string());
        talk.data(&data)?;
        return Ok(Outcome::Done);
    }
    fit::report(
        &extension,
        "for the model refitted without it",
        &args.fitting.output,
        talk,
    )
}

fn instance(extension: &Extension, candidate: Candidate) -> EffectInstance {
    let values: Vec<f64> = candidate
        .paths()
        .filter_map(|path| path.get(&extension.model))
        .collect();
    candidate.instance(&values)
}

fn fitted(extension: &Extension, candidate: Candidate, logs: Vec<(String, String)>) -> Fitted {
    let own: Vec<String> = candidate.paths().map(|path| path.to_string()).collect();
    let values = extension
        .values
        .iter()
        .filter(|value| own.contains(&value.path));
    Fitted {
        intervals: values
            .map(|value| (value.key.clone(), value.low, value.high))
            .collect(),
        logs,
        error_before: extension.error.before_rad,
        error_after: extension.error.after_rad,
        error_unit: "rad".to_string(),
    }
}
