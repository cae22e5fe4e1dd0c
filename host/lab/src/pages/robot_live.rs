//! The robot at a port: what it does now, what may be begun, how it is stopped.

use crate::live::LiveRobot;
use crate::model::Model;
use crate::report::playback::Scene;
use maud::{Markup, PreEscaped, html};

/// The section.
pub fn section(robot: Option<&LiveRobot>, model: Option<&Model>) -> Markup {
    html! {
        h2 { "The robot at a port" }
        @match robot {
            None => {
                p { "This lab was opened without one. A connected or a virtual robot is watched \
                     here while it is recorded or balanced:" }
                pre.commands tabindex="0" {
                    "handstand lab MODEL.toml --robot /dev/ttyUSB0\n\
                     handstand lab MODEL.toml --robot sim-cm5:robot=MODEL.toml,start=held"
                }
            }
            Some(robot) => (present(robot, model)),
        }
    }
}

fn present(robot: &LiveRobot, model: Option<&Model>) -> Markup {
    let ids: Vec<String> = robot.access.ids.iter().map(u8::to_string).collect();
    html! {
        p.lead { "Port " code { (robot.access.port) } ", servos " (ids.join(", ")) ". Recording \
            moves nothing. Balancing switches torque on, after the questions below. Close this page \
            and the robot is let down." }
        div.two {
            form #record-live {
                div.row {
                    label for="record-seconds" { "Seconds" }
                    input #record-seconds type="number" min="0.01" step="any" value="10";
                    button #begin-record disabled { "Record" }
                }
            }
            form #balance-live {
                div.row {
                    label for="balance-seconds" { "Seconds" }
                    input #balance-seconds type="number" min="0.01" step="any" value="10";
                    label for="torque" { "Torque limit, share of full" }
                    input #torque type="number" min="0.01" max="1" step="0.01" value="1";
                    button #begin-balance disabled {
                        "Balance with "
                        @if model.is_some() { "the model in force" } @else { "the CM-5's plan" }
                    }
                }
            }
        }
        div #asked hidden role="group" aria-labelledby="question" {
            p #question {}
            div.row {
                button.main #agree type="button" { "Yes, go on" }
                button #refuse type="button" { "No" }
            }
        }
        div.row {
            button.stop #stop-live type="button" disabled { "Stop: let it down" }
            b #phase role="status" { "Connecting …" }
            span #health {}
        }
        div.live #live-view hidden {
            canvas #live-shape role="img" aria-label="The robot's shape at this moment" {}
            div #live-charts {}
        }
        @if let Some(model) = model.filter(|model| !model.is_in_space()) {
            // What could end the script element is written otherwise.
            @let scene = serde_json::to_string(&Scene::measured(model, &[])).unwrap_or_default();
            script #shape type="application/json" { (PreEscaped(scene.replace('<', "\\u003c"))) }
        }
    }
}
