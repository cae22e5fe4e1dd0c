//! Learning: the diagnosis, its cards, the steps taken.

use super::compare::command;
use super::learn_card::card;
use super::learn_steps::steps;
use super::progress::progress;
use super::what_if::own_paths;
use super::{evaluated, frame};
use crate::fitting::Horizon;
use crate::model::{Model, ParameterPath};
use crate::output::number::{NONE, exact, short, unit};
use crate::reply::LabError;
use crate::report::table::{columns_of, page_table};
use crate::session::{
    CardRole, ChosenWindow, LabSession, SavedCard, SavedDiagnosis, SavedProposal, SavedSession,
    SessionEvaluation, over, value_name,
};
use maud::{Markup, html};

/// The page.
pub fn page(session: &LabSession) -> Result<Markup, LabError> {
    let saved = session.view();
    let (evaluation, body) = evaluated(session, &saved, |evaluation| {
        shown(session, &saved, evaluation)
    })?;
    Ok(frame::page(
        session,
        &saved,
        "learn",
        evaluation.as_deref(),
        "lab.js",
        &body,
    ))
}

fn shown(
    session: &LabSession,
    saved: &SavedSession,
    evaluation: &SessionEvaluation,
) -> Result<Markup, LabError> {
    Ok(html! {
        section {
            h1 { "How the error falls" }
            p.lead { "Each bar is the typical (RMS) error of one model, all joints and motions \
                      together; the thin line is the noise floor. Adding an effect makes a step; \
                      any step can be undone." }
            (since_the_diagnosis(saved, evaluation))
            (steps(session, saved)?)
        }
        section {
            h2 { "What is missing?" }
            (ask(saved, evaluation))
            @if let Some(diagnosis) = &saved.diagnosis {
                (said(session.number, saved, diagnosis, evaluation))
            }
            @if let Some(proposal) = saved.proposal() { (proposed(session.number, proposal)) }
        }
        section {
            h2 { "The same on the command line" }
            p.note { "To be typed in " code { (session.folder().display()) }
                ", where the models and logs are." }
            (command(&commands(saved)))
        }
    })
}

/// Says that a diagnosis changed what errors are over, and takes it back.
fn since_the_diagnosis(saved: &SavedSession, evaluation: &SessionEvaluation) -> Markup {
    let by_diagnosis = saved.window == ChosenWindow::Automatic;
    let judged_s = saved.diagnosis.as_ref().and_then(|said| said.horizon_s);
    html! {
        @if evaluation.run.horizon != Horizon::Whole {
            div.box #rebased {
                @if by_diagnosis && judged_s.is_some() {
                    p { "Since the diagnosis all errors here are " b { (evaluation.over()) }
                        ", which is what it judged by: the model starts again from the measurement                         that often. Before it they were over whole motions." }
                } @else {
                    p { "All errors here are " b { (evaluation.over()) }
                        ", as you chose on the Compare page." }
                }
                p.facts #whole-wanted { "The same over whole motions …" }
                form.small-form data-send="horizon" {
                    input type="hidden" name="window" value="whole";
                    input type="hidden" name="page" value="learn";
                    button { "Show all errors over whole motions" }
                }
            }
        } @else if let (ChosenWindow::Whole, Some(seconds)) = (saved.window, judged_s) {
            form.row.small-form data-send="horizon" {
                input type="hidden" name="window" value="automatic";
                input type="hidden" name="page" value="learn";
                span { "All errors here are over whole motions." }
                button { "Show them " (over(Horizon::Seconds(seconds))) ", as the diagnosis judged" }
            }
        }
    }
}

/// The errors of all steps over whole motions.
pub fn whole(session: &LabSession) -> Markup {
    let mut saved = session.view();
    saved.window = ChosenWindow::Whole;
    let known = (0..saved.steps.len()).filter_map(|step| {
        let evaluation = session.evaluation(&saved, step).ok().flatten()?;
        Some((step, evaluation.in_words(evaluation.rms())))
    });
    html! {
        p.facts #whole {
            span { "The same over whole motions:" }
            @for (step, error) in known { span { "model " (step) " " b { (error) } } }
        }
    }
}

fn ask(saved: &SavedSession, evaluation: &SessionEvaluation) -> Markup {
    let again = saved.diagnosis.is_some();
    let model = &evaluation.run.model;
    let proposes = !model.driven_joints().is_empty() && !model.slides();
    html! {
        (progress(Some(evaluation.shown_error())))
        div.row {
            form data-send="diagnose" {
                button.main #diagnose data-work {
                    @if again { "Diagnose again" } @else { "Diagnose: which effect is missing?" }
                }
            }
            form data-send="fit" {
                input type="hidden" name="names" value="";
                button data-work { "Fit the model's free values" }
            }
            @if lacks_a_law(saved) {
                form data-send="discover" {
                    button #discover data-work { "Look for a law that the library lacks" }
                }
            }
            @if proposes {
                form data-send="next" {
                    button #next data-work { "Which experiment next?" }
                }
            }
        }
        (fit_what(model))
        @if !proposes {
            p.note { "The next experiment is proposed for rigs whose joints turn and are driven; "
                @if model.slides() { "a joint of this one slides." } @else {
                    "this one is moved by hand: let it go from other angles." } }
        }
    }
}

/// Whether no effect of the library explains what the model in force leaves.
fn lacks_a_law(saved: &SavedSession) -> bool {
    let said = saved.diagnosis.as_ref();
    said.is_some_and(|said| said.step == saved.current && said.verdict == "unexplained")
}

fn said(
    number: u32,
    saved: &SavedSession,
    diagnosis: &SavedDiagnosis,
    evaluation: &SessionEvaluation,
) -> Markup {
    let class = match diagnosis.verdict.as_str() {
        "nominal" | "adequate" => "verdict-nominal",
        "named" | "wrong_value" => "verdict-named",
        "ambiguous" => "verdict-ambiguous",
        "unexplained" => "verdict-unexplained",
        _ => "verdict-unfit",
    };
    let current = diagnosis.step == saved.current;
    let words = |error: Option<f64>| error.map_or(NONE.into(), |e| evaluation.in_words(e));
    // What a button of this page does is not said as a command.
    let next = || {
        diagnosis
            .next
            .iter()
            .filter(|line| !line.contains(": handstand "))
    };
    html! {
        div class={ "verdict " (class) } #verdict data-verdict=(diagnosis.verdict) {
            p { span.role { "Diagnosis of model " (diagnosis.step) ": "
                (diagnosis.verdict.replace('_', " ")) ", "
                (over(Horizon::from_seconds(diagnosis.horizon_s))) } }
            @for line in &diagnosis.summary { p { (line) } }
            p.facts {
                span { "Error as given " b { (words(diagnosis.before_rad)) } }
                span { "with what was found " b { (words(diagnosis.after_rad)) } }
                span { "floor " b { (words(diagnosis.floor_rad)) } }
                span { "on " @if diagnosis.held_out { "motions held out" } @else {
                    "the motions that were fitted" } ", "
                    (over(Horizon::from_seconds(diagnosis.horizon_s))) }
            }
        }
        p { a.button href={ "/s/" (number) "/download/report.html" } { "Save the report" } }
        @if !current { p.note {
            "The model in force is another one by now; diagnose again to learn about it." } }
        @if next().next().is_some() {
            h3 { "Next" }
            ul { @for line in next() { li { (line) } } }
        }
        @if !diagnosis.warnings.is_empty() {
            h3 { "Be wary" }
            ul { @for line in &diagnosis.warnings { li { (line) } } }
        }
        (cards(saved, diagnosis, evaluation, current))
    }
}

/// The explanations; those that are ruled out are folded away.
fn cards(
    saved: &SavedSession,
    diagnosis: &SavedDiagnosis,
    evaluation: &SessionEvaluation,
    current: bool,
) -> Markup {
    let is_open = |each: &&SavedCard| each.role != CardRole::RuledOut;
    let (open, out): (Vec<_>, Vec<_>) = diagnosis.cards.iter().partition(is_open);
    let drawn = |each: &SavedCard| card(each, saved, evaluation, current);
    html! {
        @if !open.is_empty() {
            h3 { "Explanations, the best first" }
            div.cards { @for each in open { (drawn(each)) } }
        }
        @if !out.is_empty() {
            details.folded #ruled-out {
                summary { "Ruled out: " (out.len())
                    @if out.len() == 1 { " explanation" }
                    @else { " explanations, the nearest first" }
                }
                div.cards { @for each in out { (drawn(each)) } }
            }
        }
    }
}

/// Which values to fit, each with what it is now, what is possible, and the bounds that it is kept
/// in.
fn fit_what(model: &Model) -> Markup {
    let values = own_paths(model).into_iter();
    let values = values.filter_map(|path| Some((path, path.get(model)?)));
    let values = values.filter(|(_, value)| value.is_finite());
    let columns = columns_of::<(ParameterPath, f64)>()
        .drawn("Fit", |(path, _)| {
            html! {
                input type="checkbox" id={ "fit-" (path) } data-name=(path)
                    checked[model.free.contains(path)];
            }
        })
        .drawn("Value", |(path, _)| {
            html! {
                label for={ "fit-" (path) } { (value_name(&path.to_string())) }
            }
        })
        .number("Now", |(_, value)| exact(*value))
        .text("Unit", |(path, _)| unit(path.unit()).to_string())
        .drawn("At least", |(path, _)| bound("low", path, model))
        .class("number")
        .drawn("At most", |(path, _)| bound("high", path, model))
        .class("number");
    html! {
        details #fit-what {
            summary { "Choose what is fitted" }
            form data-send="fit" data-names {
                (page_table(&values.collect::<Vec<_>>(), &columns))
                p.note { "Bounds are written into the model: later fits and diagnoses heed them. \
                          Empty, a value may be whatever is possible, which stands there in grey." }
                div.row { button data-work { "Fit what is ticked" } }
            }
        }
    }
}

/// An end of the bounds that a value is kept in.
fn bound(end: &str, path: &ParameterPath, model: &Model) -> Markup {
    let of = |(low, high): (f64, f64)| if end == "low" { low } else { high };
    let own = model.bounds.iter().find(|(own, _)| own == path);
    let own = own.map(|(_, ends)| of(*ends)).filter(|end| end.is_finite());
    let said = if end == "low" { "least" } else { "most" };
    html! {
        input type="number" step="any" data-bound=(end) data-path=(path) data-was=[own] value=[own]
            placeholder=(short(of(path.possible())))
            aria-label={ (value_name(&path.to_string())) " at " (said) };
    }
}

/// The experiment that comes next.
fn proposed(number: u32, proposal: &SavedProposal) -> Markup {
    html! {
        h3 #proposal { "The next experiment" }
        @if proposal.steps.is_empty() {
            p { "None within the limits of these logs helps; what was simulated stands below." }
        }
        ol { @for step in &proposal.steps { li { (step) } } }
        @if proposal.motion_csv.is_some() {
            p { a href={ "/s/" (number) "/download/next.csv" } { "Save the motion, next.csv" } }
        }
        details {
            summary { "All of it, as the command " code { "handstand next" } " prints it" }
            pre.commands tabindex="0" { (proposal.text) }
        }
    }
}

fn commands(saved: &SavedSession) -> String {
    let steps = saved.steps.iter().take(saved.current + 1);
    let made = steps.filter_map(|step| step.command.clone());
    let mut lines: Vec<String> = made.collect();
    lines.push(saved.diagnose_command());
    if let Some(said) = &saved.diagnosis {
        let next = said
            .next
            .iter()
            .filter_map(|line| line.split_once(": handstand "));
        lines.extend(next.map(|(_, command)| format!("handstand {command}")));
    }
    lines.push(saved.compare_command());
    let mut said = Vec::new();
    lines.retain(|line| {
        let is_new = !said.contains(line);
        said.push(line.clone());
        is_new
    });
    lines.join("\n")
}
