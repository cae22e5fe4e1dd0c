//! What a check of logs found, as data and as text.

use crate::log::{LogFinding, Severity};
use serde_json::{Value, json};

/// The verdict of findings, and its sentence.
fn verdict(findings: &[LogFinding]) -> (&'static str, &'static str) {
    match findings.iter().map(|finding| finding.severity).max() {
        Some(Severity::Refuse) => (
            "refused",
            "refused: mend what is refused above, then check again",
        ),
        Some(Severity::Warn) => ("warned", "fit for use, with the warnings above"),
        Some(Severity::Note) | None => ("clean", "fit for use"),
    }
}

/// `verdict` (`clean`, `warned`, `refused`) and `findings`.
pub fn log_check_json(findings: &[LogFinding]) -> Value {
    let all: Vec<Value> = findings.iter().map(finding).collect();
    json!({ "verdict": verdict(findings).0, "findings": all })
}

/// A line for each finding, and what they come to.
pub fn log_check_text(findings: &[LogFinding]) -> String {
    let lines = findings.iter().map(ToString::to_string);
    let sentence = verdict(findings).1.to_string();
    lines.chain([sentence]).collect::<Vec<String>>().join("\n")
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
