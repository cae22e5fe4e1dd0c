//! The sessions to choose from.

use super::frame;
use crate::lab::session::{SavedSession, SessionStore};
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
                    "Challenge" } } }
                tbody { @for session in &sessions {
                    @let saved = session.saved();
                    tr {
                        td { a href={ "/s/" (session.number) "/data" } {
                            "Session " (session.number) } }
                        td { (name(&saved)) }
                        td { (logs(&saved)) }
                        td { (saved.steps.len().saturating_sub(1)) }
                        td { (challenge(&saved)) }
                    }
                } }
            } }
            form.row data-send="/sessions" { button.main { "New session" } }
        }
        script type="module" src="/assets/lab.js" {}
    };
    frame::bare("Sessions - handstand lab", &body)
}

fn name(saved: &SavedSession) -> String {
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
