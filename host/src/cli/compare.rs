//! `handstand compare MODEL LOG... [--model OTHER]...`: how far models are from what was measured,
//! and where.
//!
//! The models run along the logs' inputs, each as its file says; nothing is fitted but where each
//! run starts. (`handstand add` gives another reduction of the error: there the model before is
//! refitted without the effect.) Several stand side by side, over the same horizon: the first
//! one's, unless one is given.
//!
//! ```console
//! $ handstand compare arm.toml drop.csv --model better.toml --report report.html
//! ```
//!
//! With the plan of a balancing robot, as `handstand gains --state-space` writes it, the closed
//! loop of each model is simulated too and set beside the measured one:
//!
//! ```console
//! $ handstand gains robot.toml --state-space gains.json
//! $ handstand compare robot.toml balanced.csv --plan gains.json --model with_friction.toml
//! ```
//!
//! `--json` prints the report: `comparisons` (`model`, `horizon_s`, `signals`, `horizons`,
//! `failures`, `traces`, `closed_loop`) and `provenance`.

use super::page::{self, PageFile};
use super::{Console, ExitStatus, input};
use handstand::log::{LogFinding, LogRequest, read_with_findings};
use handstand::model::JointNames;
use handstand::motion::Split;
use handstand::report::{Report, file_names, html, json};
use handstand::{Result, compare};
use std::path::PathBuf;

/// Compare a model's simulation with measured logs.
#[derive(Debug, clap::Args)]
pub struct CompareArgs {
    /// Model file
    model: PathBuf,
    /// Logs
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    /// Another model file to set beside it
    #[arg(long = "model", value_name = "OTHER.toml")]
    others: Vec<PathBuf>,
    #[command(flatten)]
    run: input::RunLength,
    #[command(flatten)]
    plan: input::PlanFile,
    #[command(flatten)]
    page: PageFile,
}

/// Compares, prints, writes the page.
pub fn run(args: &CompareArgs, console: &Console) -> Result<ExitStatus> {
    args.page.vacant()?;
    let files: Vec<&PathBuf> = std::iter::once(&args.model).chain(&args.others).collect();
    let mut models = Vec::new();
    let mut closed_loops = Vec::new();
    let mut findings = Vec::new();
    for (file, name) in files.iter().zip(file_names(&files)) {
        let model = input::model(file)?;
        if models.is_empty() {
            input::tell_joints(&model, console);
        }
        // Each model names columns and zeros its own way.
        let (motions, found) = read_with_findings(&args.logs, &model.log)?;
        let new = |finding: &LogFinding| !findings.contains(finding);
        let new: Vec<LogFinding> = found.into_iter().filter(new).collect();
        findings.extend(new);
        args.run.of(&model, &motions)?;
        let plan = args.plan.load(&model)?;
        closed_loops.push(input::closed_loop(&model, plan.as_ref(), &motions)?);
        models.push((name, model, motions));
    }
    input::warn(&findings, console);
    // Models of other robots have other names for the same number.
    let names = models.first().map(|(_, model, _)| JointNames::of(model));
    let same = |(_, model, _): &(_, _, _)| Some(JointNames::of(model)) == names;
    let names = names.clone().filter(|_| models.iter().all(same));
    let names = names.unwrap_or_default();
    let compared = models
        .iter()
        .map(|(name, model, motions)| (name.as_str(), model, motions.as_slice()));
    let mut comparisons = compare::compare_all(compared, args.run.horizon);
    for (comparison, closed_loop) in comparisons.iter_mut().zip(closed_loops) {
        comparison.closed_loop = closed_loop;
    }
    let split = Split {
        training: models.pop().map_or(Vec::new(), |(_, _, motions)| motions),
        held_out: Vec::new(),
    };
    let text = compare::text(&comparisons, &names);
    let report = Report {
        title: format!("{} against measured motions", comparisons[0].model),
        comparisons,
        diagnosis: None,
        provenance: page::provenance(&files, &split, console)?,
        names,
    };
    console.result(&json(&report), || text)?;
    args.page.write(|| Ok(html(&report)), console)?;
    Ok(ExitStatus::Done)
}
