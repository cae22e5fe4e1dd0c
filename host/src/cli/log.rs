//! `handstand log check MODEL LOG...`: checks logs before a model is fitted to them.
//!
//! Reads every row; the model says how columns are named and in which units. What is broken is
//! refused, what looks wrong is warned of, each with file, line, column and remedy.
//!
//! ```console
//! $ handstand log check arm.toml swing.csv drop.csv:26-139
//! ```
//!
//! Exit code 1 when a log is refused, 0 otherwise, warnings or not. `--json` prints `verdict`
//! (`clean`, `warned`, `refused`) and `findings` (`severity`, `kind`, `file`, `line`, `column`,
//! `what`, `remedy`).

use super::ExitStatus;
use super::Talk;
use super::input;
use handstand::log::{LogFinding, LogRequest, Severity};
use handstand::{Model, Result};
use serde_json::{Value, json};
use std::path::PathBuf;

/// What can be done with logs.
#[derive(Debug, clap::Subcommand)]
pub enum LogCommand {
    /// Check logs before a model is fitted to them
    Check(LogCheckArgs),
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
pub fn check(args: &LogCheckArgs, talk: &Talk) -> Result<ExitStatus> {
    let model = Model::load(&args.model)?;
    let findings = handstand::log::check(&args.logs, &model)?;
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
    })
}
