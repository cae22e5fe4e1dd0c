//! `handstand add MODEL EFFECT[@JOINT] --fit LOG... -o NEW.toml`: a model with one more effect.
//!
//! The effect's values are fitted along with the model's free ones, from each of the effect's start
//! values; the best is kept. The new file is the old one with the refitted values and, at its end,
//! the effect with its intervals, the logs it was fitted to, and the error without and with it. The
//! error without it is that of the model refitted without it, so that the reduction is the effect's
//! alone; `handstand compare` sets models side by side as they are, where the reduction is also the
//! refit's.
//!
//! ```console
//! $ handstand add arm.toml delay --fit a.csv b.csv --holdout c.csv -o better.toml
//! ```
//!
//! Exit code 1, and no file, when the logs do not determine the values. `--json` prints what
//! `handstand fit` prints, and `effect`, as `delay@1`.

use super::{ExitStatus, Talk, fit, input};
use handstand::fitting::{Candidate, refit_with};
use handstand::log::LogRequest;
use handstand::model::edit;
use handstand::{Model, Result};
use std::path::PathBuf;

/// Add an effect to a model, its parameters fitted to logs.
#[derive(Debug, clap::Args)]
pub struct AddArgs {
    /// Model file
    model: PathBuf,
    /// The effect: `delay`, or `coulomb@2` where there are several joints
    effect: String,
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
    let candidate = Candidate::named(&args.effect, &model)?;
    let split = args.fit.motions(&model, &args.logs)?;
    let horizon = args.fit.judging.run.horizon;
    let bar = talk.bar(0).with_message(format!("starts of {candidate}"));
    let refitted = refit_with(&model, candidate, &split, horizon, &|done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    drop(bar);
    let refitted = match refitted {
        Ok(refitted) => refitted,
        Err(why) => return fit::refuse(&why, talk),
    };
    let text = edit::set_values(&text, &args.model, &refitted.values_of(&model))?;
    let (effect, fitted) = refitted.added(candidate, input::files(&split.training));
    let text = edit::add_effect(&text, &args.model, &effect, Some(&fitted))?;
    let before = "for the model refitted without it";
    fit::write(&refitted, &text, Some(candidate), before, &args.fit, talk)
}
