//! The explanations that were tried, with the evidence for and against each.

use super::page::{Section, table};
use super::words::{in_columns, in_milli, set_name, sorted};
use super::{AFTER, BEFORE, Report};
use crate::diagnose::words::{SHOWN, explained_by};
use crate::diagnose::{Alternative, Diagnosis, RuledOut};
use crate::model::MeasuredSignal;
use crate::output::number::{NONE, mrad, short};
use crate::plot::{Bar, largest};
use maud::{Markup, html};

/// Rows that are in sight from the start.
const OPEN: usize = 8;

pub(super) fn section(report: &Report) -> Option<Section> {
    let diagnosis = report.diagnosis.as_ref()?;
    if diagnosis.ruled_out.is_empty() && diagnosis.alternatives.is_empty() {
        return None;
    }
    let body = html! {
        @if !diagnosis.alternatives.is_empty() {
            (alternatives(&diagnosis.alternatives, diagnosis.error.quantity))
        }
        @if !diagnosis.ruled_out.is_empty() { (tried(diagnosis)) }
    };
    Some(Section {
        id: "candidates",
        title: "What else was tried",
        lead: "Every candidate was fitted on the same motions; the promising ones then had to \
               predict motions they had not seen. A wrong candidate may fit well and yet predict \
               badly. BIC weighs the gain against the number of added parameters: the more \
               negative, the better.",
        body,
    })
}

fn alternatives(alternatives: &[Alternative], quantity: MeasuredSignal) -> Markup {
    html! {
        h3 { "These do as well: the data do not rule them out" }
        ul { @for alternative in alternatives.iter().take(SHOWN) {
            li {
                b { (explained_by(&alternative.effects, &alternative.wrong_values)) }
                ": error " (in_milli(alternative.error_rad, quantity))
                @for fitted in alternative.effects.iter().flat_map(|effect| &effect.parameters) {
                    span.note { "; " (fitted.key) " = " (fitted) }
                }
            }
        }
        @if alternatives.len() > SHOWN { li { "and " (alternatives.len() - SHOWN) " more" } } }
    }
}

fn error(tried: &RuledOut) -> f64 {
    tried.held_out_error_rad.unwrap_or(tried.training_error_rad)
}

/// What was tried and not chosen: what does as well, then what does worse.
fn tried(diagnosis: &Diagnosis) -> Markup {
    let errors = diagnosis.ruled_out.iter().map(error);
    let full = largest(errors.chain([diagnosis.error.after_rad]));
    let as_good = sorted(&diagnosis.ruled_out, true);
    let worse = sorted(&diagnosis.ruled_out, false);
    html! {
        @if !as_good.is_empty() {
            h3 { "As good, not needed" }
            p.note {
                "These motions do not tell them from the explanation that was chosen: they are not "
                "ruled out, but the chosen one is simpler."
            }
            (folded(diagnosis, &as_good, full))
        }
        @if !worse.is_empty() {
            h3 { "Ruled out" }
            (folded(diagnosis, &worse, full))
        }
        p.note {
            "Bars show the held-out error; pale ones the fitted error of candidates that came no "
            "further. The thin line is the error of the explanation on top."
        }
    }
}

/// The first rows in sight, the others behind a title.
fn folded(diagnosis: &Diagnosis, tried: &[&RuledOut], full: f64) -> Markup {
    let (first, rest) = tried.split_at(tried.len().min(OPEN));
    html! {
        (rows(diagnosis, first, full, found(diagnosis)))
        @if !rest.is_empty() {
            details {
                summary { (rest.len()) " more" }
                (rows(diagnosis, rest, full, false))
            }
        }
    }
}

fn rows(diagnosis: &Diagnosis, tried: &[&RuledOut], full: f64, with_best: bool) -> Markup {
    let chosen = diagnosis.error.after_rad;
    let [fitted, held_out] = in_columns(["Fitted", "Held out"], diagnosis.error.quantity);
    let headings = html! {
        th { "Added to the model" } th.number { (fitted) } th.number { (held_out) }
        th.wide { "Drawn" } th.number { "BIC change" } th { "Why not" }
    };
    let rows = html! {
        @if with_best { (best(diagnosis, full)) }
        @for tried in tried { (row(tried, full, chosen)) }
    };
    html! { div.tried { (table(&headings, &rows)) } }
}

fn found(diagnosis: &Diagnosis) -> bool {
    !diagnosis.effects.is_empty() || !diagnosis.wrong_values.is_empty()
}

/// The chosen explanation, to compare with.
fn best(diagnosis: &Diagnosis, full: f64) -> Markup {
    let after = diagnosis.error.after_rad;
    let (fitted, held_out) = if diagnosis.error.held_out {
        (NONE.to_string(), mrad(after))
    } else {
        (mrad(after), NONE.to_string())
    };
    html! {
        tr.best {
            td { (explained_by(&diagnosis.effects, &diagnosis.wrong_values)) }
            td.number { (fitted) }
            td.number { (held_out) }
            td.wide { (Bar::new(after, full, AFTER).draw()) }
            td.number { (NONE) }
            td { "best found" }
        }
    }
}

fn row(tried: &RuledOut, full: f64, chosen: f64) -> Markup {
    let error = error(tried);
    let (solid, ghost) = match tried.held_out_error_rad {
        Some(_) => (error, None),
        None => (0.0, Some(error)),
    };
    let bar = Bar {
        ghost,
        mark: Some(chosen),
        ..Bar::new(solid, full, BEFORE)
    };
    html! {
        tr {
            td { (set_name(&tried.set)) br; code { (tried.set.join(" + ")) } }
            td.number { (mrad(tried.training_error_rad)) }
            td.number { (tried.held_out_error_rad.map_or(NONE.into(), mrad)) }
            td.wide { (bar.draw()) }
            td.number { (short(tried.bic_change)) }
            td { (tried.why) }
        }
    }
}
