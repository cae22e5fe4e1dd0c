//! The robot that moves as the log says, the model's prediction over it; the one at a port, live.

use super::{evaluated, frame, robot_live};
use crate::live::LiveRobot;
use crate::model::shapes::RobotShapes;
use crate::reply::LabError;
use crate::report::playback::{Scene, stage};
use crate::session::LabSession;
use maud::{DOCTYPE, Markup, html};

/// The page; a page of its own in a frame, so that its keys do not meet those of the lab.
pub fn page(session: &LabSession, robot: Option<&LiveRobot>) -> Result<Markup, LabError> {
    let saved = session.view();
    let (evaluation, played) = evaluated(session, &saved, |_| Ok(shown(session.number)))?;
    let model = session.model(&saved)?;
    let script = if robot.is_some() { "live.js" } else { "lab.js" };
    let body = html! {
        (played)
        section { (robot_live::section(robot, model.as_ref())) }
    };
    Ok(frame::page(
        session,
        &saved,
        "robot",
        evaluation.as_deref(),
        script,
        &body,
    ))
}

fn shown(number: u32) -> Markup {
    html! {
        section {
            h1 { "The robot in the log" }
            p.lead { "The measurement, and dashed over it what the model predicts. Drag in the \
                      chart to move in time; Space plays." }
            iframe.stage src={ "/s/" (number) "/stage" } title="The robot, moving as the log says"
                {}
        }
    }
}

/// The document in the frame.
pub fn stage_page(session: &LabSession) -> Result<Markup, LabError> {
    let saved = session.view();
    let evaluation = session.evaluation(&saved, saved.current)?;
    let evaluation = evaluation.ok_or(LabError::NotFound("comparison"))?;
    let run = &evaluation.run;
    let mut scene = Scene::measured(&run.model, &run.data.motions);
    let mut not_drawn = None;
    if let Some(robot) = &run.model.robot {
        let (robot, beside) = session.robot_with_meshes(&saved, robot);
        let shapes = RobotShapes::read(&robot, &beside)
            .map_err(|why| LabError::Conflict(why.to_string()))?;
        scene.dress(&run.model, &shapes);
        not_drawn = shapes.not_drawn_text();
    }
    let script = if scene.tree.is_some() {
        "/assets/view-space.js"
    } else {
        "/assets/view.js"
    };
    let mut comparison = evaluation.at_its_horizon().clone();
    comparison.model = format!("model {}", saved.current);
    scene.add_model(&run.model, &comparison);
    let stage = stage(&scene).map_err(|why| LabError::Conflict(why.to_string()))?;
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (scene.title) }
                link rel="stylesheet" href="/assets/view.css";
                script src=(script) defer {}
            }
            body {
                (stage)
                @if let Some(line) = not_drawn {
                    section.note aria-label="What is not drawn" title=(line) { (line) }
                }
            }
        }
    })
}
