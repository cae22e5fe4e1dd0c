//! `handstand log plot LOG` draws a log, `log merge` puts two together, and
//! `handstand log check MODEL LOG...` checks logs before a model is fitted to them.
//!
//! Simulates the given model along the logs: where another sign, zero, unit, angle convention,
//! drive or time lowers its error clearly, the lines of the model file to change are printed, with
//! the errors before and after. Then reads every row; the model says how columns are named and in
//! which units. What is broken is refused, what looks wrong is warned of, each with file, line,
//! column and remedy.
//!
//! ```console
//! $ handstand log check arm.toml swing.csv drop.csv:26-139
//! ```
//!
//! Exit code 1 when a log is refused, 0 otherwise, warnings or not. `--json` prints `verdict`
//! (`clean`, `warned`, `refused`) and `findings` (`severity`, `kind`, `file`, `line`, `column`,
//! `what`, `remedy`, `proof`).

mod merge;
mod plot;

use super::ExitStatus;
use super::Talk;
use super::input;
use handstand::Result;
use handstand::diagnose::conventions::{self, ModelFile};
use handstand::log::{LogFinding, LogRequest, Severity};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// What can be done with logs.
#[derive(Debug, clap::Subcommand)]
pub enum LogCommand {
    /// Check logs before a model is fitted to them
    Check(LogCheckArgs),
    /// Draw a log's columns as they stand in its file
    Plot(plot::LogPlotArgs),
    /// Put two logs of one motion together, their clocks aligned by what both hold
    Merge(merge::LogMergeArgs),
}

/// Does it.
pub fn run(command: &LogCommand, talk: &Talk) -> Result<ExitStatus> {
    match command {
        LogCommand::Check(args) => check(args, talk),
        LogCommand::Plot(args) => plot::run(args, talk),
        LogCommand::Merge(args) => merge::run(args, talk),
    }
}

/// Check logs before a model is fitted to them.
#[derive(Debug, clap::Args)]
pub struct LogCheckArgs {
    /// Model file: it names the logs' columns and units
    model: PathBuf,
    /// Logs
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
}

/// Prints the findings.
fn check(args: &LogCheckArgs, talk: &Talk) -> Result<ExitStatus> {
    let findings = findings(&args.logs, &args.model)?;
    let (verdict, sentence) = match findings.iter().map(|finding| finding.severity).max() {
        Some(Severity::Refuse) => (
            "refused",
            "refused: mend what is refused above, then check again",
        ),
        Some(Severity::Warn) => ("warned", "fit for use, with the warnings above"),
        Some(Severity::Note) | None => ("clean", "fit for use"),
    };
    let data: Vec<Value> = findings.iter().map(finding).collect();
    let data = json!({ "verdict": verdict, "findings": data });
    talk.result(&data, || {
        let lines = findings.iter().map(ToString::to_string);
        let lines: Vec<String> = lines.chain([sentence.to_string()]).collect();
        lines.join("\n")
    })?;
    Ok(ExitStatus::answer(!refused(&findings)))
}

/// Everything found in the logs: what a simulation of the model shows first, then what the logs
/// show by themselves.
///
/// # Errors
/// A model file that is refused, and what the system refuses.
pub fn findings(logs: &[LogRequest], file: &Path) -> Result<Vec<LogFinding>> {
    let model = input::model(file)?;
    let text = input::text(file)?;
    let file = ModelFile {
        path: file,
        text: &text,
    };
    conventions::findings(logs, &model, file)
}

/// Whether any finding makes the logs useless.
pub fn refused(findings: &[LogFinding]) -> bool {
    let mut severities = findings.iter().map(|finding| finding.severity);
    severities.any(|severity| severity == Severity::Refuse)
}

fn finding(finding: &LogFinding) -> Value {
    let place = finding.place.as_ref();
    json!({
        "severity": finding.severity.name(),
        "kind": finding.kind,
        "file": place.map(|place| place.file.to_string_lossy()),
        "line": place.and_then(|place| place.line),
        "column": place.and_then(|place| place.column),
        "what": finding.what,
        "remedy": finding.remedy,
        "proof": finding.proof.map(|proof| json!({
            "before_rad": proof.before_rad,
            "after_rad": proof.after_rad,
            "before_share": proof.before_share,
            "after_share": proof.after_share,
        })),
    })
}
