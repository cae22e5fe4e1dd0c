//! What the lab adds to a report: the diagnosis as its title, values, notes.

use super::values;
use crate::report::page::Section;
use crate::session::{SavedSession, SavedStep};
use maud::{Markup, html};

/// The verdict in a sentence, where there is one; else what was compared.
pub fn title(saved: &SavedSession) -> String {
    let said = saved.diagnosis.as_ref();
    let headline = said.and_then(|said| said.summary.first());
    match headline {
        Some(headline) => headline.clone(),
        None => match saved.step() {
            Some(step) if saved.current > 0 => format!("{}, against measured motions", step.title),
            _ => "The model against measured motions".into(),
        },
    }
}

/// Verdict, values and notes, where there are any.
pub fn sections(saved: &SavedSession) -> Vec<Section> {
    let steps = || saved.steps.iter().take(saved.current + 1).enumerate();
    let mut sections = Vec::new();
    if let Some(said) = &saved.diagnosis {
        sections.push(Section {
            id: "verdict",
            title: "What the diagnosis says",
            lead: "The verdict on one of the models, and what it rests on.",
            body: html! {
                p { b { "Diagnosis of model " (said.step) ": " (said.verdict.replace('_', " ")) } }
                @for line in &said.summary { p { (line) } }
                @if !said.warnings.is_empty() {
                    h3 { "Be wary" }
                    ul { @for line in &said.warnings { li { (line) } } }
                }
            },
        });
    }
    if steps().any(|(_, step)| !step.values.is_empty()) {
        sections.push(of_steps(
            ("values", "Fitted values"),
            "With their 95 % intervals; a later step may fit a value again.",
            steps().filter(|(_, step)| !step.values.is_empty()),
            values::table,
        ));
    }
    if steps().any(|(_, step)| !step.note.is_empty()) {
        sections.push(of_steps(
            ("notes", "Notes"),
            "What was written down along the way.",
            steps().filter(|(_, step)| !step.note.is_empty()),
            |step| html! { p { (step.note) } },
        ));
    }
    sections
}

fn of_steps<'a>(
    (id, title): (&'static str, &'static str),
    lead: &'static str,
    steps: impl Iterator<Item = (usize, &'a SavedStep)>,
    body: impl Fn(&SavedStep) -> Markup,
) -> Section {
    Section {
        id,
        title,
        lead,
        body: html! {
            @for (index, step) in steps {
                h3 { "Model " (index) ": " (step.title) }
                (body(step))
            }
        },
    }
}
