//! `handstand add MODEL EFFECT[@JOINT]... --fit LOG... -o NEW.toml`: a model with more effects.
//!
//! The effects' values are fitted along with the model's free ones, from each of the effects' start
//! values; the best is kept. The new file is the old one with the refitted values and, at its end,
//! the effects with their intervals, the logs it was fitted to, and the error without and with it;
//! those of the values it had are renewed. The error without it is that of the model refitted without it, so that the reduction is the effect's
//! alone; `handstand compare` sets models side by side as they are, where the reduction is also the
//! refit's.
//!
//! ```console
//! $ handstand add arm.toml delay --fit a.csv b.csv --holdout c.csv -o better.toml
//! ```
//!
//! Exit code 1, and no file, when the logs do not determine the values, or when the error on the
//! motions held out is not reduced. `--json` prints what `handstand fit` prints, and `effects`, as
//! `["delay@1"]`.

use super::{ExitStatus, Talk, fit, input};
use handstand::fitting::{Candidate, CandidateError, Refitted, refit_with};
use handstand::log::LogRequest;
use handstand::model::edit;
use handstand::output::number::mrad;
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
    let text = input::text(&args.model)?;
    let model = Model::parse(&text, &args.model)?;
    let mut candidates: Vec<Candidate> = Vec::new();
    for name in &args.effects {
        let candidate = Candidate::named(name, &model)?;
        if candidates.contains(&candidate) {
            return Err(CandidateError::InModel(candidate).into());
        }
        candidates.push(candidate);
    }
    let split = args.fit.motions(&model, &args.logs)?;
    let horizon = args.fit.judging.run.horizon;
    let names: Vec<String> = candidates.iter().map(ToString::to_string).collect();
    let bar = talk
        .bar(0)
        .with_message(format!("starts of {}", names.join(", ")));
    let refitted = refit_with(&model, &candidates, &split, horizon, &|done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    drop(bar);
    let refitted = match refitted {
        Ok(refitted) => refitted,
        Err(why) => return fit::refuse(&why, talk),
    };
    if refitted.error.after_rad >= refitted.error.before_rad {
        return refuse(&refitted, &names, talk);
    }
    let mut text = edit::set_values(&text, &args.model, &refitted.values_of(&model))?;
    let logs = input::files(&split.training);
    let old = refitted
        .record(logs.clone())
        .about(|path| path.get(&model).is_some());
    text = edit::renew_provenance(&text, &args.model, &old)?;
    for candidate in candidates {
        let (effect, fitted) = refitted.added(candidate, logs.clone());
        text = edit::add_effect(&text, &args.model, &effect, Some(&fitted))?;
    }
    let before = "for the model refitted without";
    fit::write(&refitted, &text, &names, before, &args.fit, talk)
}

/// Says that the effects do not help, and writes nothing.
fn refuse(refitted: &Refitted, names: &[String], talk: &Talk) -> Result<ExitStatus> {
    let error = &refitted.error;
    let motions = if error.held_out { "held-out" } else { "fitted" };
    let [before, after] = [error.before_rad, error.after_rad].map(mrad);
    let why = format!(
        "with {} the error on {motions} motions goes from {before} to {after} mrad",
        names.join(", ")
    );
    if talk.json {
        talk.data(&json!({ "refused": why, "error": error }))?;
    } else {
        talk.print(&format!(
            "refused: {why}; nothing is written. `handstand diagnose` says which effect the logs ask for."
        ))?;
    }
    Ok(ExitStatus::Refused)
}
