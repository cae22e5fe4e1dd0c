//! Fitted values with their 95 % intervals and units.

use crate::output::number::{exact, interval, unit};
use crate::session::{SavedStep, SavedValue, value_name};
use maud::{Markup, html};

/// The table of what a step's fit gave; nothing where it had none.
pub fn table(step: &SavedStep) -> Markup {
    html! {
        @if !step.values.is_empty() {
            div.scroll tabindex="0" { table.values {
                thead { tr {
                    th { "Value" } th.number { "Fitted" } th.number { "95 % interval" } th { "Unit" }
                    th { "In the model file" }
                } }
                tbody { @for value in &step.values { (row(value)) } }
            } }
        }
    }
}

fn row(value: &SavedValue) -> Markup {
    let ends = value.low.zip(value.high);
    let [fitted, low, high] = match ends {
        Some((low, high)) => interval(value.value, low, high),
        None => [exact(value.value), String::new(), String::new()],
    };
    html! {
        tr {
            td { (value_name(&value.path)) }
            td.number { (fitted) }
            td.number {
                @if ends.is_some() { (low) " to " (high) } @else { "not determined" }
                @if value.on_bound { span.bad { " on its bound" } }
            }
            td { (unit(&value.unit)) }
            td { code { (value.path) } }
        }
    }
}
