//! The sessions to choose from.

use super::frame;
use crate::session::{LabSession, SavedSession, SessionStore};
use maud::{Markup, html};

/// The page.
pub fn sessions(store: &SessionStore) -> Markup {
    let sessions = store.all();
    let body = html! {
        main data-session="" {
            h1 { "Sessions" }
            p.lead { "Each browser works in a session of its own. They are kept in "
                code { (store.folder().display()) } "." }
            div #message role="alert" {}
            div.scroll tabindex="0" { table {
                thead { tr { th { "Session" } th { "Model" } th { "Logs" } th { "Steps" } th {
                    "Challenge" } th { "Name" } th { "Delete" } } }
                tbody { @for session in &sessions { (row(session)) } }
            } }
            form.row data-send="/sessions" { button.main { "New session" } }
        }
        script type="module" src="/assets/lab.js" {}
    };
    frame::bare("Sessions - handstand lab", &body)
}

fn row(session: &LabSession) -> Markup {
    let saved = session.saved();
    let number = session.number;
    html! {
        tr {
            td { a href={ "/s/" (number) "/data" } { (session_name(number, &saved)) } }
            td { (model_name(&saved)) }
            td { (logs(&saved)) }
            td { (saved.steps.len().saturating_sub(1)) }
            td { (challenge(&saved)) }
            td {
                form.small-form.name-form data-send={ "/s/" (number) "/name" } {
                    input name="name" value=(saved.name) placeholder="no name" maxlength="80"
                        aria-label={ "Name of session " (number) };
                    button { "Keep name" }
                }
            }
            td {
                details {
                    summary { "Delete" }
                    form.small-form data-send="/sessions/delete" {
                        input type="hidden" name="number" value=(number) data-number;
                        p.note { "Its models and its copies of the logs are gone for good." }
                        button { "Delete session " (number) }
                    }
                }
            }
        }
    }
}

/// "Session 3", with its name where it has one.
pub(super) fn session_name(number: u32, saved: &SavedSession) -> String {
    match saved.name.as_str() {
        "" => format!("Session {number}"),
        name => format!("Session {number}: {name}"),
    }
}

fn model_name(saved: &SavedSession) -> String {
    let model = saved
        .step()
        .map(|step| step.toml.parse::<toml_edit::DocumentMut>());
    let name = model.and_then(|document| {
        let document = document.ok()?;
        Some(document.get("rig")?.get("name")?.as_str()?.to_string())
    });
    name.unwrap_or_else(|| "none yet".into())
}

fn logs(saved: &SavedSession) -> String {
    let names: Vec<String> = saved.logs.iter().map(|log| log.name()).collect();
    names.join(", ")
}

fn challenge(saved: &SavedSession) -> &'static str {
    match &saved.round {
        None => "",
        Some(round) => match &round.result {
            None => "open",
            Some(result) if result.solved => "solved",
            Some(_) => "not solved",
        },
    }
}
