//! How the error falls from model to model, down to the floor; and motion by motion.

use super::command::quoted;
use super::page::Section;
use super::table::{Columns, columns_of, page_table};
use super::words::{in_columns, in_milli, odd_shares, set_name, with_ends};
use super::{AFTER, BEFORE, FLOOR, Report};
use crate::compare::Comparison;
use crate::diagnose::{BudgetedPart, MotionError};
use crate::model::{JointNames, MeasuredSignal};
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
    let error = |comparison: &Comparison| comparison.pooled_rms(|signal| signal.rms);
    let errors: Vec<f64> = chain.iter().map(|comparison| error(comparison)).collect();
    let floor = chain[0].pooled_rms(|signal| signal.floor);
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
    let names = JointNames::default();
    html! {
        h3 { "What each part removes" }
        p.lead {
            "Shares of the squared error of the model as given, with 95 % intervals: 99 % of it is \
             90 % of the RMS error, which stands beside. Parts that stand in for each other remove \
             much alone and little beyond the others."
            @for sentence in odd_shares(budget) { " " (quoted(sentence)) }
        }
        (page_table(budget, &budget_columns(&names, quantity)))
    }
}

/// The columns of an error budget; joints are called as `names` has them.
pub(crate) fn budget_columns(
    names: &JointNames,
    quantity: MeasuredSignal,
) -> Columns<'_, BudgetedPart> {
    let [leaves, without] = in_columns(["leaves", "without it"], quantity);
    columns_of::<BudgetedPart>()
        .text("Error budget", |part| names.in_text(&part.part))
        .drawn_as(|part| html! { (set_name(std::slice::from_ref(&part.part))) })
        .number("Alone", |part| with_ends(&part.alone))
        .number(leaves, |part| mrad(part.alone.error_rad))
        .number("Beyond the others", |part| with_ends(&part.beyond_others))
        .number(without, |part| mrad(part.beyond_others.error_rad))
}

fn by_motion(motions: &[MotionError], quantity: MeasuredSignal) -> Markup {
    let [before, after] = in_columns(["Before", "After"], quantity);
    let errors = motions.iter();
    let full = largest(errors.flat_map(|motion| [motion.before_rad, motion.after_rad]));
    let bar = |motion: &MotionError| Bar {
        ghost: Some(motion.before_rad),
        ..Bar::new(motion.after_rad, full, AFTER)
    };
    let role = |held_out: bool| if held_out { "held out" } else { "fitted" };
    let columns = columns_of::<MotionError>()
        .text("Motion", |motion| motion.motion.clone())
        .text("Role", |motion| role(motion.held_out).to_string())
        .number(before, |motion| mrad(motion.before_rad))
        .number(after, |motion| mrad(motion.after_rad))
        .drawn("Drawn", |motion| bar(motion).draw())
        .class("wide");
    html! { h3 { "Motion by motion" } (page_table(motions, &columns)) }
}
