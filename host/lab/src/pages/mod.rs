//! The pages: each its sections, drawn on the server; scripts add curves and sliders.

pub(super) mod challenge;
pub(super) mod compare;
pub(super) mod data;
pub(super) mod data_model;
pub(super) mod enter;
pub(super) mod frame;
pub(super) mod gains;
pub(super) mod learn;
pub(super) mod learn_card;
pub(super) mod learn_steps;
mod new_model;
mod progress;
pub(super) mod report;
pub(super) mod robot;
mod robot_live;
mod values;
pub(super) mod what_if;

use super::reply::LabError;
use super::session::{LabSession, SavedSession, SessionEvaluation};
use crate::output::number::{NONE, mrad};
use maud::{Markup, html};
use std::sync::Arc;

/// The error of an evaluation as people read it.
fn in_milli(value: f64, evaluation: &SessionEvaluation) -> String {
    evaluation.in_words(value)
}

/// An error of angles as people read it; a dash where it is not known.
fn in_mrad(rad: Option<f64>) -> String {
    rad.map_or(NONE.to_string(), |rad| format!("{} mrad", mrad(rad)))
}

/// What stands on a page that needs more than there is.
fn lacking(number: u32, saved: &SavedSession) -> Markup {
    let lacks = match (saved.steps.is_empty(), saved.logs.is_empty()) {
        (true, true) => "a model and a log",
        (true, false) => "a model",
        _ => "a log",
    };
    html! {
        section {
            h1 { "First bring " (lacks) }
            p { "This page needs " (lacks) ". "
                @if saved.steps.is_empty() && !saved.logs.is_empty() {
                    a href={ "/s/" (number) "/data#make" } { "Make a model for your log" } "."
                } @else {
                    a href={ "/s/" (number) "/data" } { "Bring what is missing" } "."
                } }
        }
    }
}

/// The body of a page that needs model and logs, drawn by `shown`, with the model in force as it
/// was evaluated for it; what is lacking, or wrong with the logs, becomes words.
fn evaluated(
    session: &LabSession,
    saved: &SavedSession,
    shown: impl FnOnce(&SessionEvaluation) -> Result<Markup, LabError>,
) -> Result<(Option<Arc<SessionEvaluation>>, Markup), LabError> {
    match session.evaluation(saved, saved.current) {
        Ok(Some(evaluation)) => {
            let body = shown(&evaluation)?;
            Ok((Some(evaluation), body))
        }
        Ok(None) => Ok((None, lacking(session.number, saved))),
        Err(error) => {
            let remedy = error.remedy().unwrap_or_default().into_owned();
            let why = (session.shortened(&error.to_string()), remedy);
            Ok((None, refused(session.number, &why)))
        }
    }
}

/// Says why there is nothing to show.
fn refused(number: u32, (found, remedy): &(String, String)) -> Markup {
    html! {
        section {
            h1 { "The logs cannot be read by this model" }
            p.bad { (found) }
            p { (remedy) }
            p { a href={ "/s/" (number) "/data" } { "Mend it on the data page" } }
        }
    }
}
