//! Fitted values with their intervals.

use super::Report;
use super::page::{Section, table};
use crate::diagnose::Diagnosis;
use crate::diagnose::names::effect_name;
use crate::effects::parameter;
use crate::fitting::FittedValue;
use crate::output::number::{interval, short, unit};
use crate::plot;
use maud::{Markup, html};

pub(super) fn section(report: &Report) -> Option<Section> {
    let diagnosis = report.diagnosis.as_ref()?;
    let has_effects = diagnosis
        .effects
        .iter()
        .any(|effect| !effect.parameters.is_empty());
    if !has_effects && diagnosis.base.is_empty() && diagnosis.collinear.is_empty() {
        return None;
    }
    let body = html! {
        @if has_effects || !diagnosis.base.is_empty() { (values(diagnosis)) }
        @if !diagnosis.collinear.is_empty() { (collinear(diagnosis)) }
    };
    Some(Section {
        id: "parameters",
        title: "Values and how sure they are",
        lead: "The interval is where the true value lies with 95 % confidence, given this model \
               and these motions. In the picture the dot is the value and the bar its interval; \
               the dashed line is the value at which the effect would vanish. An interval that \
               reaches it proves nothing.",
        body,
    })
}

fn values(diagnosis: &Diagnosis) -> Markup {
    let headings = html! {
        th { "Of" } th { "Parameter" } th.number { "Value" } th.number { "95 % interval" }
        th { "Unit" } th { "Note" }
    };
    let rows = html! {
        @for effect in &diagnosis.effects {
            @for fitted in &effect.parameters {
                @let vanishes_at = parameter(&effect.kind, &fitted.key).and_then(|known| known.off);
                (row(&effect_name(effect), fitted, vanishes_at))
            }
        }
        @for fitted in &diagnosis.base { (row("model, refitted", fitted, None)) }
    };
    table(&headings, &rows)
}

fn row(owner: &str, fitted: &FittedValue, off: Option<f64>) -> Markup {
    let [value, low, high] = interval(fitted.value, fitted.low, fitted.high);
    html! {
        tr {
            td { (owner) }
            td { code { (fitted.path) } }
            td.number { b { (value) } }
            td.number { (low) " to " (high) }
            td { (unit(&fitted.unit)) }
            td {
                (plot::interval(fitted.value, fitted.low, fitted.high, off))
                @if fitted.on_bound { p.bad { "⚠ on its bound: a warning, not a result" } }
            }
        }
    }
}

fn collinear(diagnosis: &Diagnosis) -> Markup {
    html! {
        div.box.warnings {
            h3 { "Hard to tell apart" }
            p {
                "These data hardly separate the following pairs: only a combination of the two is \
                 known well. Another kind of motion would part them."
            }
            ul { @for (one, other, correlation) in &diagnosis.collinear {
                li {
                    code { (one) } " and " code { (other) } ": correlation " (short(*correlation))
                }
            } }
        }
    }
}
