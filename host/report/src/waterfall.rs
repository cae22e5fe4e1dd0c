//! How the error falls from model to model, down to the floor; and motion by motion.

use super::command::quoted;
use super::page::{Section, table};
use super::words::{in_columns, in_milli, odd_shares, set_name, with_ends};
use super::{AFTER, BEFORE, FLOOR, Report, pooled};
use crate::compare::Comparison;
use crate::diagnose::{BudgetedPart, MotionError};
use crate::model::MeasuredSignal;
use crate::output::number::{mrad, percent};
use crate::plot::{Bar, largest};
use maud::{Markup, html};

pub(super) fn section(report: &Report) -> Option<Section> {
    let chain: Vec<&Comparison> = report
        .comparisons
        .iter()
        .filter(|comparison| !comparison.signals.is_empty())
        .collect();
    let diagnosis = report.diagnosis.as_ref();
    if chain.is_empty() && diagnosis.is_none_or(|d| d.motions.is_empty()) {
        return None;
    }
    let body = html! {
        @if !chain.is_empty() { (steps(&chain)) }
        @if let Some(diagnosis) = diagnosis {
            @let quantity = diagnosis.error.quantity;
            @if !diagnosis.budget.is_empty() { (by_part(&diagnosis.budget, quantity)) }
            @if !diagnosis.motions.is_empty() { (by_motion(&diagnosis.motions, quantity)) }
        }
    };
    Some(Section {
        id: "fall",
        title: "How the error falls",
        lead: "Each bar is the typical (RMS) error of one model, all joints and motions together. \
               The pale part is what this model gained over the one above it; the thin line is \
               the floor.",
        body,
    })
}

fn steps(chain: &[&Comparison]) -> Markup {
    let quantity = chain[0].quantity();
    let error = |comparison: &Comparison| pooled(comparison, |signal| signal.rms);
    let errors: Vec<f64> = chain.iter().map(|comparison| error(comparison)).collect();
    let floor = pooled(chain[0], |signal| signal.floor);
    let full = largest(errors.iter().copied().chain([floor]));
    let previous = |index: usize| index.checked_sub(1).map(|previous| errors[previous]);
    let bar = |index: usize| Bar {
        ghost: previous(index),
        mark: Some(floor),
        ..Bar::new(errors[index], full, if index == 0 { BEFORE } else { AFTER })
    };
    html! {
        div.steps {
            @for (index, comparison) in chain.iter().enumerate() {
                span.model { (comparison.model) }
                (bar(index).draw())
                span.number {
                    (in_milli(errors[index], quantity))
                    @if let Some(previous) = previous(index) {
                        span.aside { " (" (change(previous, errors[index])) ")" }
                    }
                }
            }
            span { "floor" }
            (Bar::new(floor, full, FLOOR).draw())
            span.number { (in_milli(floor, quantity)) }
        }
    }
}

/// "-45 %", with a proper minus.
fn change(from: f64, to: f64) -> String {
    let share = to / from - 1.0;
    let sign = if share < 0.0 { "−" } else { "+" };
    format!("{sign}{}", percent(share.abs()))
}

/// The error budget: shares that need not add up.
fn by_part(budget: &[BudgetedPart], quantity: MeasuredSignal) -> Markup {
    let [leaves, without] = in_columns(["Leaves", "Without it"], quantity);
    let headings = html! {
        th { "Part" } th.number { "Alone" } th.number { (leaves) }
        th.number { "Beyond the others" } th.number { (without) }
    };
    let rows = html! {
        @for part in budget {
            tr {
                td { (set_name(std::slice::from_ref(&part.part))) }
                td.number { (with_ends(&part.alone)) }
                td.number { (mrad(part.alone.error_rad)) }
                td.number { (with_ends(&part.beyond_others)) }
                td.number { (mrad(part.beyond_others.error_rad)) }
            }
        }
    };
    html! {
        h3 { "What each part removes" }
        p.lead {
            "Shares of the squared error of the model as given, with 95 % intervals: 99 % of it is \
             90 % of the RMS error, which stands beside. Parts that stand in for each other remove \
             much alone and little beyond the others."
            @for sentence in odd_shares(budget) { " " (quoted(sentence)) }
        }
        (table(&headings, &rows))
    }
}

fn by_motion(motions: &[MotionError], quantity: MeasuredSignal) -> Markup {
    let [before, after_change] = in_columns(["Before", "After"], quantity);
    let errors = motions
        .iter()
        .flat_map(|motion| [motion.before_rad, motion.after_rad]);
    let full = largest(errors);
    let after = |motion: &MotionError| Bar {
        ghost: Some(motion.before_rad),
        ..Bar::new(motion.after_rad, full, AFTER)
    };
    let headings = html! {
        th { "Motion" } th { "Role" } th.number { (before) } th.number { (after_change) }
        th.wide { "Drawn" }
    };
    let rows = html! {
        @for motion in motions {
            tr {
                td { (motion.motion) }
                td { @if motion.held_out { "held out" } @else { "fitted" } }
                td.number { (mrad(motion.before_rad)) }
                td.number { (mrad(motion.after_rad)) }
                td.wide { (after(motion).draw()) }
            }
        }
    };
    html! { h3 { "Motion by motion" } (table(&headings, &rows)) }
}
