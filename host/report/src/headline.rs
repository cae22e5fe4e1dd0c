//! The verdict in words and the error in one line.

use super::command::with_commands;
use super::words::{floor_interval, in_milli, measured_on, reduction, sentences};
use super::{AFTER, BEFORE, FLOOR, Report};
use crate::compare::Comparison;
use crate::diagnose::Diagnosis;
use crate::diagnose::words::headline;
use crate::fitting::in_windows;
use crate::model::MeasuredSignal;
use crate::output::number::{mrad, short};
use crate::plot::Tone;
use maud::{Markup, html};

/// Top of the page.
pub(super) fn header(report: &Report) -> Markup {
    let verdict = report.diagnosis.as_ref().map(|d| d.verdict.name());
    html! {
        header class={ "verdict-" (verdict.unwrap_or("none")) } {
            p.title { (report.title) }
            @match &report.diagnosis {
                Some(diagnosis) => (diagnosed(diagnosis)),
                None => (compared(report)),
            }
        }
    }
}

fn diagnosed(diagnosis: &Diagnosis) -> Markup {
    html! {
        p { span.badge { (diagnosis.verdict.name()) } }
        h1 { (headline(diagnosis)) }
        (error_line(diagnosis))
        @for sentence in sentences(diagnosis) { p { (sentence) } }
        (list("Next", "next", &diagnosis.next))
        (list("Be wary", "warnings", &diagnosis.warnings))
    }
}

fn error_line(diagnosis: &Diagnosis) -> Markup {
    let error = &diagnosis.error;
    let found = !diagnosis.effects.is_empty() || !diagnosis.wrong_values.is_empty();
    if !error.before_rad.is_finite() {
        return html! {};
    }
    let mut shown = vec![("as given", BEFORE, error.before_rad)];
    shown.extend(error.refitted_rad.map(|rad| ("refitted", BEFORE, rad)));
    if found {
        shown.push(("with what was found", AFTER, error.after_rad));
    }
    shown.push(("floor", FLOOR, error.floor_rad));
    html! {
        (figures(&shown, error.quantity))
        p.note {
            "Typical (RMS) error in " (error.quantity.milli()) ", " (in_windows(&diagnosis.windows))
            ", on " (measured_on(error))
            @if let Some(reduction) = reduction(error).filter(|_| found) { "; " (reduction) }
            ". The floor" (floor_interval(error))
            " is an estimate, from the readings themselves, of what sensor resolution and noise "
            "alone leave: a good model comes near it, and by chance a little below."
        }
    }
}

/// Without a diagnosis the figures are the models' own.
fn compared(report: &Report) -> Markup {
    let error = |comparison: &Comparison| comparison.pooled_rms(|signal| signal.rms);
    let Some(before) = report.before().filter(|c| !c.signals.is_empty()) else {
        return html! { h1 { "Nothing was compared." } };
    };
    let quantity = before.quantity();
    let floor = ("floor", FLOOR, before.pooled_rms(|signal| signal.floor));
    let first = (before.model.as_str(), BEFORE, error(before));
    match report.after() {
        Some(after) => {
            let last = (after.model.as_str(), AFTER, error(after));
            html! {
                h1 {
                    "From " (before.model) " to " (after.model) " the typical error goes from "
                    (in_milli(first.2, quantity)) " to " (in_milli(last.2, quantity)) "."
                }
                (figures(&[first, last, floor], quantity))
            }
        }
        None => html! {
            h1 {
                (before.model) " misses the measurement by typically "
                (in_milli(first.2, quantity)) "."
            }
            (figures(&[first, floor], quantity))
        },
    }
}

/// Figures in a row with arrows between.
fn figures(figures: &[(&str, Tone, f64)], quantity: MeasuredSignal) -> Markup {
    html! {
        div.figures {
            @for (index, (name, tone, error)) in figures.iter().enumerate() {
                @if index > 0 { span.arrow aria-hidden="true" { "→" } }
                div class={ "figure " (tone.class()) } {
                    span.name { (name) }
                    span.value { (mrad(*error)) span.unit { " " (quantity.milli()) } }
                    @if quantity == MeasuredSignal::Angle {
                        span.aside { (short(error.to_degrees())) "°" }
                    }
                }
            }
        }
    }
}

fn list(title: &str, class: &str, items: &[String]) -> Markup {
    html! {
        @if !items.is_empty() {
            div class={ "box " (class) } {
                h2 { (title) }
                ul { @for item in items { li { (with_commands(item)) } } }
            }
        }
    }
}
