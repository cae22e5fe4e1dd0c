//! The steps taken: error bars, undo, notes, files to keep.

use super::{in_milli, values};
use crate::discover::TermPicture;
use crate::error::Result;
use crate::output::number::{NONE, percent};
use crate::plot::{Bar, Tone, largest};
use crate::report::term_chart;
use crate::session::{LabSession, SavedSession, SavedStep, SessionEvaluation};
use maud::{Markup, html};
use std::sync::Arc;

/// A step with its error.
struct StepError<'a> {
    index: usize,
    step: &'a SavedStep,
    evaluation: Option<Arc<SessionEvaluation>>,
}

impl StepError<'_> {
    fn rms(&self) -> Option<f64> {
        self.evaluation.as_ref().map(|evaluation| evaluation.rms())
    }

    fn floor(&self) -> Option<f64> {
        self.evaluation
            .as_ref()
            .map(|evaluation| evaluation.floor())
    }

    /// A value of it as people read it.
    fn text(&self, value: Option<f64>) -> String {
        let text = |(value, evaluation)| in_milli(value, evaluation);
        value
            .zip(self.evaluation.as_deref())
            .map_or(NONE.into(), text)
    }
}

/// The steps, the floor, and what can be kept.
///
/// # Errors
/// Logs that cannot be read.
pub fn steps(session: &LabSession, saved: &SavedSession) -> Result<Markup> {
    let mut rows = Vec::new();
    for (index, step) in saved.steps.iter().enumerate() {
        // A step that cannot read these logs has no error; the one in force can.
        let evaluation = session.evaluation(saved, index).ok().flatten();
        rows.push(StepError {
            index,
            step,
            evaluation,
        });
    }
    let floor = rows.first().and_then(StepError::floor);
    let errors = rows.iter().filter_map(StepError::rms);
    let full = largest(errors.chain(floor));
    let before = |index: usize| index.checked_sub(1).and_then(|before| rows[before].rms());
    Ok(html! {
        div.chain-steps #steps {
            @for row in &rows { (drawn(row, before(row.index), full, saved)) }
            span {} span { "noise floor" }
            (Bar::new(floor.unwrap_or(0.0), full, Tone::Green).draw())
            span.number { @if let Some(first) = rows.first() { (first.text(floor)) } } span {}
        }
        @if let Some(step) = saved.step().filter(|step| !step.values.is_empty()) {
            h2 { "Values of model " (saved.current) ", as fitted" }
            (values::table(step))
            @for picture in &step.pictures { (pictured(picture)) }
        }
        div.row {
            (undo(saved))
            a href={ "/s/" (session.number) "/download/model.toml" } { "Save model" }
            a href={ "/s/" (session.number) "/download/report.html" } { "Save report" }
            a href={ "/s/" (session.number) "/download/session.json" } { "Save session" }
            a href={ "/s/" (session.number) "/compare" } { "See the curves" }
        }
    })
}

/// A term of a law that was discovered.
fn pictured(picture: &TermPicture) -> Markup {
    let chart = term_chart(picture);
    html! {
        figure.law {
            (chart.svg(420.0, 260.0))
            figcaption { (chart.legend())
                " Dots: what the motions ask for where any torque is allowed, with 95 % \
                  intervals." }
        }
    }
}

fn drawn(row: &StepError, before: Option<f64>, full: f64, saved: &SavedSession) -> Markup {
    let index = row.index;
    let now = index == saved.current;
    let undone = index > saved.current;
    let tone = if index == 0 { Tone::Orange } else { Tone::Blue };
    let bar = Bar {
        ghost: before,
        mark: row.floor(),
        ..Bar::new(row.rms().unwrap_or(0.0), full, tone)
    };
    let change = before
        .zip(row.rms())
        .map(|(before, after)| after / before - 1.0);
    html! {
        span class=[now.then_some("now")] { (index) }
        span class=[now.then_some("now").or(undone.then_some("undone"))] { (row.step.title)
            @if undone { " (undone)" } }
        (bar.draw())
        span.number data-step-error=(index) {
            (row.text(row.rms()))
            @if let Some(change) = change.filter(|change| change.is_finite()) {
                span.note { " (" @if change < 0.0 { "−" } @else { "+" }
                    (percent(change.abs())) ")" }
            }
        }
        @if now { span.note { "in force" } } @else {
            form.small-form data-send="step" {
                input type="hidden" name="step" value=(index) data-number;
                button data-work aria-label={ "Put model " (index) " in force" } { "Go to" }
            }
        }
        form.note-form.small-form data-send="note" {
            input type="hidden" name="step" value=(index) data-number;
            input name="note" value=(row.step.note) placeholder="note" aria-label={
                "Note to model " (index) };
            button { "Keep note" }
        }
    }
}

fn undo(saved: &SavedSession) -> Markup {
    html! {
        @if saved.current > 0 {
            form data-send="step" {
                input type="hidden" name="step" value=(saved.current - 1) data-number;
                button #undo data-work { "Undo: " (saved.steps[saved.current].title) }
            }
        }
        @if saved.current + 1 < saved.steps.len() {
            form data-send="step" {
                input type="hidden" name="step" value=(saved.current + 1) data-number;
                button #redo data-work { "Do again: " (saved.steps[saved.current + 1].title) }
            }
        }
    }
}
