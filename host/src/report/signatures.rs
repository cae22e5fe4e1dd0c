//! What a named effect is: its law, and the curve it leaves, drawn from that law.

use super::Report;
use super::page::Section;
use super::scale::{Scale, span};
use super::svg::{Plot, Tone};
use crate::diagnose::FittedEffect;
use crate::effects::signature::{Signature, signature};
use crate::effects::{Effect, named};
use crate::number::given;
use maud::{Markup, html};

pub(super) fn section(report: &Report) -> Option<Section> {
    let effects = kinds(&report.diagnosis.as_ref()?.effects);
    if effects.is_empty() {
        return None;
    }
    Some(Section {
        id: "effects",
        title: "The effects explained",
        lead: "Each picture is drawn from the effect's law with typical or larger values, not with those of this log: \
               it shows the shape to look for.",
        body: html! { @for effect in effects { (explained(effect)) } },
    })
}

/// Each kind once, however many joints have it.
fn kinds(effects: &[FittedEffect]) -> Vec<&'static dyn Effect> {
    let mut kinds: Vec<&'static dyn Effect> = Vec::new();
    for effect in effects.iter().filter_map(|effect| named(&effect.kind)) {
        if !kinds.contains(&effect) {
            kinds.push(effect);
        }
    }
    kinds
}

fn explained(effect: &dyn Effect) -> Markup {
    let info = effect.info();
    let signature = signature(effect);
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
                        @for confusion in info.confused_with {
                            dd {
                                (named(confusion.with).map_or(confusion.with, |other| other.info().title))
                                ": " (confusion.why)
                            }
                        }
                    }
                    dt { "Reference" } dd { (info.reference) }
                }
            }
            figure {
                (curves(info.title, &signature))
                figcaption {
                    span.key.tone-after { span.swatch {} "with" (values(effect, &signature)) }
                    span.key.tone-quiet { span.swatch {} "without" }
                }
            }
        }
    }
}

fn values(effect: &dyn Effect, signature: &Signature) -> String {
    let pairs = effect.info().parameters.iter().zip(&signature.values);
    let values: Vec<String> = pairs
        .map(|(parameter, value)| format!("{} = {}", parameter.key, given(*value)))
        .collect();
    if values.is_empty() {
        String::new()
    } else {
        format!(" {}", values.join(", "))
    }
}

fn curves(title: &str, signature: &Signature) -> Markup {
    let points = || signature.without.iter().chain(&signature.with);
    let plot = Plot {
        x: Scale::new(span(points().map(|point| point.0), 0.0), (50.0, 350.0)),
        y: Scale::new(span(points().map(|point| point.1), 0.06), (190.0, 20.0)),
    };
    html! {
        svg viewBox="0 0 360 226" role="img" aria-label={ "signature of " (title) } {
            (plot.columns(5)) (plot.rows(5, signature.y_label)) (plot.x_labels(5, signature.x_label))
            (plot.curve(signature.without.iter().copied(), Tone::Quiet))
            (plot.curve(signature.with.iter().copied(), Tone::After))
        }
    }
}
