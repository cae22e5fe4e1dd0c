//! Fitted values with their intervals.

use super::Report;
use super::page::Section;
use super::table::{Columns, columns_of, page_table};
use crate::diagnose::{Diagnosis, FittedEffect};
use crate::effects::{self, parameter};
use crate::fitting::FittedValue;
use crate::model::JointNames;
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
    let names = JointNames::default();
    let base = diagnosis.base.iter().map(|fitted| (None, fitted));
    let values: Vec<EffectValue> = effect_values(&diagnosis.effects).chain(base).collect();
    page_table(&values, &value_columns(&names))
}

/// A fitted value and its effect; without one it is the model's own.
pub(crate) type EffectValue<'v> = (Option<&'v FittedEffect>, &'v FittedValue);

pub(crate) fn effect_values(effects: &[FittedEffect]) -> impl Iterator<Item = EffectValue<'_>> {
    effects.iter().flat_map(|effect| {
        let values = effect.parameters.iter();
        values.map(move |fitted| (Some(effect), fitted))
    })
}

/// The columns of fitted values; joints are called as `names` has them.
pub(crate) fn value_columns<'a, 'v: 'a>(names: &'a JointNames) -> Columns<'a, EffectValue<'v>> {
    let of = |effect: &FittedEffect| match effect.joint {
        Some(joint) => names.joint(joint).map_or(joint.to_string(), str::to_string),
        None if effects::at_all(&effect.kind) == "@all" => "all".to_string(),
        None => "rig".to_string(),
    };
    columns_of::<EffectValue>()
        .text("Effect", |(effect, _)| {
            effect.map_or("model, refitted".into(), |effect| effect.title.clone())
        })
        .number("Joint", move |(effect, _)| effect.map_or(String::new(), of))
        .text("Parameter", |(_, fitted)| fitted.key.clone())
        .drawn_as(|(_, fitted)| html! { code { (fitted.path) } })
        .interval(|(_, fitted)| fitted)
}

impl<'a, T> Columns<'a, T> {
    /// And value, 95 % interval, to the decimals that it deserves, unit, and on pages a picture.
    pub fn interval(self, fitted: impl Fn(&T) -> &FittedValue + Copy + 'a) -> Self {
        let ends = move |row: &T| {
            let fitted = fitted(row);
            interval(fitted.value, fitted.low, fitted.high)
        };
        let range = move |row: &T| ends(row)[1..].join(" to ");
        let is_known = |fitted: &FittedValue| fitted.low.is_finite() && fitted.high.is_finite();
        let bound = |on_bound: bool| if on_bound { "on its bound" } else { "" };
        self.number("Value", move |row| ends(row)[0].clone())
            .number("95 % interval", range)
            .drawn_as(move |row| {
                html! {
                    @if is_known(fitted(row)) { (range(row)) } @else { "not determined" }
                }
            })
            .text("Unit", move |row| unit(&fitted(row).unit).to_string())
            .text("", move |row| bound(fitted(row).on_bound).to_string())
            .called("Note")
            .drawn_as(move |row| note(fitted(row)))
    }
}

/// The interval as a picture.
fn note(fitted: &FittedValue) -> Markup {
    let kind = fitted.path.split(['@', '.']).next();
    let known = kind.and_then(|kind| parameter(kind, &fitted.key));
    let vanishes_at = known.and_then(|known| known.off);
    html! {
        (plot::interval(fitted.value, fitted.low, fitted.high, vanishes_at))
        @if fitted.on_bound { p.bad { "⚠ on its bound: a warning, not a result" } }
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
