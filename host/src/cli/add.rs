//! `handstand add MODEL EFFECT[@JOINT]... --fit LOG... -o NEW.toml`: a model with more effects.
//!
//! The effects' values are fitted along with the model's free ones, by the ways that a diagnosis
//! takes and from each of the effects' start values; the best is kept. On the motions fitted it
//! leaves no more than the model refitted without the effects. The new file is the old one with the refitted values and, at its end,
//! the effects with their intervals, the logs it was fitted to, and the error without and with it;
//! those of the values it had are renewed. The error without it is that of the model refitted
//! without it, so that the reduction is the effect's alone; `handstand compare` sets models side by
//! side as they are, where the reduction is also the refit's.
//!
//! ```console
//! $ handstand add arm.toml delay --fit a.csv b.csv --holdout c.csv -o better.toml
//! ```
//!
//! Exit code 1, and no file, when the logs do not determine the values, when the fit did not find
//! any that reduce the error of the motions fitted by a thousandth at least, or when that on the
//! motions held out is not reduced by as much. `--json` prints what `handstand fit`
//! prints, and `effects`, as `["delay@1"]`.

use super::{ExitStatus, Talk, fit, input};
use handstand::fitting::{Addition, Unhelpful, add_effects, candidates_named};
use handstand::log::LogRequest;
use handstand::{Model, Result};
use serde_json::json;
use std::path::PathBuf;

/// Add effects to a model, their parameters fitted to logs.
#[derive(Debug, clap::Args)]
pub struct AddArgs {
    /// Model file
    model: PathBuf,
    /// The effects: `delay`, or `coulomb@2` where there are several joints
    #[arg(required = true, value_name = "EFFECT")]
    effects: Vec<String>,
    /// Logs to fit
    #[arg(long = "fit", required = true, num_args = 1..)]
    #[arg(value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    #[command(flatten)]
    fit: input::RefitArgs,
}

/// Fits, writes, prints.
pub fn run(args: &AddArgs, talk: &Talk) -> Result<ExitStatus> {
    let text = input::model_text(&args.model)?;
    let model = Model::parse(&text, &args.model)?;
    let candidates = candidates_named(&args.effects, &model)?;
    let split = args.fit.motions(&model, &args.logs, talk)?;
    let horizon = args.fit.judging.run.horizon;
    let names: Vec<String> = candidates.iter().map(ToString::to_string).collect();
    let (path, progress) = (&args.model, talk.progress());
    let added = add_effects(&text, path, &candidates, &split, horizon, &progress)?;
    // Nothing is printed beside the bar.
    drop(progress);
    match added {
        Addition::Added { text, refitted } => {
            let before = "for the model refitted without";
            fit::write(&refitted, &text, &names, before, &args.fit, talk)
        }
        Addition::Unhelpful(why) => refuse(&why, &names, talk),
        Addition::Undetermined(why) => fit::refuse(&why, talk),
    }
}

/// Says that the effects do not help, and writes nothing.
fn refuse(unhelpful: &Unhelpful, names: &[String], talk: &Talk) -> Result<ExitStatus> {
    let (error, why) = (unhelpful.error(), unhelpful.why(names));
    if talk.json {
        talk.data(&json!({ "refused": why, "error": error }))?;
    } else {
        let remedy = match unhelpful {
            Unhelpful::NotFound(_) => {
                "Shorter windows (`--horizon 1`) tell more of a motion that the model loses; other \
                 motions may show what these do not."
            }
            Unhelpful::NotReduced { .. } => {
                "`handstand diagnose` says which effect the logs ask for."
            }
        };
        talk.print(&format!("refused: {why}; nothing is written. {remedy}"))?;
    }
    Ok(ExitStatus::Refused)
}
