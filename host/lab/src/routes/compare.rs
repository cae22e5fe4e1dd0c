//! Measured against model: curves, where it fails, over what.

use super::arrays::Arrays;
use super::{act, blocking, session};
use crate::compare::{FailingSamples, residual_variables};
use crate::error::Error;
use crate::fitting::Horizon;
use crate::model::{Drive, Joint, MeasuredSignal};
use crate::pages::{compare as pages, frame};
use crate::reply::{Answer, LabError, page};
use crate::server::LabState;
use crate::session::{ChosenWindow, LabSession, SavedSession, SessionEvaluation, aside};
use axum::Json;
use axum::extract::{Path, Query, State};
use serde::Deserialize;
use serde_json::{Value, json};
use std::ops::Range;
use std::sync::Arc;

/// Shortest and longest windows that can be asked for, s.
const WINDOWS_S: Range<f64> = 0.02..1e4;

/// The page.
pub(super) async fn show(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || Ok(page(pages::page(&session)?))).await
}

/// The error in force, as the top of each page has it.
pub(super) async fn error(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || {
        let saved = session.view();
        Ok(page(match session.evaluation(&saved, saved.current) {
            Ok(Some(evaluation)) => frame::error(&evaluation),
            Ok(None) => return Err(LabError::NotFound("comparison")),
            // Where the logs are listed it is said why.
            Err(_) => frame::unreadable(),
        }))
    })
    .await
}

/// The error over ever longer runs.
pub(super) async fn horizons(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || {
        let saved = session.view();
        let evaluation = session.evaluation(&saved, saved.current)?;
        let evaluation = evaluation.ok_or(LabError::NotFound("comparison"))?;
        Ok(page(aside(|| pages::horizons(&evaluation))))
    })
    .await
}

#[derive(Debug, Deserialize)]
pub(super) struct CurvesAsked {
    motion: usize,
    /// The step to draw; the one in force without.
    step: Option<usize>,
    /// Another step to draw with it.
    other: Option<usize>,
    /// Windows to try, s; `whole` motions, or those of the session without.
    horizon: Option<String>,
    /// Whether the slider of `horizon` moves still: start states are then fitted roughly.
    #[serde(default)]
    moving: bool,
}

/// Measured and predicted angles of one motion.
pub(super) async fn curves(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Query(asked): Query<CurvesAsked>,
) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || {
        let mut saved = session.view();
        if let Some(horizon) = &asked.horizon {
            let seconds = horizon.parse().ok().filter(|s| WINDOWS_S.contains(s));
            saved.window = seconds.map_or(ChosenWindow::Whole, ChosenWindow::Seconds);
        }
        let step = asked.step.unwrap_or(saved.current);
        let made = |step| {
            if asked.moving {
                roughly(&session, &saved, step)
            } else {
                exactly(&session, &saved, step)
            }
        };
        let evaluation: Arc<SessionEvaluation> = made(step)?;
        let other = asked.other.map(made).transpose()?;
        let mut arrays = Arrays::default();
        let meta = draw(&mut arrays, &evaluation, asked.motion)?;
        if let Some(other) = &other {
            let predicted = other.run.predicted.get(asked.motion);
            for (joint, angles) in predicted.into_iter().flatten().enumerate() {
                arrays.push(format!("other_{joint}"), angles.iter().copied());
            }
        }
        let mut meta = meta;
        meta["other_rms"] = json!(other.map(|other| other.rms()));
        Ok(arrays.reply(&meta))
    })
    .await
}

/// A step over the session's windows.
fn exactly(
    session: &LabSession,
    saved: &SavedSession,
    step: usize,
) -> Result<Arc<SessionEvaluation>, LabError> {
    let evaluation = session.evaluation(saved, step)?;
    evaluation.ok_or(LabError::NotFound("step"))
}

/// A step over windows that are tried: what is known of the session's own saves most of the time.
fn roughly(
    session: &LabSession,
    tried: &SavedSession,
    step: usize,
) -> Result<Arc<SessionEvaluation>, LabError> {
    let own = exactly(session, &session.view(), step)?;
    if own.run.horizon == tried.horizon() {
        Ok(own)
    } else {
        Ok(Arc::new(own.roughly_at(tried.horizon())))
    }
}

/// Adds a motion's curves, and describes them.
pub(super) fn draw(
    arrays: &mut Arrays,
    evaluation: &SessionEvaluation,
    index: usize,
) -> Result<Value, LabError> {
    let run = &evaluation.run;
    let motion = run
        .data
        .motions
        .get(index)
        .ok_or(LabError::NotFound("motion"))?;
    let first = motion.time_s.first().copied().unwrap_or(0.0);
    arrays.push("time", motion.time_s.iter().map(|time| time - first));
    let mut inputs = Vec::new();
    for joint in 0..run.model.link_count() {
        let measured = run.data.measured(index, joint).iter().copied();
        arrays.push(format!("measured_{joint}"), measured);
        let predicted = run.predicted[index][joint].iter().copied();
        arrays.push(format!("predicted_{joint}"), predicted);
        if let Some(input) = &motion.input[joint] {
            arrays.push(format!("input_{joint}"), input.iter().copied());
        }
        inputs.push(motion.input[joint].as_ref().map(|_| {
            let (name, unit) = input_of(&run.model.joints[joint]);
            // Goals are read as the angles beside them are.
            let shown = evaluation.shown(joint);
            let like_angle = unit == "rad" && shown.unit == "deg";
            let (unit, per_si) = if like_angle {
                (shown.unit, shown.per_si)
            } else {
                (unit, 1.0)
            };
            json!({ "name": name, "unit": unit, "per_si": per_si })
        }));
    }
    let windows = run.data.windows_of(index).skip(1);
    let restarts: Vec<f64> = windows
        .map(|(_, window)| motion.time_s[window.samples.start] - first)
        .collect();
    let window_s = run.data.motion_windows(run.horizon)[index].window_s;
    let signals = run.data.signals.iter().take(run.data.joints());
    Ok(json!({
        "motion": motion.name,
        "held_out": evaluation.is_held_out(index),
        "joints": run.model.link_count(),
        "inputs": inputs,
        "shown": (0..run.data.joints()).map(|joint| evaluation.shown(joint)).collect::<Vec<_>>(),
        "error": evaluation.shown_error(),
        "rates": signals.map(|signal| *signal == MeasuredSignal::Rate).collect::<Vec<_>>(),
        "floor": run.data.sigma[..run.data.joints()],
        "rms": evaluation.rms(),
        "joint_rms": run.joint_rms(),
        "restarts_s": restarts,
        "window_s": window_s,
        "shades": shades(evaluation, index),
    }))
}

/// What a drive is told, and its unit.
fn input_of(joint: &Joint) -> (&'static str, &'static str) {
    let [place, speed, torque] = joint.units();
    match joint.drive {
        Drive::Passive => ("input", ""),
        Drive::Torque => ("torque", torque),
        Drive::Duty(_) => ("duty", "1"),
        Drive::Position { .. } => ("goal", place),
        Drive::Speed { .. } => ("goal speed", speed),
    }
}

/// For each condition, the stretches of this motion that meet it, s.
fn shades(evaluation: &SessionEvaluation, index: usize) -> Vec<Value> {
    let motions = &evaluation.run.data.motions;
    let begin: usize = motions[..index].iter().map(|motion| motion.len()).sum();
    let time = &motions[index].time_s;
    let stretches = |failing: &FailingSamples| {
        let holds = &failing.holds[begin..begin + time.len()];
        let mut from = 0;
        let mut stretches = Vec::new();
        for part in holds.chunk_by(|a, b| a == b) {
            let to = from + part.len();
            if part[0] {
                // Each sample stands for the time until the next.
                let end = time.get(to).or(time.last()).copied().unwrap_or(0.0);
                stretches.push([time[from] - time[0], end - time[0]]);
            }
            from = to;
        }
        json!({ "joint": failing.failure.joint - 1, "stretches_s": stretches })
    };
    evaluation.failing().iter().map(stretches).collect()
}

#[derive(Debug, Deserialize)]
pub(super) struct ScatterAsked {
    /// Counted from 0.
    joint: usize,
}

/// A joint's residual and what it can be drawn over, all motions end to end.
pub(super) async fn scatter(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Query(asked): Query<ScatterAsked>,
) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || {
        let saved = session.view();
        let evaluation = session.evaluation(&saved, saved.current)?;
        let evaluation = evaluation.ok_or(LabError::NotFound("comparison"))?;
        let run = &evaluation.run;
        let mut residuals = run.residuals();
        if asked.joint >= run.data.joints() {
            return Err(LabError::NotFound("joint"));
        }
        let mut arrays = Arrays::default();
        let residual = residuals.swap_remove(asked.joint);
        arrays.push("residual", residual.into_iter().flatten());
        let variables = residual_variables(&run.model, &run.data.motions, asked.joint);
        let shown = evaluation.shown(asked.joint);
        // Angles and speeds are read as the log has them.
        let read = |unit: &'static str| match unit {
            "rad" if shown.unit == "deg" => ("deg", shown.per_si),
            "rad/s" if shown.unit == "deg" => ("deg/s", shown.per_si),
            unit => (unit, 1.0),
        };
        for variable in &variables {
            let (_, per_si) = read(variable.unit);
            arrays.push(
                variable.name,
                variable.values.iter().map(|value| per_si * value),
            );
        }
        let names = variables
            .iter()
            .map(|v| json!({ "name": v.name, "unit": read(v.unit).0 }));
        let conditions = evaluation.failing().iter();
        for (index, failing) in conditions.enumerate() {
            let holds = failing.holds.iter().map(|holds| f64::from(*holds));
            arrays.push(format!("holds_{index}"), holds);
        }
        Ok(arrays.reply(&json!({
            "variables": names.collect::<Vec<_>>(),
            "shown": shown,
            "floor": run.data.sigma[asked.joint],
        })))
    })
    .await
}

#[derive(Debug, Deserialize)]
pub(super) struct HorizonChosen {
    window: ChosenWindow,
    /// The page that asks, and goes on.
    #[serde(default)]
    page: AskingPage,
}

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum AskingPage {
    #[default]
    Compare,
    Learn,
}

/// Keeps the length of the windows.
pub(super) async fn horizon(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(chosen): Json<HorizonChosen>,
) -> Answer {
    let page = match chosen.page {
        AskingPage::Compare => "compare",
        AskingPage::Learn => "learn",
    };
    act(lab, number, page, move |session, _| {
        if let ChosenWindow::Seconds(seconds) = chosen.window {
            allowed(session, &session.view(), seconds)?;
        }
        session.change(|saved| {
            saved.window = chosen.window;
            Ok(())
        })?;
        Ok(())
    })
    .await
}

/// Refuses windows that the commands, which the pages copy, would refuse.
fn allowed(session: &LabSession, saved: &SavedSession, seconds: f64) -> Result<(), LabError> {
    if !WINDOWS_S.contains(&seconds) {
        return Err(LabError::Conflict(
            "windows last from 0.02 s to 10 000 s".into(),
        ));
    }
    let Some(model) = session.model(saved)? else {
        return Ok(());
    };
    // Logs that cannot be read are told of where they are compared.
    let Ok(split) = session.split(saved, &model) else {
        return Ok(());
    };
    let motions = split.training.iter().chain(&split.held_out);
    let checked = Horizon::Seconds(seconds).check(&model, motions);
    Ok(checked.map_err(Error::from)?)
}
