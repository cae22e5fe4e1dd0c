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
use super::{Outcome, input, log, name};
use handstand::compare::{Comparison, compare};
use handstand::diagnose::words::{HELD_OUT, LOGS, MODEL, address};
use handstand::diagnose::{DiagnoseOptions, Diagnosis, ErrorFall, Verdict, diagnose};
use handstand::effects;
use handstand::fitting::Horizon;
use handstand::log::{LogFinding, LogRequest, Severity, Split, read, split};
use handstand::model::{EffectInstance, ParameterPath};
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
    /// Logs to judge by, which are not learned from
    #[arg(long, num_args = 1.., value_name = "LOG", value_parser = input::log)]
    holdout: Vec<LogRequest>,
    /// Effect to leave out of the candidates
    #[arg(long, value_name = "EFFECT")]
    without: Vec<String>,
    /// Seed of the random draws
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Seconds the model runs without correction, or `whole`; chosen by its stability without it
    #[arg(long, value_name = "SECONDS", value_parser = input::horizon, allow_negative_numbers = true)]
    horizon: Option<Horizon>,
    #[command(flatten)]
    page: PageFile,
}

/// Diagnoses, prints, writes the page.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let diagnosis = find(args, talk)?;
    Ok(match diagnosis.verdict {
        Verdict::Unfit => Outcome::Refused,
        _ => Outcome::Done,
    })
}

/// As [`run`], for who goes on with what was found.
pub fn find(args: &Args, talk: &Talk) -> Result<Diagnosis> {
    args.page.vacant()?;
    for effect in &args.without {
        name::effect(effect)?;
    }
    let model = Model::load(&args.model)?;
    let all: Vec<LogRequest> = args.logs.iter().chain(&args.holdout).cloned().collect();
    let findings = handstand::log::check(&all, &model)?;
    if log::refused(&findings) {
        let diagnosis = unfit(&findings);
        print(&diagnosis, talk)?;
        return Ok(diagnosis);
    }
    let named = input::motions(&model, &args.logs, &args.holdout)?;
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
    let line = match args.holdout.as_slice() {
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
        horizon: args.horizon,
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
    let all: Vec<LogRequest> = args.logs.iter().chain(&args.holdout).cloned().collect();
    let motions = read(&all, &model.log)?;
    let horizon = args.horizon.or(diagnosis.horizon_s.map(Horizon::Seconds));
    let before = compare(model, "the model as it is", &motions, horizon);
    if diagnosis.effects.is_empty() {
        return Ok(vec![before]);
    }
    let horizon = before.horizon_s.map_or(Horizon::Whole, Horizon::Seconds);
    let names: Vec<String> = diagnosis.effects.iter().map(address).collect();
    let name = format!("with {}", names.join(", "));
    let after = compare(&mended(model, diagnosis), &name, &motions, Some(horizon));
    Ok(vec![before, after])
}

/// The model with the diagnosis's effects and refitted values.
fn mended(model: &Model, diagnosis: &Diagnosis) -> Model {
    let mut model = model.clone();
    for value in &diagnosis.base {
        if let Ok(path) = value.path.parse::<ParameterPath>() {
            // A value that is not the model's is none to set.
            let _ = path.set(&mut model, value.value);
        }
    }
    let found = diagnosis.effects.iter().filter_map(|found| {
        Some(EffectInstance {
            effect: effects::named(&found.kind)?,
            joint: found.joint.map(|joint| joint - 1),
            values: found.parameters.iter().map(|value| value.value).collect(),
        })
    });
    model.effects.extend(found);
    model
}

/// What is said of logs that were refused.
fn unfit(findings: &[LogFinding]) -> Diagnosis {
    let refused = || {
        findings
            .iter()
            .filter(|finding| finding.severity == Severity::Refuse)
    };
    let reasons = refused().map(LogFinding::statement);
    let said = "The logs cannot be learned from.".to_string();
    Diagnosis {
        verdict: Verdict::Unfit,
        effects: Vec::new(),
        error: ErrorFall {
            unit: "rad".to_string(),
            before: f64::NAN,
            after: f64::NAN,
            floor: f64::NAN,
            held_out: false,
            fall_low: f64::NAN,
            fall_high: f64::NAN,
        },
        alternatives: Vec::new(),
        base: Vec::new(),
        ruled_out: Vec::new(),
        remainder: None,
        motions: Vec::new(),
        collinear: Vec::new(),
        summary: std::iter::once(said).chain(reasons).collect(),
        next: refused().map(|finding| finding.remedy.clone()).collect(),
        warnings: Vec::new(),
        horizon_s: None,
    }
}
