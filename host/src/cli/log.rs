//! `handstand log check MODEL LOG...`: are these logs fit to be learned from?
//!
//! Reads every row; the model says how columns are named and in which units. What is broken is refused, what
//! looks wrong is warned of, each with file, line, column and remedy.
//!
//! ```console
//! $ handstand log check arm.toml swing.csv drop.csv:26-139
//! ```
//!
//! Exit code 1 when a log is refused, 0 otherwise, warnings or not. `--json` prints `verdict` (`clean`,
//! `warned`, `refused`) and `findings` (`severity`, `file`, `line`, `column`, `what`, `remedy`).

use super::Outcome;
use super::input;
use super::talk::Talk;
use handstand::log::{Finding, LogRequest, Severity};
use handstand::{Model, Result};
use serde_json::{Value, json};
use std::path::PathBuf;

/// What can be done with logs.
#[derive(Debug, clap::Subcommand)]
pub enum Command {
    /// Judge logs before they are learned from
    Check(Args),
}

/// Judge logs before they are learned from.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Model file: it names the logs' columns and units
    model: PathBuf,
    /// Logs
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
}

/// Prints the findings.
pub fn check(args: &Args, talk: &Talk) -> Result<Outcome> {
    let model = Model::load(&args.model)?;
    let findings = handstand::log::check(&args.logs, &model)?;
    if talk.json {
        talk.data(&json!({
            "verdict": verdict(&findings),
            "findings": findings.iter().map(finding).collect::<Vec<_>>(),
        }))?;
    } else {
        let mut lines: Vec<String> = findings.iter().map(ToString::to_string).collect();
        lines.push(match verdict(&findings) {
            "refused" => "refused: mend what is refused above, then check again".to_string(),
            "warned" => "fit for use, with the warnings above".to_string(),
            _ => "fit for use".to_string(),
        });
        talk.print(&lines.join("\n"))?;
    }
    Ok(match refused(&findings) {
        true => Outcome::Refused,
        false => Outcome::Done,
    })
}

/// Whether any finding makes the logs useless.
pub fn refused(findings: &[Finding]) -> bool {
    findings
        .iter()
        .any(|finding| finding.severity == Severity::Refuse)
}

fn verdict(findings: &[Finding]) -> &'static str {
    match findings.iter().map(|finding| finding.severity).max() {
        Some(Severity::Refuse) => "refused",
        Some(Severity::Warn) => "warned",
        Some(Severity::Note) | None => "clean",
    }
}

fn finding(finding: &Finding) -> Value {
    json!({
        "severity": match finding.severity {
            Severity::Note => "note",
            Severity::Warn => "warning",
            Severity::Refuse => "refused",
        },
        "file": finding.place.as_ref().map(|place| place.file.to_string_lossy()),
        "line": finding.place.as_ref().and_then(|place| place.line),
        "column": finding.place.as_ref().and_then(|place| place.column),
        "what": finding.what,
        "remedy": finding.remedy,
    })
}
