//! Fitted values with their 95 % intervals and units.

use crate::fitting::FittedValue;
use crate::report::table::{columns_of, page_table};
use crate::session::{SavedStep, value_name};
use maud::{Markup, html};

/// The table of what a step's fit gave; nothing where it had none.
pub fn table(step: &SavedStep) -> Markup {
    let values: Vec<FittedValue> = step.values.iter().map(FittedValue::from).collect();
    let columns = columns_of::<FittedValue>()
        .text("Of", |value| value_name(&value.path))
        .drawn("Parameter", |value| html! { code { (value.path) } })
        .interval(|value| value);
    html! { @if !values.is_empty() { (page_table(&values, &columns)) } }
}
