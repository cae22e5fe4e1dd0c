//! What is left: how much a free form could still gain, how the error grows with time, tests of the
//! residual.

use super::Report;
use super::page::{Section, table};
use crate::compare::{Comparison, HorizonError};
use crate::diagnose::ResidualStructure;
use crate::output::number::{NONE, given, mrad, percent, short};
use maud::{Markup, html};

pub(super) fn section(report: &Report) -> Option<Section> {
    let structure = report
        .diagnosis
        .as_ref()
        .and_then(|d| d.residual_structure.as_ref());
    let horizons = horizons(&report.comparisons);
    let last = report.comparisons.last();
    let tested = last.is_some_and(|last| last.signals.iter().any(|s| !s.tests.is_empty()));
    if structure.is_none() && horizons.is_empty() && !tested {
        return None;
    }
    let body = html! {
        @if let Some(structure) = structure { (left(structure)) }
        @if !horizons.is_empty() { (growth(&report.comparisons, &horizons)) }
        @if let Some(last) = last.filter(|_| tested) { (tests(last)) }
    };
    Some(Section {
        id: "remains",
        title: "What is left",
        lead: "Whether the last model leaves something that physics could still explain.",
        body,
    })
}

fn left(structure: &ResidualStructure) -> Markup {
    html! {
        p {
            "A free-form term could still gain "
            b { (percent(structure.explainable_share.clamp(0.0, 1.0))) }
            " of the remaining squared error above the floor (at least "
            (percent(structure.explainable_low.clamp(0.0, 1.0)))
            " with 95 % confidence). It leans on: " (structure.shape) "."
        }
    }
}

/// Every window length that any model was run with.
fn horizons(comparisons: &[Comparison]) -> Vec<Option<f64>> {
    let horizons = comparisons
        .iter()
        .flat_map(|comparison| &comparison.horizons);
    let mut all: Vec<Option<f64>> = horizons.map(|horizon| horizon.horizon_s).collect();
    let length = |horizon: &Option<f64>| horizon.unwrap_or(f64::INFINITY);
    all.sort_by(|a, b| length(a).total_cmp(&length(b)));
    all.dedup();
    all
}

fn growth(comparisons: &[Comparison], horizons: &[Option<f64>]) -> Markup {
    let error = |comparison: &Comparison, horizon: Option<f64>| {
        let same = |error: &&HorizonError| error.horizon_s == horizon;
        let found = comparison.horizons.iter().find(same);
        found.map_or(NONE.into(), |error| mrad(error.rms))
    };
    let name = |horizon: &Option<f64>| match horizon {
        Some(seconds) => format!("{} s", given(*seconds)),
        None => "whole motion".into(),
    };
    let headings = html! {
        th { "Model" }
        @for horizon in horizons { th.number { (name(horizon)) } }
    };
    let rows = html! {
        @for comparison in comparisons.iter().filter(|c| !c.horizons.is_empty()) {
            tr {
                td { (comparison.model) }
                @for horizon in horizons { td.number { (error(comparison, *horizon)) } }
            }
        }
    };
    html! {
        h3 { "Error against time without correction" }
        p.note {
            "RMS error in mrad when the model starts afresh from the measurement every so often. \
             Wrong physics grows with time; noise does not."
        }
        (table(&headings, &rows))
    }
}

fn tests(comparison: &Comparison) -> Markup {
    let headings = html! {
        th.number { "Joint" } th { "Test" } th { "Result" } th.number { "Statistic" }
        th.number { "Limit" } th { "What it means" }
    };
    let rows = html! {
        @for signal in &comparison.signals {
            @for test in &signal.tests {
                tr {
                    td.number { (signal.joint) @if signal.beside_angle { ", rate" } }
                    td { (test.name) }
                    td {
                        @if test.passed { span.good { "✓ passes" } }
                        @else { span.bad { "✗ fails" } }
                    }
                    td.number { (short(test.statistic)) }
                    td.number { (short(test.threshold)) }
                    td { (test.meaning) }
                }
            }
        }
    };
    html! { h3 { "Tests of the residual: " (comparison.model) } (table(&headings, &rows)) }
}
