//! Bringing data: logs, what the check finds, raw curves, the model.

use super::data_model;
use super::frame;
use crate::error::Result;
use crate::lab::session::{EXAMPLES, LabSession, LogFacts, MOST_BYTES, SavedSession};
use crate::log::{LogFinding, LogFormat, Severity};
use maud::{Markup, html};

/// The page.
pub fn page(session: &LabSession) -> Result<Markup> {
    let saved = session.saved();
    let model = session.model(&saved)?;
    let facts = session.log_facts(&saved, model.as_ref());
    let evaluation = session.known_evaluation(&saved);
    let body = html! {
        h1.visually-hidden { "Data" }
        section { (bring(session.number)) }
        @if !facts.is_empty() {
            section {
                h2 { "Logs" }
                (logs(&facts))
            }
            section {
                h2 { "What the check finds" }
                @if model.is_some() { p #findings-wanted { "Checking …" } }
                @else { p.lead { "Bring or make a model: it says what the columns mean." } }
            }
            section {
                h2 { "The log as it stands" }
                (raw(&saved))
            }
        }
        (data_model::sections(session, &saved, model.as_ref()))
    };
    Ok(frame::page(
        session,
        &saved,
        "data",
        evaluation.as_deref(),
        "model.js",
        &body,
    ))
}

fn bring(number: u32) -> Markup {
    html! {
        div.two {
            div.drop #drop {
                h2 { "Bring a log" }
                p { label for="files" {
                    "Drop logs here, or choose them: CSV, MCAP, rosbag2 (db3), MATLAB (mat), \
                     Parquet, JSON of a BAM bench." } }
                input #files type="file" multiple accept=(accepted()) data-most=(MOST_BYTES);
            }
            div {
                h2 { "Or begin with an example" }
                p.lead { "A simulated servo arm, three logs, and a model that lacks something." }
                form.row data-send="example" {
                    label for="example" { "Example" }
                    select #example name="example" {
                        @for example in EXAMPLES { option value=(example.id) { (example.title) } }
                    }
                    button.main { "Begin" }
                }
                p { "Or " a href={ "/s/" (number) "/challenge" } { "take up a challenge" }
                    ": the effect is hidden, and you are scored." }
            }
        }
    }
}

/// Endings that a chooser of files offers.
fn accepted() -> String {
    let endings = LogFormat::endings().map(|ending| format!(".{ending}"));
    endings.collect::<Vec<_>>().join(",")
}

fn logs(facts: &[LogFacts]) -> Markup {
    html! {
        div.scroll tabindex="0" { table {
            thead { tr { th { "File" } th.number { "Motions" } th.number { "Samples" } th.number {
                "Seconds" } th { "Role" } th { "Remove" } } }
            tbody { @for fact in facts { (log(fact)) } }
        } }
        p.note { "Fitted logs are learned from; logs held out judge. Where none is held out, the \
                  last third of the motions judges a diagnosis." }
    }
}

fn log(fact: &LogFacts) -> Markup {
    let log = &fact.log;
    html! {
        tr {
            td {
                (log.file)
                @if let Some((first, last)) = log.rows { ", rows " (first) " to " (last) }
                @if let Err((found, remedy)) = &fact.content { p.bad { (found) } p.note { (remedy) }
                    }
            }
            @match &fact.content {
                Ok((motions, samples, seconds)) => {
                    td.number { (motions) } td.number { (samples) } td.number {
                        (format!("{seconds:.1}")) }
                }
                Err(_) => { td.number { "-" } td.number { "-" } td.number { "-" } }
            }
            td {
                form data-send="log" {
                    input type="hidden" name="file" value=(log.file);
                    select name="action" data-submit aria-label={ "Role of " (log.file) } {
                        option value="fit" selected[!log.held_out] { "fitted" }
                        option value="hold_out" selected[log.held_out] { "held out" }
                    }
                }
            }
            td {
                form.small-form data-send="log" {
                    input type="hidden" name="file" value=(log.file);
                    input type="hidden" name="action" value="remove";
                    button aria-label={ "Remove " (log.file) } { "Remove" }
                }
            }
        }
    }
}

/// What the check finds; it simulates, so the page does not wait for it.
pub fn findings(session: &LabSession, findings: &[LogFinding]) -> Markup {
    html! {
        @if findings.is_empty() { p.good { "Nothing is wrong with these logs." } }
        ul.plain #findings { @for finding in findings {
            @let severity = finding.severity.name();
            li {
                span class={ "severity " (severity) } { (severity) } " "
                (session.shortened(&finding.statement()))
                @if finding.severity != Severity::Note || !finding.remedy.is_empty() {
                    span.note { " (" (finding.remedy) ")" }
                }
            }
        } }
    }
}

fn raw(saved: &SavedSession) -> Markup {
    html! {
        div.row {
            label for="raw-file" { "File" }
            select #raw-file { @for log in &saved.logs { option { (log.file) } } }
        }
        div #raw {}
    }
}
