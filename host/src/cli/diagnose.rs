//! `handstand diagnose MODEL LOG... [--holdout LOG]...`: which physical effect is missing from the model?
//!
//! Judges the logs first. Then every effect of the library that could act and be seen is tried, and what it
//! gains on motions that took no part in the fit decides. Without `--holdout` the last third of the motions is
//! held out; where there is but one motion, nothing can be said of new ones.
//!
//! ```console
//! $ handstand diagnose arm.toml a.csv b.csv --holdout c.csv --report report.html
//! ```
//!
//! The verdict is `nominal`, `named`, `ambiguous`, `unexplained` or `unfit`; exit code 1 for `unfit`, 0 for the
//! others, which are answers. `--json` prints the diagnosis; its keys are in `docs/json.md`.

use super::page::{self, Page, PageFile};
use super::talk::Talk;
use super::{Outcome, input, log};
use handstand::compare::{Comparison, compare};
use handstand::diagnose::words::{HELD_OUT, LOGS, MODEL};
use handstand::diagnose::{DiagnoseOptions, Diagnosis, FittedEffect, Verdict, diagnose};
use handstand::fitting::{Horizon, effect_named};
use handstand::log::{LogFinding, LogRequest, Severity, Split, read, split};
use handstand::report::{diagnosis_json, diagnosis_text, html};
use handstand::{Model, Result};
use std::path::PathBuf;

/// Diagnose which physical effect a model lacks, from logs.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Model file
    model: PathBuf,
    /// Logs to learn from
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    /// Effect to leave out of the candidates
    #[arg(long, value_name = "EFFECT")]
    without: Vec<String>,
    /// Seed of the random draws
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    #[command(flatten)]
    judging: input::Judging,
    #[command(flatten)]
    page: PageFile,
}

impl Args {
    /// The logs to learn from, then those to judge by.
    fn all_logs(&self) -> Vec<LogRequest> {
        [self.logs.as_slice(), &self.judging.holdout].concat()
    }
}

/// Diagnoses, prints, writes the page.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let diagnosis = find(args, talk)?;
    Ok(match diagnosis.verdict {
        Verdict::Unfit => Outcome::Refused,
        _ => Outcome::Done,
    })
}

/// The diagnosis itself, printed and written as by [`run`].
pub fn find(args: &Args, talk: &Talk) -> Result<Diagnosis> {
    args.page.vacant()?;
    for effect in &args.without {
        effect_named(effect)?;
    }
    let model = Model::load(&args.model)?;
    let findings = handstand::log::check(&args.all_logs(), &model)?;
    if log::refused(&findings) {
        let diagnosis = Diagnosis::unfit(&findings);
        print(&diagnosis, talk)?;
        return Ok(diagnosis);
    }
    let named = input::motions(&model, &args.logs, &args.judging.holdout)?;
    let split = split(named.training, named.held_out);
    let mut diagnosis = try_all(&model, &split, args, talk);
    let warned = findings
        .iter()
        .filter(|finding| finding.severity == Severity::Warn);
    diagnosis.warnings.extend(warned.map(LogFinding::statement));
    for line in &mut diagnosis.next {
        *line = with_names(line, args);
    }
    print(&diagnosis, talk)?;
    let page = || {
        let page = Page {
            title: format!("What {} is missing", model.name),
            comparisons: comparisons(&model, &diagnosis, args)?,
            diagnosis: Some(diagnosis.clone()),
            models: &[&args.model],
            split: &split,
        };
        Ok(html(&page::report(page, talk)?))
    };
    args.page.write(page, talk)?;
    Ok(diagnosis)
}

/// A command line to be copied: the files' names in place of what stands for them.
fn with_names(line: &str, args: &Args) -> String {
    let words = |logs: &[LogRequest]| {
        let words: Vec<String> = logs.iter().map(|log| quoted(&log.to_string())).collect();
        words.join(" ")
    };
    // Without logs of its own to judge by, the whole is all there is.
    let line = match args.judging.holdout.as_slice() {
        [] => line
            .replace(&format!(" --holdout {HELD_OUT}"), "")
            .replace(HELD_OUT, LOGS),
        held_out => line.replace(HELD_OUT, &words(held_out)),
    };
    line.replace(LOGS, &words(&args.logs))
        .replace(MODEL, &quoted(&args.model.to_string_lossy()))
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./:@+=,\\".contains(c);
    match word.chars().all(plain) {
        true => word.to_string(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

fn try_all(model: &Model, split: &Split, args: &Args, talk: &Talk) -> Diagnosis {
    let defaults = DiagnoseOptions::default();
    let options = DiagnoseOptions {
        seed: args.seed.unwrap_or(defaults.seed),
        without: args.without.clone(),
        horizon: args.judging.run.horizon,
        ..defaults
    };
    let bar = talk.bar();
    let (training, held_out) = (split.training.clone(), split.held_out.clone());
    let diagnosis = diagnose(model, training, held_out, &options, &|progress| {
        bar.set_length(progress.total as u64);
        bar.set_position(progress.done as u64);
        bar.set_message(progress.what);
    });
    bar.finish_and_clear();
    diagnosis
}

fn print(diagnosis: &Diagnosis, talk: &Talk) -> Result<()> {
    if talk.json {
        talk.data(&diagnosis_json(diagnosis))
    } else {
        talk.print(&diagnosis_text(diagnosis))
    }
}

/// The model as it is, and with the effects that were found.
fn comparisons(model: &Model, diagnosis: &Diagnosis, args: &Args) -> Result<Vec<Comparison>> {
    let motions = read(&args.all_logs(), &model.log)?;
    let judged_over = diagnosis.horizon_s.map(Horizon::Seconds);
    let horizon = args.judging.run.horizon.or(judged_over);
    let before = compare(model, "the model as it is", &motions, horizon);
    if diagnosis.effects.is_empty() {
        return Ok(vec![before]);
    }
    let horizon = Some(Horizon::from_seconds(before.horizon_s));
    let names: Vec<String> = diagnosis
        .effects
        .iter()
        .map(FittedEffect::address)
        .collect();
    let name = format!("with {}", names.join(", "));
    let after = compare(&diagnosis.applied_to(model), &name, &motions, horizon);
    Ok(vec![before, after])
}
