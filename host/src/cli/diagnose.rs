//! `handstand diagnose MODEL LOG... [--holdout LOG]...`: which physical effect is missing from the
//! model?
//!
//! Judges the logs first. Then every effect of the library that could act and be seen is tried, and
//! what it gains on motions that took no part in the fit decides. Without `--holdout` the last
//! third of the motions is held out; where there is but one motion, nothing can be said of new
//! ones.
//!
//! ```console
//! $ handstand diagnose arm.toml a.csv b.csv --holdout c.csv --report report.html
//! ```
//!
//! With the plan of a balancing robot (`--plan GAINS.json`, from `handstand gains --state-space`)
//! the closed loop is simulated too, of the model as it is and with the effects that were found.
//!
//! The verdict is `nominal`, `adequate`, `wrong_value`, `named`, `ambiguous`, `unexplained` or
//! `unfit`; exit code 1 for `unfit`, 0 for the others, which are answers. `--json` prints the diagnosis; its keys are in
//! `docs/json.md`.

use super::page::{self, PageFile};
use super::{ExitStatus, Talk, input, log};
use handstand::compare::{ClosedLoopComparison, Comparison, closed_loop_text, compare};
use handstand::diagnose::words::{HELD_OUT, LOGS, MODEL};
use handstand::diagnose::{DiagnoseOptions, Diagnosis, FittedEffect, Verdict, diagnose};
use handstand::fitting::{Horizon, effect_named};
use handstand::log::{LogFinding, LogRequest, Motion, Severity, Split, read, split};
use handstand::report::{Report, diagnosis_json, diagnosis_text, html};
use handstand::synth::StateFeedbackPlan;
use handstand::{Model, Result};
use serde_json::json;
use std::path::PathBuf;

/// Diagnose which physical effect a model lacks, from logs.
#[derive(Debug, clap::Args)]
pub struct DiagnoseArgs {
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
    /// Error that is good enough, mrad: a model as given that leaves no more is `adequate`
    #[arg(long, value_name = "MRAD", value_parser = input::positive)]
    tolerance: Option<f64>,
    #[command(flatten)]
    judging: input::HoldoutArgs,
    #[command(flatten)]
    plan: input::PlanFile,
    #[command(flatten)]
    page: PageFile,
}

impl DiagnoseArgs {
    /// The logs to learn from, then those to judge by.
    fn all_logs(&self) -> Vec<LogRequest> {
        [self.logs.as_slice(), &self.judging.holdout].concat()
    }
}

/// Diagnoses, prints, writes the page.
pub fn run(args: &DiagnoseArgs, talk: &Talk) -> Result<ExitStatus> {
    let diagnosis = find(args, talk)?;
    Ok(ExitStatus::answer(diagnosis.verdict != Verdict::Unfit))
}

/// The diagnosis itself, printed and written as by [`run`].
pub fn find(args: &DiagnoseArgs, talk: &Talk) -> Result<Diagnosis> {
    args.page.vacant()?;
    for effect in &args.without {
        effect_named(effect)?;
    }
    let model = Model::load(&args.model)?;
    let plan = args.plan.load(&model)?;
    let findings = log::findings(&args.all_logs(), &args.model)?;
    if log::refused(&findings) {
        let diagnosis = Diagnosis::unfit(&findings);
        print(&diagnosis, &[], talk)?;
        return Ok(diagnosis);
    }
    let named = input::motions(&model.log, &args.logs, &args.judging.holdout)?;
    let split = split(named.training, named.held_out);
    let mut diagnosis = try_all(&model, &split, args, talk);
    let warned = findings
        .iter()
        .filter(|finding| finding.severity == Severity::Warn);
    diagnosis.warnings.extend(warned.map(LogFinding::statement));
    for line in &mut diagnosis.next {
        *line = with_names(line, args);
    }
    let compared = Compared::new(&model, &diagnosis, plan.as_ref(), args)?;
    print(&diagnosis, &compared.named_loops(), talk)?;
    let page = || {
        Ok(html(&Report {
            title: format!("What {} is missing", model.name),
            comparisons: compared.comparisons(diagnosis.horizon_s, args),
            diagnosis: Some(diagnosis.clone()),
            provenance: page::provenance(&[&args.model], &split, talk)?,
        }))
    };
    args.page.write(page, talk)?;
    Ok(diagnosis)
}

/// A command line to be copied: the files' names in place of what stands for them.
fn with_names(line: &str, args: &DiagnoseArgs) -> String {
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

fn try_all(model: &Model, split: &Split, args: &DiagnoseArgs, talk: &Talk) -> Diagnosis {
    let defaults = DiagnoseOptions::default();
    let options = DiagnoseOptions {
        seed: args.seed.unwrap_or(defaults.seed),
        without: args.without.clone(),
        horizon: args.judging.run.horizon,
        tolerance_rad: args.tolerance.map(|mrad| 1e-3 * mrad),
        ..defaults
    };
    let bar = talk.bar(0);
    let (training, held_out) = (split.training.clone(), split.held_out.clone());
    diagnose(model, training, held_out, &options, &|progress| {
        bar.set_length(progress.total as u64);
        bar.set_position(progress.done as u64);
        bar.set_message(progress.what);
    })
}

/// Prints the diagnosis, and the closed loops before and after it where there are any.
fn print(diagnosis: &Diagnosis, loops: &[NamedLoop], talk: &Talk) -> Result<()> {
    if talk.json {
        let mut value = diagnosis_json(diagnosis);
        let after = loops.get(1).map(|(_, after)| after);
        value["closed_loop"] = loops.first().map_or(
            json!(null),
            |(_, before)| json!({ "before": before, "after": after }),
        );
        return talk.data(&value);
    }
    talk.print(&(diagnosis_text(diagnosis) + &closed_loop_text(loops)))
}

/// A model's name and its closed loop.
type NamedLoop<'a> = (&'a str, &'a ClosedLoopComparison);

/// The model as it is and with the effects that were found, against all motions.
struct Compared {
    motions: Vec<Motion>,
    /// Each with its name, and its closed loop if there is a plan.
    models: Vec<(String, Model, Option<ClosedLoopComparison>)>,
}

impl Compared {
    fn new(
        model: &Model,
        diagnosis: &Diagnosis,
        plan: Option<&StateFeedbackPlan>,
        args: &DiagnoseArgs,
    ) -> Result<Compared> {
        let motions = read(&args.all_logs(), &model.log)?;
        let mut named = vec![("the model as it is".to_string(), model.clone())];
        if !diagnosis.effects.is_empty() {
            let effects = diagnosis.effects.iter().map(FittedEffect::address);
            let effects = effects.collect::<Vec<String>>().join(", ");
            named.push((format!("with {effects}"), diagnosis.applied_to(model)));
        }
        let mut models = Vec::new();
        for (name, model) in named {
            let closed_loop = input::closed_loop(&model, plan, &motions)?;
            models.push((name, model, closed_loop));
        }
        Ok(Compared { motions, models })
    }

    fn named_loops(&self) -> Vec<NamedLoop<'_>> {
        let models = self.models.iter();
        models
            .filter_map(|(name, _, closed_loop)| Some((name.as_str(), closed_loop.as_ref()?)))
            .collect()
    }

    /// The comparisons of the page, all over the first one's horizon.
    fn comparisons(&self, judged_over_s: Option<f64>, args: &DiagnoseArgs) -> Vec<Comparison> {
        let judged_over = judged_over_s.map(Horizon::Seconds);
        let mut horizon = args.judging.run.horizon.or(judged_over);
        let mut comparisons = Vec::new();
        for (name, model, closed_loop) in &self.models {
            let mut comparison = compare(model, name, &self.motions, horizon);
            horizon = Some(Horizon::from_seconds(comparison.horizon_s));
            comparison.closed_loop = closed_loop.clone();
            comparisons.push(comparison);
        }
        comparisons
    }
}
