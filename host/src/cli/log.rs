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

use super::Console;
use super::ExitStatus;
use super::input;
use handstand::Result;
use handstand::diagnose::conventions::{self, ModelFile};
use handstand::log::{LogFinding, LogRequest, Severity};
use handstand::report::{log_check_json, log_check_text};
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
pub fn run(command: &LogCommand, console: &Console) -> Result<ExitStatus> {
    match command {
        LogCommand::Check(args) => check(args, console),
        LogCommand::Plot(args) => plot::run(args, console),
        LogCommand::Merge(args) => merge::run(args, console),
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
fn check(args: &LogCheckArgs, console: &Console) -> Result<ExitStatus> {
    let findings = findings(&args.logs, &args.model)?;
    console.result(&log_check_json(&findings), || log_check_text(&findings))?;
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
