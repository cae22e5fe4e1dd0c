//! Where the model fails: conditions that hold more than their share of the error.

use super::page::Section;
use super::{AFTER, BEFORE, Report};
use crate::compare::{Comparison, Failure};
use crate::output::number::percent;
use crate::plot::{Bar, Tone};
use maud::{Markup, html};

pub(super) fn section(report: &Report) -> Option<Section> {
    let ends = [(report.before(), BEFORE), (report.after(), AFTER)];
    let none = |(end, _): &(Option<&Comparison>, Tone)| end.is_none_or(|c| c.failures.is_empty());
    if ends.iter().all(none) {
        return None;
    }
    let body = html! {
        @for (comparison, tone) in ends {
            @if let Some(comparison) = comparison { (conditions(comparison, tone)) }
        }
    };
    Some(Section {
        id: "failures",
        title: "Where it fails",
        lead: "If errors were spread evenly, a condition that covers a tenth of the samples would \
               hold a tenth of the error. Where the error's bar is much longer than the samples' \
               bar, the physics of that condition is what the model gets wrong.",
        body,
    })
}

fn conditions(comparison: &Comparison, tone: Tone) -> Markup {
    html! {
        h3 { (comparison.model) }
        @if comparison.failures.is_empty() {
            p { "No condition holds more than its share of the error." }
        }
        div.failures {
            @for failure in &comparison.failures { (bars(failure, tone)) }
        }
    }
}

fn bars(failure: &Failure, tone: Tone) -> Markup {
    html! {
        div.failure {
            p { b { "Joint " (failure.joint) ", " (failure.condition) } }
            div.pair {
                span { "error" }
                (Bar::new(failure.error_share, 1.0, tone).draw())
                span.number { (percent(failure.error_share)) }
                span { "samples" }
                (Bar::new(failure.sample_share, 1.0, Tone::Grey).draw())
                span.number { (percent(failure.sample_share)) }
            }
            p.note { (failure.sentence) }
        }
    }
}
