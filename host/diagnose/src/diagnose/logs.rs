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
use crate::motion::{Motion, Split, split};
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
    // Other motions are held out only where a command line can say so.
    let is_log = |motion: &Motion| logs.held_out.iter().any(|log| log.name() == motion.name);
    let may_split = split.held_out.iter().all(is_log);
    let (mut diagnosis, split) = diagnose_on(&course, model, &split, may_split, options);
    let logs = &turned(logs, &diagnosis, &split);
    let warned = findings.iter().filter(|f| f.severity == Severity::Warn);
    diagnosis.warnings.extend(warned.map(LogFinding::statement));
    for line in &mut diagnosis.next {
        *line = with_names(line, file.path, logs);
    }
    Ok(LogDiagnosis { diagnosis, split })
}

/// The logs in the parts that their motions took in the end.
fn turned(logs: &LogSet, diagnosis: &Diagnosis, split: &Split) -> LogSet {
    let all = || logs.all().into_iter();
    if !diagnosis.shows_alone.is_empty() {
        return LogSet {
            training: all().collect(),
            held_out: Vec::new(),
        };
    }
    let is_fitted = |log: &LogRequest| {
        let name = log.name();
        split.training.iter().any(|motion| motion.name == name)
    };
    let (learned, held_out) = logs.held_out.iter().cloned().partition(is_fitted);
    LogSet {
        training: logs
            .training
            .iter()
            .cloned()
            .chain::<Vec<LogRequest>>(learned)
            .collect(),
        held_out,
    }
}

/// A command line to be copied: the files' names in place of what stands for them.
pub(crate) fn with_names(line: &str, model: &Path, logs: &LogSet) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn logs(names: &[&str]) -> Vec<LogRequest> {
        names.iter().map(LogRequest::whole).collect()
    }

    #[test]
    fn commands_name_logs_in_the_parts_they_took() {
        let given = LogSet {
            training: logs(&["a.csv"]),
            held_out: logs(&["c.csv", "d.csv"]),
        };
        let motion = |name: &str| Motion {
            name: name.into(),
            ..Motion::default()
        };
        let mut diagnosis = Diagnosis::unfit(&[]);
        let split = Split {
            training: vec![motion("a.csv"), motion("c.csv")],
            held_out: vec![motion("d.csv")],
        };
        let line = format!("diagnose {MODEL} {LOGS} --holdout {HELD_OUT}");
        let said = |logs: &LogSet| with_names(&line, Path::new("m.toml"), logs);
        let turned_logs = turned(&given, &diagnosis, &split);
        assert_eq!(
            said(&turned_logs),
            "diagnose m.toml a.csv c.csv --holdout d.csv"
        );
        diagnosis.shows_alone = vec!["c.csv".into()];
        let all = turned(&given, &diagnosis, &split);
        assert_eq!(said(&all), "diagnose m.toml a.csv c.csv d.csv");
    }
}
