//! Measured against model, and where it fails.

use super::{evaluated, frame, in_milli};
use crate::compare::{Failure, SignalError};
use crate::output::number::{mrad, percent, short};
use crate::plot::{Bar, Tone};
use crate::reply::LabError;
use crate::report::table::{columns_of, page_table};
use crate::session::{ChosenWindow, LabSession, SavedSession, SessionEvaluation};
use maud::{Markup, html};

/// The page.
pub fn page(session: &LabSession) -> Result<Markup, LabError> {
    let saved = session.view();
    let (evaluation, body) =
        evaluated(session, &saved, |evaluation| Ok(shown(&saved, evaluation)))?;
    Ok(frame::page(
        session,
        &saved,
        "compare",
        evaluation.as_deref(),
        "lab.js",
        &body,
    ))
}

fn shown(saved: &SavedSession, evaluation: &SessionEvaluation) -> Markup {
    let comparison = evaluation.at_its_horizon();
    html! {
        section {
            h1 { "Measured against model" }
            p.lead { "Above, what was measured and what the model predicts for the same input. \
                      Below, the residual: measured minus predicted. A good model's residual \
                      stays inside the shaded noise floor. Drag across a chart to zoom, Shift and \
                      drag to move." }
            (left_out(saved))
            @if runs_away(evaluation) { p.warning #runs-away {
                "The model runs away from the measurement: look at signs and units, and at friction;                  a driven joint without any runs ever faster." } }
            (controls(saved, evaluation))
            div #curves data-name=(format!("model {}", saved.current)) {}
        }
        section {
            h2 { "Where it fails" }
            p.lead { "Conditions that hold more of the error than their share of the samples. \
                      Press one to shade its samples in every chart." }
            (failures(&comparison.failures))
        }
        section {
            h2 { "The residual over what" }
            div.row {
                label for="scatter-joint" { "Joint" }
                select #scatter-joint {
                    @for joint in 0..evaluation.run.model.link_count() { option value=(joint) {
                        (joint + 1) } }
                }
            }
            div.scatters #scatters {}
            h3 { "The residual by itself" }
            p.lead { "Of the motion drawn above. What is noise forgets itself at once and lies at \
                      all frequencies alike; a peak is a law that the model lacks." }
            div.scatters {
                figure { figcaption #acf-name { "Autocorrelation" } canvas.scatter #acf role="img"
                    aria-label="autocorrelation of the residual over the lag" {} }
                figure { figcaption #spectrum-name { "Spectrum" } canvas.scatter #spectrum role="img"
                    aria-label="spectrum of the residual over the frequency" {} }
            }
            h3 { "Any quantity over any other" }
            div.row {
                label for="xy-y" { "Upwards" } select #xy-y {}
                label for="xy-x" { "across" } select #xy-x {}
            }
            figure { figcaption #xy-name {} canvas.scatter #xy role="img"
                aria-label="one quantity over another" {} }
        }
        section {
            h2 { "Figures" }
            (signals(&comparison.signals, evaluation))
            h3 { "The error over ever longer runs" }
            p.facts #horizons-wanted { "Fitting start states …" }
            h3 { "The same on the command line" }
            (command(&saved.compare_command()))
        }
    }
}

/// Why some logs are not here.
fn left_out(saved: &SavedSession) -> Markup {
    html! {
        @for log in &saved.left_out {
            p.warning { b { (log.name) } " is left out: this model cannot read it. " (log.found) ". "
                (log.remedy) "." }
        }
    }
}

/// Whether the error is out of all proportion to the motion.
fn runs_away(evaluation: &SessionEvaluation) -> bool {
    let data = &evaluation.run.data;
    let motions = 0..data.motions.len();
    let ranges = motions.flat_map(|motion| (0..data.joints()).map(move |joint| (motion, joint)));
    let widest = ranges.map(|(motion, joint)| {
        let values = data.measured(motion, joint).iter().copied();
        let ends = values.filter(|value| value.is_finite());
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        high - low
    });
    evaluation.rms() > 3.0 * widest.fold(0.0, f64::max)
}

/// A command line that can be copied.
pub fn command(line: &str) -> Markup {
    html! {
        pre.commands #command tabindex="0" { (line) }
        button.small data-copy="#command" { "Copy" }
    }
}

/// The motions to choose from.
pub fn motions(evaluation: &SessionEvaluation) -> Markup {
    html! {
        label for="motion" { "Motion" }
        select #motion {
            @for (index, motion) in evaluation.run.data.motions.iter().enumerate() {
                option value=(index) {
                    (motion.name) @if evaluation.is_held_out(index) { " (held out)" } @else {
                        " (fitted)" }
                }
            }
        }
    }
}

fn controls(saved: &SavedSession, evaluation: &SessionEvaluation) -> Markup {
    let longest = evaluation.run.data.longest_s().max(0.2);
    // A step beyond the longest motion stands for whole motions.
    let (low, high) = (-1.3, longest.log10() + 0.1);
    let seconds = saved.horizon().seconds();
    let at = seconds.map_or(high, |seconds| seconds.log10().clamp(low, high));
    html! {
        div.row {
            (motions(evaluation))
            @if saved.steps.len() > 1 {
                label for="other" { "with" }
                select #other {
                    option value="" { "no other model" }
                    @for (index, step) in saved.steps.iter().enumerate().filter(|(i, _)| *i !=
                        saved.current) {
                        option value=(index) { "model " (index) ": " (step.title) }
                    }
                }
            }
        }
        div.row {
            label for="window" { "Longest window" }
            input #window type="range" min=(low) max=(high) step="0.01" value=(at);
            output #window-shown for="window" {}
            @if saved.window != ChosenWindow::Automatic && saved.diagnosis.is_some() {
                button.small #window-automatic type="button" { "As the diagnosis has it" }
            }
        }
        @for line in &evaluation.at_its_horizon().unobserved { p.note { (line) } }
        p.facts {
            span { "Error " span #shown-about {} b #shown-error { (in_milli(evaluation.rms(), evaluation)) }
                " " span #shown-over { (evaluation.over()) } }
            span { "This motion is " b #shown-role {} }
            span { "The model runs uncorrected for " b #shown-window {} }
        }
    }
}

fn failures(failures: &[Failure]) -> Markup {
    html! {
        @if failures.is_empty() { p { "No condition holds more than its share of the error." } }
        ul.plain.failure-list { @for (index, failure) in failures.iter().enumerate() {
            li { button type="button" data-condition=(index) aria-pressed="false" {
                span { (failure.sentence) }
                (Bar { mark: Some(failure.sample_share), ..Bar::new(failure.error_share, 1.0,
                    Tone::Orange) }.draw())
            } }
        } }
        @if !failures.is_empty() { p.note {
            "Bars: share of the error; the thin line: share of the samples." } }
    }
}

fn signals(signals: &[SignalError], evaluation: &SessionEvaluation) -> Markup {
    let words = |signal: &SignalError, error: f64| {
        if signal.beside_angle {
            format!("{} {}", mrad(error), signal.quantity.milli())
        } else {
            evaluation.shown(signal.joint - 1).error_words(error)
        }
    };
    let columns = columns_of::<SignalError>()
        .text("Joint", SignalError::label)
        .number("RMS", |signal| words(signal, signal.rms))
        .number("Largest", |signal| words(signal, signal.largest))
        .number("Fit", |signal| format!("{} %", short(signal.fit_percent)))
        .number("Floor", |signal| words(signal, signal.floor))
        .number("Squared error above floor", |signal| {
            percent(signal.share_above_floor)
        })
        .drawn("Tests of the residual", |signal| {
            html! {
                @for test in &signal.tests {
                    span class=(if test.passed { "good" } else { "bad" }) title=(test.meaning) {
                        (test.name) @if test.passed { " passed" } @else { " not passed" } ". "
                    }
                }
            }
        })
        .class("tests-of-residual");
    page_table(signals, &columns)
}

/// The error over ever longer runs; start states are fitted for each, so the page does not wait
/// for it.
pub fn horizons(evaluation: &SessionEvaluation) -> Markup {
    html! {
        p.facts #horizons {
            @for horizon in &evaluation.comparison().horizons {
                span {
                    @match horizon.horizon_s {
                        Some(seconds) => { (short(seconds)) " s " }
                        None => { "whole motions " }
                    }
                    b { (in_milli(horizon.rms, evaluation)) }
                }
            }
        }
    }
}
