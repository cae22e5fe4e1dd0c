//! Gains: weights about those by the ranges, sampling time and delay as sliders.

use super::{frame, lacking};
use crate::model::{Model, default_pose};
use crate::reply::LabError;
use crate::session::LabSession;
use maud::{Markup, html};

/// A slider: name, title, lowest, highest and first place; powers of ten but for the delay.
const SLIDERS: [(&str, &str, f64, f64, f64); 4] = [
    ("states", "States against inputs", -4.0, 4.0, 0.0),
    ("speeds", "Speeds against angles", -3.0, 3.0, 0.0),
    ("ts_s", "Sampling time, s", -3.0, -1.0, -2.0),
    ("delay_s", "Delay of the inputs, s", 0.0, 0.06, 0.0),
];

/// The page.
pub fn page(session: &LabSession) -> Result<Markup, LabError> {
    let saved = session.view();
    let evaluation = session.known_evaluation(&saved);
    let (script, body) = match session.model(&saved)? {
        Some(model) if model.driven_joints().is_empty() => ("lab.js", undriven(session.number)),
        Some(model) => ("gains.js", shown(&model)),
        None => ("lab.js", lacking(session.number, &saved)),
    };
    Ok(frame::page(
        session,
        &saved,
        "gains",
        evaluation.as_deref(),
        script,
        &body,
    ))
}

/// Says what is missing of a model without a drive.
fn undriven(number: u32) -> Markup {
    html! {
        section {
            h1 { "No joint of this model is driven" }
            p { "Gains tell drives what to do, and every joint swings freely. Give a "
                code { "[[joint]]" } " another drive than " code { "passive" } ": a torque, a duty, \
                a position servo or a speed servo. " a href={ "/s/" (number) "/data" } {
                "Edit the model" } "." }
        }
    }
}

/// The pose of a robot in space: which joints, and where they are.
fn pose(model: &Model) -> Markup {
    let Some(robot) = &model.robot else {
        return html! {};
    };
    let pose = default_pose(model);
    let joints = robot.joints.iter().zip(&pose);
    let said: Vec<String> = joints.map(|(name, at)| format!("{name}={at}")).collect();
    html! {
        div.wide-slider {
            label for="pose" { "Pose, rad (slides: m)" }
            input #pose type="text" value=(said.join(", ")) spellcheck="false" autocomplete="off";
            output {}
        }
    }
}

fn shown(model: &Model) -> Markup {
    let title = if model.is_in_space() {
        "Gains that hold its pose"
    } else {
        "Gains that hold it upright"
    };
    html! {
        section {
            h1 { (title) }
            p.lead { "The linear-quadratic regulator of the model in force. The response is \
                      simulated with every effect that the model has learned, from the first joint \
                      20 mrad (1.1 deg) off. At 1 each state and input weighs one over the square \
                      of its largest departure (Bryson's rule: 0.5 rad, 10 rad/s, the drive's own \
                      limit); the first two sliders multiply that." }
            (pose(model))
            @for (name, title, low, high, at) in SLIDERS {
                div.wide-slider {
                    label for=(name) { (title) }
                    input id=(name) type="range" min=(low) max=(high) step=(if name == "delay_s" {
                        "0.0005" } else { "0.01" })
                        value=(at) disabled[name == "delay_s"];
                    output id={ (name) "-shown" } for=(name) {}
                }
            }
            div.row {
                label { input #own-delay type="checkbox" checked; "the model's own delay" }
            }
            div.two {
                div { h2 { "Poles" } canvas #poles role="img"
                    aria-label="Poles of the closed loop and the unit circle" {} }
                div { h2 { "Figures" } div.scroll #figures tabindex="0" aria-live="polite" {} }
            }
            h2 { "Does it hold?" }
            div #verified aria-live="polite" { p.note { "Simulating the loop …" } }
            h2 { "Response" }
            div #response {}
            h2 { "K" }
            div.scroll #gain tabindex="0" {}
            h2 { "Take along" }
            div.row {
                a data-file="gains.h" href="#" { "C header" }
                a data-file="gains.rs" href="#" { "Rust file" }
                a data-file="gains.csv" href="#" { "K as CSV" }
                a data-file="gains.html" href="#" target="_blank" rel="noopener" {
                    "Page with pictures: responses, margins, poles, region" }
            }
            pre.commands #gains-command tabindex="0" {}
            button.small data-copy="#gains-command" { "Copy" }
        }
    }
}
