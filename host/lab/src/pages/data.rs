//! Bringing data: logs, what the check finds, raw curves, the model.

use super::frame;
use super::{data_model, new_model};
use crate::error::Result;
use crate::log::{LogFinding, LogFormat, Severity};
use crate::output::number::NONE;
use crate::session::{EXAMPLES, LabSession, LogFacts, MODEL_ENDINGS, MOST_BYTES, SavedSession};
use maud::{Markup, html};

/// The page.
pub fn page(session: &LabSession) -> Result<Markup> {
    let saved = session.saved();
    let view = session.view();
    let model = session.model(&saved)?;
    let facts = session.log_facts(&saved, model.as_ref());
    let evaluation = session.known_evaluation(&view);
    let number = session.number;
    let body = html! {
        h1.visually-hidden { "Data" }
        section { (bring(number)) }
        @if !facts.is_empty() {
            section {
                h2 { "Logs" }
                (logs(&facts))
                @if model.is_some() {
                    p #onward { a.button href={ "/s/" (number) "/compare" } {
                        "Compare them with the model" } }
                } @else {
                    p #onward { "Next: " a href="#make" { "make a model" }
                        " that says what the columns mean, or bring one." }
                }
            }
        }
        @if model.is_none() { (new_model::section(session, &saved)) }
        @if !facts.is_empty() {
            @if model.is_some() {
                section {
                    h2 { "What the check finds" }
                    p #findings-wanted { "Checking …" }
                }
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
        &view,
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
                h2 { "Bring logs, a model, or a session" }
                p { label for="files" {
                    "Drop files here, or choose them. Logs: CSV, MCAP, rosbag2 (db3), MATLAB (mat), \
                     Parquet, JSON of a BAM bench. Models: TOML, URDF, MJCF (xml). A saved session: \
                     session.json." } }
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
    let endings = LogFormat::endings().chain(MODEL_ENDINGS);
    let endings = endings.map(|ending| format!(".{ending}"));
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
                @if let Err((found, remedy)) = &fact.content {
                    p.bad.unreadable { (found) }
                    p.note { (remedy) @if !remedy.is_empty() { ". " } "It is left out." }
                }
            }
            @match &fact.content {
                Ok(content) => {
                    td.number { (content.motions.map_or(NONE.into(), |n| n.to_string())) }
                    td.number { (content.samples) }
                    td.number { (content.seconds.map_or(NONE.into(), |s| format!("{s:.1}"))) }
                }
                Err(_) => { td.number { "-" } td.number { "-" } td.number { "-" } }
            }
            td {
                form data-send="log" {
                    input type="hidden" name="file" value=(log.name());
                    select name="action" data-submit aria-label={ "Role of " (log.name()) } {
                        option value="fit" selected[!log.held_out] { "fitted" }
                        option value="hold_out" selected[log.held_out] { "held out" }
                    }
                }
            }
            td {
                form.small-form data-send="log" {
                    input type="hidden" name="file" value=(log.name());
                    input type="hidden" name="action" value="remove";
                    button aria-label={ "Remove " (log.name()) } { "Remove" }
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
                    span.note { " (" (session.shortened(&finding.remedy)) ")" }
                }
            }
        } }
    }
}

fn raw(saved: &SavedSession) -> Markup {
    let mut files: Vec<&str> = Vec::new();
    for log in &saved.logs {
        if !files.contains(&log.file.as_str()) {
            files.push(&log.file);
        }
    }
    html! {
        div.row {
            label for="raw-file" { "File" }
            select #raw-file { @for file in files { option { (file) } } }
        }
        p.note { "Zoom to a stretch, by dragging or by the keys; then take it alone, or judge by it. \
                  What judges is shaded." }
        div.row #cut {
            button #cut-keep type="button" { "Use only what is shown" }
            button #cut-hold-out type="button" { "Judge by what is shown, fit the rest" }
            button #cut-whole type="button" { "Use the whole file" }
            span.note #cut-rows aria-live="polite" {}
        }
        div #raw {}
    }
}
