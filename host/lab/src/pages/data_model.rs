//! The model on the data page: its columns, its text, the form of a new one.

use super::new_model;
use crate::log::RawLog;
use crate::model::{Column, ColumnMean, Dimension, Model};
use crate::session::{LabSession, SavedSession};
use maud::{Markup, html};

/// The model's sections.
pub fn sections(session: &LabSession, saved: &SavedSession, model: Option<&Model>) -> Markup {
    html! {
        @if let (Some(model), false) = (model, saved.logs.is_empty()) {
            section {
                h2 { "Which column is what" }
                (columns(&names(session, saved), model))
            }
        }
        section {
            h2 { @if model.is_some() { "The model" } @else { "Or type a model" } }
            form data-send="model" {
                p { label for="toml" { "Model file (TOML)" } }
                textarea #toml name="toml" spellcheck="false" {
                    (saved.step().map_or("", |step| &step.toml)) }
                div.row {
                    button.main { @if model.is_some() { "Take this text as the next step" } @else {
                        "Take this model" } }
                    @if model.is_some() { a href={ "/s/" (session.number) "/download/model.toml" } {
                        "Save model.toml" } }
                }
            }
        }
        @if model.is_some() {
            section {
                details {
                    summary { h2 { "Make a new model from a form" } }
                    (new_model::form(session, saved))
                }
            }
        }
    }
}

/// Names of the columns of all logs, each once.
fn names(session: &LabSession, saved: &SavedSession) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for log in &saved.logs {
        // What is wrong with a file is said where the logs are listed.
        let raw = RawLog::read(&session.log_path(&log.file)).unwrap_or_default();
        for name in raw.names {
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    names
}

fn columns(names: &[String], model: &Model) -> Markup {
    let log = &model.log;
    html! {
        p.lead { "The header's names do not say in which unit, with which sign and from which \
                  zero a column counts; the model file does. A BAM log needs no columns." }
        form #columns {
            div.scroll tabindex="0" { table {
                thead { tr { th { "Quantity" } th { "Column" } th { "Unit" } th { "Reversed" } th {
                    "Zero: add, SI" } } }
                tbody {
                    (column(names, "time", "Time", Some(QuantitySource::One(&log.time)),
                        Dimension::Time, true))
                    @for (index, joint) in log.joints.iter().enumerate() {
                        @let number = index + 1;
                        (column(names, &format!("joint{number}.position"),
                            &format!("Angle of joint {number}"),
                            joint.position.as_ref().map(QuantitySource::of),
                            Dimension::Angle.on(model.joints[index].axis()), false))
                        @if let Some(dimension) =
                            Dimension::of_input(
                                model.joints[index].drive.name(),
                                model.joints[index].axis(),
                            ) {
                            (column(names, &format!("joint{number}.input"),
                                &format!("Input of joint {number}"),
                                joint.input.as_ref().map(QuantitySource::of), dimension, true))
                        }
                        (column(names, &format!("joint{number}.velocity"),
                            &format!("Speed of joint {number}"),
                            joint.velocity.as_ref().map(QuantitySource::of),
                            Dimension::Speed.on(model.joints[index].axis()), false))
                        @if model.joints[index].slide.is_none() {
                            @let sensor = joint.rate_sensor.key();
                            (column(names, &format!("joint{number}.{sensor}"),
                                &format!("Own {sensor} of joint {number}"),
                                joint.rate.as_ref().map(QuantitySource::of), Dimension::Speed,
                                false))
                        }
                    }
                    (column(names, "supply", "Supply voltage",
                        log.supply.as_ref().map(QuantitySource::One), Dimension::Voltage, false))
                }
            } }
            div.row { button { "Use these columns" } }
        }
    }
}

/// What a model takes a quantity from.
#[derive(Clone, Copy)]
enum QuantitySource<'a> {
    One(&'a Column),
    /// The mean of several, which the model's text names.
    Mean(&'a ColumnMean),
}

impl<'a> QuantitySource<'a> {
    fn of(mean: &'a ColumnMean) -> Self {
        match mean.columns() {
            [one] => QuantitySource::One(one),
            _ => QuantitySource::Mean(mean),
        }
    }
}

fn column(
    names: &[String],
    quantity: &str,
    title: &str,
    picked: Option<QuantitySource>,
    dimension: Dimension,
    required: bool,
) -> Markup {
    let column = match picked {
        Some(QuantitySource::Mean(mean)) => {
            return html! { tr { td { (title) } td colspan="4" { "the mean of " (mean.name()) } } };
        }
        Some(QuantitySource::One(column)) => Some(column),
        None => None,
    };
    let name = column.map(|column| column.name.as_str());
    let unit = column.map(|column| column.unit.name);
    // The size of the others stands in the model's text.
    let units: Vec<&str> = dimension.plain_units().map(|unit| unit.name).collect();
    let missing = name.filter(|name| !names.iter().any(|known| known == name));
    html! {
        tr data-quantity=(quantity) {
            td { (title) }
            td { select data-field="column" aria-label={ "Column of " (title) } {
                @if !required { option value="" { "none" } }
                @if let Some(missing) = missing { option value=(missing) selected {
                    (missing) " (not in the logs)" } }
                @for known in names { option value=(known) selected[name == Some(known.as_str())] {
                    (known) } }
            } }
            td { select data-field="unit" aria-label={ "Unit of " (title) } {
                @if let Some(unit) = unit.filter(|unit| !units.contains(unit)) {
                    option value=(unit) selected { (unit) }
                }
                @for known in &units { option value=(known) selected[unit == Some(*known)] {
                    (known) } }
            } }
            @if dimension == Dimension::Time { td {} td {} } @else {
                td { input type="checkbox" data-field="reversed" checked[column.is_some_and(|c|
                    c.reversed)] aria-label={ (title) " counts the other way round" }; }
                td { input type="number" step="any" data-field="offset" value=(column.map_or(0.0,
                    |c| c.offset)) aria-label={ "Added to " (title) }; }
            }
        }
    }
}
