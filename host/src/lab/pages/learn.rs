//! Learning: the diagnosis, its cards, the steps taken.

use super::compare::command;
use super::learn_card::card;
use super::learn_steps::steps;
use super::{evaluated, frame, in_mrad};
use crate::lab::reply::LabError;
use crate::lab::session::{LabSession, SavedDiagnosis, SavedSession, SessionEvaluation};
use maud::{Markup, html};

/// The page.
pub fn page(session: &LabSession) -> Result<Markup, LabError> {
    let saved = session.saved();
    let (evaluation, body) = evaluated(session, &saved, |evaluation| {
        shown(session, &saved, evaluation)
    })?;
    Ok(frame::page(
        session,
        &saved,
        "learn",
        evaluation.as_deref(),
        "lab.js",
        &body,
    ))
}

fn shown(
    session: &LabSession,
    saved: &SavedSession,
    evaluation: &SessionEvaluation,
) -> Result<Markup, LabError> {
    Ok(html! {
        section {
            h1 { "How the error falls" }
            p.lead { "Each bar is the typical (RMS) error of one model, all joints and motions \
                      together; the thin line is the noise floor. Adding an effect makes a step; \
                      any step can be undone." }
            (steps(session, saved)?)
        }
        section {
            h2 { "What is missing?" }
            (ask(saved))
            @if let Some(diagnosis) = &saved.diagnosis { (said(saved, diagnosis, evaluation)) }
        }
        section {
            h2 { "The same on the command line" }
            p.note { "To be typed in " code { (session.folder().display()) }
                ", where the models and logs are." }
            (command(&commands(saved)))
        }
    })
}

fn ask(saved: &SavedSession) -> Markup {
    let again = saved.diagnosis.is_some();
    html! {
        div #progress hidden {
            span #what {} progress aria-label="Progress" {}
            button #stop type="button" { "Stop" }
        }
        div.row {
            form data-send="diagnose" {
                button.main #diagnose data-work {
                    @if again { "Diagnose again" } @else { "Diagnose: which effect is missing?" }
                }
            }
            form data-send="fit" {
                input type="hidden" name="names" value="";
                button data-work { "Fit the model's free values" }
            }
        }
    }
}

fn said(
    saved: &SavedSession,
    diagnosis: &SavedDiagnosis,
    evaluation: &SessionEvaluation,
) -> Markup {
    let class = match diagnosis.verdict.as_str() {
        "nominal" | "adequate" => "verdict-nominal",
        "named" | "wrong_value" => "verdict-named",
        "ambiguous" => "verdict-ambiguous",
        "unexplained" => "verdict-unexplained",
        _ => "verdict-unfit",
    };
    let current = diagnosis.step == saved.current;
    html! {
        div class={ "verdict " (class) } #verdict data-verdict=(diagnosis.verdict) {
            p { span.role { "Diagnosis of model " (diagnosis.step) ": "
                (diagnosis.verdict.replace('_', " ")) } }
            @for line in &diagnosis.summary { p { (line) } }
            p.facts {
                span { "Error as given " b { (in_mrad(diagnosis.before_rad)) } }
                span { "with what was found " b { (in_mrad(diagnosis.after_rad)) } }
                span { "floor " b { (in_mrad(diagnosis.floor_rad)) } }
                span { "on " @if diagnosis.held_out { "motions held out" } @else {
                    "the motions that were fitted" } }
            }
        }
        @if !current { p.note {
            "The model in force is another one by now; diagnose again to learn about it." } }
        @if !diagnosis.next.is_empty() {
            h3 { "Next" }
            ul { @for line in &diagnosis.next { li { (line) } } }
        }
        @if !diagnosis.warnings.is_empty() {
            h3 { "Be wary" }
            ul { @for line in &diagnosis.warnings { li { (line) } } }
        }
        @if !diagnosis.cards.is_empty() {
            h3 { "Explanations, the best first" }
            div.cards { @for each in &diagnosis.cards { (card(each, saved, evaluation, current)) } }
        }
    }
}

fn commands(saved: &SavedSession) -> String {
    let steps = saved.steps.iter().take(saved.current + 1);
    let made = steps.filter_map(|step| step.command.clone());
    let mut lines: Vec<String> = made.collect();
    lines.push(saved.diagnose_command());
    lines.push(saved.compare_command());
    lines.join("\n")
}
