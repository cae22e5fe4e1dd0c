//! Where the page comes from, and how to read it.

use super::Report;
use super::page::Section;
use maud::{Markup, html};

pub(super) fn section(report: &Report) -> Option<Section> {
    let made = &report.provenance;
    let role = |held_out: bool| if held_out { "log, held out" } else { "log" };
    let body = html! {
        p { "Program version " b { (made.program_version) } "." }
        pre { code { (made.command) } }
        div.scroll { table {
            thead { tr { th { "File" } th { "Kind" } th.number { "Samples" } th { "SHA-256" } } }
            tbody {
                @for file in &made.model_files { (row(&file.name, "model", None, &file.sha256)) }
                @for file in &made.logs { (row(&file.name, role(file.held_out), Some(file.samples), &file.sha256)) }
            }
        } }
    };
    Some(Section {
        id: "provenance",
        title: "Where this comes from",
        lead: "The same program, command and files make the same page again. The hashes tell whether a file is the \
               same to the last bit.",
        body,
    })
}

fn row(name: &str, kind: &str, samples: Option<usize>, sha256: &str) -> Markup {
    html! {
        tr {
            td { (name) }
            td { (kind) }
            td.number { @if let Some(samples) = samples { (samples) } }
            td { code.hash { (sha256) } }
        }
    }
}

/// A term and its meaning.
type Term = (&'static str, &'static str);

const TERMS: &[Term] = &[
    (
        "Residual",
        "Measured minus predicted. What the model fails to say.",
    ),
    (
        "RMS",
        "Root of the mean of the squared errors: the typical size of an error, in the unit of the angle.",
    ),
    (
        "mrad",
        "Milliradian, a thousandth of a radian: 0.0573 degrees. A 10 cm arm that is off by 10 mrad misses by 1 mm.",
    ),
    (
        "Floor",
        "The error that the sensor's resolution and noise alone would leave. Even the true model could not do better.",
    ),
    (
        "Fit %",
        "How much of the motion the model reproduces. 100 % is perfect; at 0 % a straight line through the mean would \
         do as well; it may be negative.",
    ),
    (
        "Free run",
        "The model gets the start and the inputs, and then runs without looking at the measurement again. Where a \
         whole motion can't be run so, it starts afresh in windows.",
    ),
];

const DIAGNOSIS_TERMS: &[Term] = &[
    (
        "Held out",
        "Motions that took no part in the fit. An explanation counts only if it predicts those too.",
    ),
    (
        "95 % interval",
        "A range that would contain the true value in 95 of 100 repetitions of the experiment, if the model is right.",
    ),
    (
        "BIC",
        "Bayesian information criterion: rewards a smaller error and charges for every added parameter. Lower is better.",
    ),
    (
        "Collinear",
        "Two parameters that change the motion in nearly the same way, so that one can make up for the other.",
    ),
];

pub(super) fn glossary(report: &Report) -> Option<Section> {
    let more = report
        .diagnosis
        .as_ref()
        .map_or(&[][..], |_| DIAGNOSIS_TERMS);
    Some(Section {
        id: "terms",
        title: "How to read this page",
        lead: "The terms it uses.",
        body: html! {
            dl.terms { @for (term, meaning) in TERMS.iter().chain(more) { dt { (term) } dd { (meaning) } } }
        },
    })
}
