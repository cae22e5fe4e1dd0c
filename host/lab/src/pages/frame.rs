//! What stands around every page: where one is, the model in force, its error.

use super::enter::session_name;
use super::in_milli;
use crate::session::{LabSession, SavedSession, SessionEvaluation, listed, model_sha256};
use maud::{DOCTYPE, Markup, html};

/// Pages of a session: address and name.
const PAGES: [(&str, &str); 7] = [
    ("data", "Data"),
    ("compare", "Compare"),
    ("learn", "Learn"),
    ("what-if", "What if"),
    ("robot", "Robot"),
    ("gains", "Gains"),
    ("challenge", "Challenge"),
];

fn head(title: &str) -> Markup {
    html! {
        meta charset="utf-8";
        meta name="viewport" content="width=device-width, initial-scale=1";
        meta name="color-scheme" content="light dark";
        title { (title) }
        link rel="stylesheet" href="/assets/lab.css";
        link rel="icon" href="data:,";
    }
}

/// A page outside any session.
pub fn bare(title: &str, body: &Markup) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" { head { (head(title)) } body { (body) } }
    }
}

/// Says in a page why something is refused; `inside` leads back to the lab.
pub fn refused(title: &str, why: &[&str], inside: bool) -> Markup {
    let sentence = |text: &str| {
        let mut letters = text.chars();
        let first = letters
            .next()
            .map(|letter| letter.to_uppercase().collect::<String>());
        first.unwrap_or_default() + letters.as_str() + "."
    };
    let body = html! {
        div.bar-top role="banner" { span.brand { "handstand lab" } }
        main #refused {
            section {
                h1 { (title) }
                @for line in why.iter().filter(|line| !line.is_empty()) { p { (sentence(line)) } }
                @if inside {
                    p { a href="/" { "To your session" } ", or "
                        a href="/sessions" { "to all sessions" } "." }
                }
            }
        }
    };
    bare(title, &body)
}

/// The page that goes on by itself.
pub fn entrance() -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head { (head("handstand lab")) meta http-equiv="refresh" content="0;url=/"; }
            body { main { p { a href="/" { "To the lab" } } } }
        }
    }
}

/// A page of a session; `script` is the one that it needs.
pub fn page(
    session: &LabSession,
    saved: &SavedSession,
    here: &str,
    evaluation: Option<&SessionEvaluation>,
    script: &str,
    body: &Markup,
) -> Markup {
    let number = session.number;
    let name = PAGES
        .iter()
        .find(|page| page.0 == here)
        .map_or(here, |page| page.1);
    let running = session.job.state().is_running();
    let shown = saved
        .step()
        .map_or(String::new(), |step| model_sha256(&step.toml));
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                (head(&format!("{name} - handstand lab")))
                script type="module" src={ "/assets/" (script) } {}
            }
            body data-session=(number) data-running[running] data-model=(shown) {
                (top(number, here, saved))
                (status(saved, evaluation))
                div #message role="alert" {}
                main { (body) }
                noscript { p { "The lab draws with scripts of its own; allow them to run." } }
            }
        }
    }
}

fn top(number: u32, here: &str, saved: &SavedSession) -> Markup {
    html! {
        div.bar-top role="banner" {
            a.brand href={ "/s/" (number) "/data" } { "handstand lab" }
            nav aria-label="Pages" {
                @for (address, name) in PAGES {
                    @let current = (address == here).then_some("page");
                    a href={ "/s/" (number) "/" (address) } aria-current=[current] { (name) }
                }
            }
            a.session href="/sessions" { (session_name(number, saved)) }
        }
    }
}

fn status(saved: &SavedSession, evaluation: Option<&SessionEvaluation>) -> Markup {
    let Some(step) = saved.step() else {
        return html! { div.status role="status" { span { "No model yet" } } };
    };
    html! {
        div.status role="status" {
            span { "Model " b { (saved.current) } ": " (step.title) }
            @if let Some(evaluation) = evaluation { (error(evaluation)) }
            // The page does not wait for it; its script asks.
            @else if !saved.logs.is_empty() { span #error-wanted { "Error …" } }
            @if !saved.left_out.is_empty() { (left_out(saved)) }
        }
    }
}

/// Which logs the numbers are not of.
fn left_out(saved: &SavedSession) -> Markup {
    let files: Vec<String> = saved.left_out.iter().map(|log| log.name.clone()).collect();
    html! {
        span.bad #left-out { "Without " (listed(files)) ", which this model cannot read" }
    }
}

/// The error in force and the floor below it.
pub fn error(evaluation: &SessionEvaluation) -> Markup {
    html! {
        span { "Error " b #error-now data-error=(evaluation.rms()) {
            (in_milli(evaluation.rms(), evaluation))
        } " " (evaluation.over()) }
        span { "Noise floor " b { (in_milli(evaluation.floor(), evaluation)) } }
    }
}

/// What stands in its place where the model does not read the logs.
pub fn unreadable() -> Markup {
    html! { span #error-unreadable { "Error: the logs cannot be read by this model" } }
}
