//! What a named effect is: its law, and the curve it leaves, drawn from that law.

use super::page::Section;
use super::{AFTER, Report};
use crate::diagnose::FittedEffect;
use crate::effects::signature::{Signature, signature};
use crate::effects::{Axis, Effect, named};
use crate::output::number::given;
use crate::plot::{Chart, Curve, Tone};
use maud::{Markup, html};

pub(super) fn section(report: &Report) -> Option<Section> {
    let effects = kinds(&report.diagnosis.as_ref()?.effects);
    if effects.is_empty() {
        return None;
    }
    Some(Section {
        id: "effects",
        title: "The effects explained",
        lead: "Each picture is drawn from the effect's law with typical or larger values, not \
               with those of this log: it shows the shape to look for.",
        body: html! { @for effect in effects { (explained(effect)) } },
    })
}

/// Each kind once, however many joints have it.
fn kinds(effects: &[FittedEffect]) -> Vec<Effect> {
    let mut kinds: Vec<Effect> = Vec::new();
    for effect in effects.iter().filter_map(as_found) {
        if !kinds
            .iter()
            .any(|known| std::ptr::eq(known.info(), effect.info()))
        {
            kinds.push(effect);
        }
    }
    kinds
}

/// The effect in the units of the joint at which it was found.
fn as_found(effect: &FittedEffect) -> Option<Effect> {
    let hinge = named(&effect.kind)?;
    let has = |of: Effect| {
        let keys = of.info().parameters.iter().map(|parameter| parameter.key);
        keys.eq(effect.parameters.iter().map(|value| value.key.as_str()))
    };
    if has(hinge) {
        Some(hinge)
    } else {
        hinge.on(Axis::Slide)
    }
}

fn explained(effect: Effect) -> Markup {
    let info = effect.info();
    // The shape is that on a bench arm, whatever the joint.
    let hinge = effect.on(Axis::Hinge);
    let drawn = hinge.map(|hinge| chart(hinge, &signature(hinge)));
    html! {
        div.effect {
            div {
                h3 { (info.title) " " code { (info.id) } }
                dl {
                    dt { "Law" } dd { code { (info.law) } }
                    dt { "What it looks like" } dd { (info.looks_like) }
                    dt { "The experiment that reveals it" } dd { (info.experiment) }
                    @if !info.confused_with.is_empty() {
                        dt { "Easily confused with" }
                        @for confusion in info.confusions() {
                            dd { (title(confusion.with)) ": " (confusion.why) }
                        }
                    }
                    dt { "Reference" } dd { (info.reference) }
                }
            }
            @if let Some(chart) = drawn {
                figure { (chart.svg(360.0, 234.0)) figcaption { (chart.legend()) } }
            }
        }
    }
}

/// An effect's title; its id if there is none of that id.
pub(super) fn title(id: &'static str) -> &'static str {
    named(id).map_or(id, |effect| effect.info().title)
}

/// The curve without the effect, and with the values it is drawn for.
pub fn chart(effect: Effect, signature: &Signature) -> Chart {
    let parameters = effect.info().parameters.iter().zip(&signature.values);
    let values =
        parameters.map(|(parameter, value)| format!("{} = {}", parameter.key, given(*value)));
    let with = format!("with {}", values.collect::<Vec<_>>().join(", "));
    Chart::new(
        format!("signature of {}", effect.info().title),
        signature.x_label,
        signature.y_label,
        vec![
            Curve::line("without", Tone::Grey, signature.without.clone()),
            Curve::line(with.trim_end(), AFTER, signature.with.clone()),
        ],
    )
}
