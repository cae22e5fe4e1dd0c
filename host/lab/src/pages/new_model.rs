//! The form of a new model, filled with what the first log tells, as `handstand init` guesses it.

use super::progress::progress;
use crate::log::init::Draft;
use crate::session::{LabSession, SavedSession};
use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

/// The form where there is no model yet.
pub fn section(session: &LabSession, saved: &SavedSession) -> Markup {
    html! {
        section #make {
            h2 { "Make a model" }
            (form(session, saved))
        }
    }
}

/// The form.
pub fn form(session: &LabSession, saved: &SavedSession) -> Markup {
    let draft = session.draft(saved, None);
    html! {
        @match &draft {
            Some(draft) => (guessed(draft)),
            None => p.lead { "Links, joints and drives of the rig, from the base outwards." },
        }
        form #new-model {
            div.two {
                div {
                    div.row { label { "Name" input name="name" value="my arm" required; } }
                    div.row { label { "Links" input type="number" name="count" min="1" max="32"
                        value="1"; } }
                    div.row { label { "Angles are zero"
                        select name="angle_zero" {
                            option value="hanging" { "hanging straight down" }
                            option value="upright" { "straight up" }
                            option value="horizontal" { "to the right" }
                        }
                    } }
                    div.row { label { "and measured from"
                        select name="angles" {
                            option value="relative" { "the link before" }
                            option value="absolute" { "the world" }
                        }
                    } }
                }
                svg #chain role="img"
                    aria-label="The chain as typed: links, joints, centres of mass" {}
            }
            div #links {}
            p.note { "Friction is proposed where a joint is driven, since without any the model runs \
                      away; a fit finds its size. 0 or nothing leaves it out." }
            @if !saved.steps.is_empty() { p.note {
                "The new model takes the place of the present one and its steps." } }
            div.row { button.main { "Make this model" @if !saved.logs.is_empty() {
                ", and compare it" } } }
        }
        @if let Some(draft) = &draft {
            // What could end the script element is written otherwise.
            @let text = figures(draft).to_string().replace('<', "\\u003c");
            script #draft type="application/json" { (PreEscaped(text)) }
        }
    }
}

fn guessed(draft: &Draft) -> Markup {
    html! {
        form #from-log data-send="model-from-log" {
            p.lead { "Friction, masses or the motor's figures, and the zero can be estimated from \
                      the log: a fit of some seconds. What you know of the rig comes later, or \
                      below." }
            div.row { button.main data-work { "Estimate a model from the log" } }
        }
        (progress(None))
        p.lead { "Or put in what you know: the form is filled with what the columns tell; lengths, \
                  masses and the motor are guesses." }
        details {
            summary { "What was guessed, and from what" }
            ul.plain { @for guess in &draft.guesses {
                li { b { (guess.what) ": " } (guess.guess) span.note { " (" (guess.why) ")" } }
            } }
        }
    }
}

/// The figures of the form.
fn figures(draft: &Draft) -> Value {
    let plan = &draft.plan;
    let links = plan.links.iter().map(|link| {
        json!({
            "length_m": link.length_m,
            "com_m": link.com_m,
            "mass_kg": link.mass_kg,
            "inertia_kg_m2": link.inertia_kg_m2,
            "drive": link.drive,
            "gain": link.gain,
            "stall_torque_nm": link.stall_torque_nm,
            "no_load_speed_rad_s": link.no_load_speed_rad_s,
        })
    });
    json!({
        "name": plan.name,
        "angle_zero": plan.angle_zero,
        "angles": plan.angles,
        "links": links.collect::<Vec<_>>(),
    })
}
