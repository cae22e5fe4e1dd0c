//! A diagnosis from logs as they are named: judged, read, split, diagnosed.

use super::findings::Diagnosis;
use super::options::DiagnoseOptions;
use super::pipeline::diagnose_on;
use super::progress::Course;
use super::words::{HELD_OUT, LOGS, MODEL};
use crate::diagnose::conventions::{self, ModelFile};
use crate::error::Result;
use crate::fitting::Progress;
use crate::log::{LogFinding, LogRequest, LogSet, Severity};
use crate::model::Model;
use crate::motion::{Split, split};
use std::path::Path;

/// A diagnosis, and the motions it was made from.
#[derive(Debug, Clone)]
pub struct LogDiagnosis {
    /// The diagnosis; its `next` names the files.
    pub diagnosis: Diagnosis,
    /// What was fitted and what was held out; nothing where the logs were refused.
    pub split: Split,
}

/// Diagnoses the model of `file` from logs. Logs that the checks refuse end in
/// [`Verdict::Unfit`](super::Verdict::Unfit), where the options do not trust them; without logs to
/// judge by, the last third of the motions is held out.
///
/// # Errors
/// Logs that cannot be read, rows that are fitted and held out, or a horizon of too few samples.
pub fn diagnose_logs(
    model: &Model,
    file: ModelFile,
    logs: &LogSet,
    options: &DiagnoseOptions,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<LogDiagnosis> {
    let course = Course::new(options, progress);
    let mut findings = conventions::findings(&logs.all(), model, file)?;
    if options.trust_log {
        // What a simulation proves becomes a warning; what cannot be read stays refused.
        let proven = findings
            .iter_mut()
            .filter(|finding| finding.proof.is_some());
        proven.for_each(|finding| finding.severity = Severity::Warn);
    }
    if findings.iter().any(|f| f.severity == Severity::Refuse) {
        return Ok(LogDiagnosis {
            diagnosis: Diagnosis::unfit(&findings),
            split: Split::default(),
        });
    }
    let named = logs.read(&model.log)?;
    if let Some(horizon) = options.horizon {
        horizon.check(model, named.training.iter().chain(&named.held_out))?;
    }
    let split = split(named.training, named.held_out);
    let motions = [split.training.clone(), split.held_out.clone()];
    let mut diagnosis = diagnose_on(&course, model, motions, options);
    let warned = findings.iter().filter(|f| f.severity == Severity::Warn);
    diagnosis.warnings.extend(warned.map(LogFinding::statement));
    for line in &mut diagnosis.next {
        *line = with_names(line, file.path, logs);
    }
    Ok(LogDiagnosis { diagnosis, split })
}

/// A command line to be copied: the files' names in place of what stands for them.
fn with_names(line: &str, model: &Path, logs: &LogSet) -> String {
    // Without logs of its own to judge by, the whole is all there is.
    let line = match logs.held_out.as_slice() {
        [] => line
            .replace(&format!(" --holdout {HELD_OUT}"), "")
            .replace(HELD_OUT, LOGS),
        held_out => line.replace(HELD_OUT, &quoted_logs(held_out)),
    };
    line.replace(LOGS, &quoted_logs(&logs.training))
        .replace(MODEL, &quoted(&model.to_string_lossy()))
}

/// Logs as words of a command line.
pub fn quoted_logs(logs: &[LogRequest]) -> String {
    let words: Vec<String> = logs.iter().map(|log| quoted(&log.to_string())).collect();
    words.join(" ")
}

/// A word as a shell takes it.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./:@+=,\\".contains(c);
    if word.chars().all(plain) {
        word.to_string()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}
