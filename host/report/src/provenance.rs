//! Where the page comes from, and how to read it.

use super::Report;
use super::page::Section;
use super::table::{columns_of, page_table};
use crate::output::table::or_empty;
use maud::{Markup, html};

pub(super) fn section(report: &Report) -> Option<Section> {
    let made = &report.provenance;
    let models = made.model_files.iter();
    let models = models.map(|file| (&file.name, "model", None, &file.sha256));
    let logs = made.logs.iter().map(|log| {
        let kind = if log.held_out { "log, held out" } else { "log" };
        (&log.name, kind, Some(log.samples), &log.sha256)
    });
    let columns = columns_of::<(&String, &str, Option<usize>, &String)>()
        .text("File", |(name, ..)| name.to_string())
        .text("Kind", |(_, kind, ..)| kind.to_string())
        .number("Samples", |(_, _, samples, _)| or_empty(*samples))
        .drawn("SHA-256", |(.., sha256)| html! { code.hash { (sha256) } });
    let body = html! {
        p { "Program version " b { (made.program_version) } "." }
        pre { code.command { (made.command) } }
        (page_table(&models.chain(logs).collect::<Vec<_>>(), &columns))
    };
    Some(Section {
        id: "provenance",
        title: "Where this comes from",
        lead: "The same program, command and files make the same page again. The hashes tell \
               whether a file is the same to the last bit.",
        body,
    })
}

/// The terms that the page uses.
pub(super) fn terms(report: &Report) -> Option<Section> {
    let body = html! {
        dl.terms {
            dt { "Residual" } dd { "Measured minus predicted. What the model fails to say." }
            dt { "RMS" } dd {
                "Root of the mean of the squared errors: the typical size of an error, in the unit \
                 of the angle."
            }
            dt { "mrad" } dd {
                "Milliradian, a thousandth of a radian: 0.0573 degrees. A 10 cm arm that is off by \
                 10 mrad misses by 1 mm."
            }
            dt { "Floor" } dd {
                "The error that the sensor's resolution and noise alone would leave, estimated \
                 from the readings themselves. The true model lies near it; the estimate may be \
                 too high or too low by its interval, and by more where a driver filters the \
                 readings."
            }
            dt { "Fit %" } dd {
                "How much of the motion the model reproduces. 100 % is perfect; at 0 % a straight \
                 line through the mean would do as well; it may be negative."
            }
            dt { "Free run" } dd {
                "The model gets the start and the inputs, and then runs without looking at the \
                 measurement again. Where a whole motion can't be run so, it starts afresh in \
                 windows."
            }
            @if report.diagnosis.is_some() { (diagnosis_terms()) }
        }
    };
    Some(Section {
        id: "terms",
        title: "How to read this page",
        lead: "The terms it uses.",
        body,
    })
}

fn diagnosis_terms() -> Markup {
    html! {
        dt { "Held out" } dd {
            "Motions that took no part in the fit. An explanation counts only if it predicts those \
             too."
        }
        dt { "95 % interval" } dd {
            "A range that would contain the true value in 95 of 100 repetitions of the experiment, \
             if the model is right."
        }
        dt { "BIC" } dd {
            "Bayesian information criterion: rewards a smaller error and charges for every added \
             parameter. Lower is better."
        }
        dt { "Collinear" } dd {
            "Two parameters that change the motion in nearly the same way, so that one can make up \
             for the other."
        }
    }
}
