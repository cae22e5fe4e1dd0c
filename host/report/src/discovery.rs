//! A discovery as text, and its law with pictures: the law, what it leaves, and what else would do.

use crate::AFTER;
use crate::page::Section;
use crate::plot::{Chart, Curve, Tone};
use crate::text::{error, list, parameters};
use crate::words::in_milli;
use handstand_diagnose::diagnose::words::change;
use handstand_diagnose::discover::{
    DiscoveredTerm, Discovery, DiscoveryVerdict, OtherLaw, TermPicture, TermVariable,
};
use handstand_model::model::JointNames;
use maud::html;

/// Laws shown beside the one found.
const SHOWN: usize = 5;

/// Everything a discovery says that fits a terminal.
pub fn discovery_text(discovery: &Discovery, names: &JointNames) -> String {
    let diagnosis = &discovery.diagnosis;
    let mut headline = vec![format!("Verdict: {}", verdict_sentence(discovery))];
    if discovery.verdict == DiscoveryVerdict::Unfit {
        headline.extend(diagnosis.summary.iter().cloned());
    }
    let law = discovered_terms(discovery, names);
    let wrong = diagnosis.wrong_values.iter();
    let wrong = wrong.map(|wrong| format!("{}: {}", wrong.fitted.path, change(wrong)));
    let sections = [
        Some(headline.join("\n")),
        list("The model lacks, in sum", &law),
        list("Wrong values", &wrong.collect::<Vec<_>>()),
        parameters("Values", &diagnosis.effects, names),
        error(diagnosis),
        list("As good", &others(discovery, names)),
        list("Next", &diagnosis.next),
        list("Warnings", &diagnosis.warnings),
    ];
    let sections: Vec<String> = sections.into_iter().flatten().collect();
    names.in_text(&sections.join("\n\n")) + "\n"
}

/// The law with its pictures, for the page of a report.
pub fn law_section(discovery: &Discovery, names: &JointNames) -> Option<Section> {
    if !discovery.has_law() {
        return None;
    }
    let drawn = |term: &DiscoveredTerm| {
        let own = |p: &&TermPicture| p.kind == term.kind && Some(p.joint) == term.joint;
        discovery.pictures.iter().find(own).map(term_chart)
    };
    Some(Section {
        id: "law",
        title: "The law that is missing",
        lead: "The sum of these terms. Curve: the law. Dots: what the motions ask for where any \
               torque over this variable is allowed, with 95 % intervals; where they leave the \
               curve its shape is wrong.",
        body: html! {
            p { (verdict_sentence(discovery)) }
            @for term in &discovery.terms {
                div.effect {
                    div { p { code { (line(term, names)) } } }
                    @if let Some(chart) = drawn(term) {
                        figure { (chart.svg(420.0, 260.0)) figcaption { (chart.legend()) } }
                    }
                }
            }
        },
    })
}

/// A term beside what the motions say.
pub fn term_chart(picture: &TermPicture) -> Chart {
    let x_label = match (picture.variable, picture.slides) {
        (TermVariable::Angle, false) => "angle, rad",
        (TermVariable::Angle, true) => "displacement, m",
        (TermVariable::Speed, false) => "speed, rad/s",
        (TermVariable::Speed, true) => "speed, m/s",
        (TermVariable::Drive, false) => "torque of the drive, N m",
        (TermVariable::Drive, true) => "force of the drive, N",
    };
    let y_label = match (picture.is_friction, picture.slides) {
        (true, false) => "friction, N m",
        (true, true) => "friction, N",
        (false, false) => "torque, N m",
        (false, true) => "force, N",
    };
    let curve = picture.curve.iter().map(|[x, y]| (*x, *y));
    let points = picture.points.iter().map(|[x, y, ..]| (*x, *y));
    let mut measured = Curve::dots("motions", Tone::Ink, points.collect());
    let ends = picture.points.iter().map(|[_, _, low, high]| [*low, *high]);
    measured.intervals = ends.collect();
    let law = Curve::line("law", AFTER, curve.collect());
    Chart::new(
        format!("{} over its variable", picture.kind),
        x_label,
        y_label,
        vec![measured, law],
    )
}

/// The verdict in a sentence.
pub fn verdict_sentence(discovery: &Discovery) -> &'static str {
    match discovery.verdict {
        DiscoveryVerdict::NothingMissing => {
            "nothing is missing. The model explains the logs to their noise."
        }
        DiscoveryVerdict::WrongValue => {
            "wrong value. With other values in the file nothing is missing."
        }
        DiscoveryVerdict::Found => "found. This law leaves nothing but noise.",
        DiscoveryVerdict::Ambiguous if discovery.others.is_empty() => {
            "found. This law leaves nothing but noise, and is not proven to be the only one."
        }
        DiscoveryVerdict::Ambiguous => {
            "found, and not alone. Other laws leave as little: the logs do not tell them apart."
        }
        DiscoveryVerdict::Partial if discovery.is_cut_short() => {
            "a part, so far. The search was ended, and what was not tried may explain the rest."
        }
        DiscoveryVerdict::Partial => {
            "a part. This law removes a part of the error; more than noise is left, and more \
             terms do not explain it."
        }
        DiscoveryVerdict::NotFound if discovery.is_cut_short() => {
            "not found so far. The search was ended, and what was not tried may hold the law."
        }
        DiscoveryVerdict::NotFound => {
            "not found. No law of the joint's angle, speed, load, input, supply or time explains \
             what is left: it depends on the past, or on a body that is not measured."
        }
        DiscoveryVerdict::Unfit => "unfit.",
    }
}

/// The terms of the law with their values, each of its joint.
pub fn discovered_terms(discovery: &Discovery, names: &JointNames) -> Vec<String> {
    let terms = discovery.terms.iter();
    terms.map(|term| line(term, names)).collect()
}

/// "joint 1: torque = -0.0112 * dir * abs(w / 5)^2.98 (drag_power)"
fn line(term: &DiscoveredTerm, names: &JointNames) -> String {
    let place = match term.joint {
        Some(joint) => names
            .joint(joint)
            .map_or(format!("joint {joint}"), str::to_string),
        None => "every driven joint".to_string(),
    };
    format!("{place}: {} = {}", term.site, term.with_values)
}

fn others(discovery: &Discovery, names: &JointNames) -> Vec<String> {
    let quantity = discovery.diagnosis.error.quantity;
    let other = |other: &OtherLaw| {
        let terms = other.terms.iter().map(|term| line(term, names));
        let terms = terms.collect::<Vec<_>>().join(" and ");
        format!("{}: {terms}", in_milli(other.error_rad, quantity))
    };
    let mut lines: Vec<String> = discovery.others.iter().take(SHOWN).map(other).collect();
    if discovery.others.len() > SHOWN {
        lines.push(format!("and {} more", discovery.others.len() - SHOWN));
    }
    lines
}
