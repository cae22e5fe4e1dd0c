//! What is left: how much a free form could still gain, and tests of the residual.

use super::Report;
use super::page::Section;
use super::table::{columns_of, page_table};
use crate::compare::{Comparison, ResidualTest, SignalError};
use crate::diagnose::ResidualStructure;
use crate::output::number::{percent, short};
use maud::{Markup, html};

pub(super) fn section(report: &Report) -> Option<Section> {
    let structure = report
        .diagnosis
        .as_ref()
        .and_then(|d| d.residual_structure.as_ref());
    let last = report.comparisons.last();
    let tested = last.is_some_and(|last| last.signals.iter().any(|s| !s.tests.is_empty()));
    if structure.is_none() && !tested {
        return None;
    }
    let body = html! {
        @if let Some(structure) = structure {
            p { (free_form(structure)) " The least of it holds with 95 % confidence." }
        }
        @if let Some(last) = last.filter(|_| tested) { (tests(last)) }
    };
    Some(Section {
        id: "remains",
        title: "What is left",
        lead: "Whether the last model leaves something that physics could still explain.",
        body,
    })
}

/// How much a free form could still gain, in a sentence.
pub(crate) fn free_form(structure: &ResidualStructure) -> String {
    format!(
        "Residual structure: a free form could still gain {} (at least {}) of the squared error \
         above the floor; it leans on {}.",
        percent(structure.explainable_share.clamp(0.0, 1.0)),
        percent(structure.explainable_low.clamp(0.0, 1.0)),
        structure.shape
    )
}

/// A signal and a test of its residual.
type Tested<'a> = (&'a SignalError, &'a ResidualTest);

fn tests(comparison: &Comparison) -> Markup {
    let signals = comparison.signals.iter();
    let tests = signals.flat_map(|signal| signal.tests.iter().map(move |test| (signal, test)));
    let result = |passed: bool| if passed { "✓ passes" } else { "✗ fails" };
    let columns = columns_of::<Tested>()
        .number("Joint", |(signal, _)| signal.label())
        .text("Test", |(_, test)| test.name.to_string())
        .text("Result", |(_, test)| result(test.passed).to_string())
        .judged(|(_, test)| test.passed)
        .number("Statistic", |(_, test)| short(test.statistic))
        .number("Limit", |(_, test)| short(test.threshold))
        .text("What it means", |(_, test)| test.meaning.clone());
    html! {
        h3 { "Tests of the residual: " (comparison.model) }
        (page_table(&tests.collect::<Vec<_>>(), &columns))
    }
}
