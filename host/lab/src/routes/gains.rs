//! Gains from the model in force: poles, response, what fixed point costs, headers.

use super::{blocking, session};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::output::number::hex;
use crate::pages::gains as pages;
use crate::reply::{Answer, LabError, data as reply, download, page, typed};
use crate::report::{GainsReport, gains_page, margins_parts, verification_text};
use crate::server::LabState;
use crate::session::{LabSession, aside, in_degrees};
use crate::study::{left_out, response, verify};
use crate::synth::export::{self, Provenance};
use crate::synth::{
    CostWeights, Design, LoopFigures, OmittedEffect, PoseText, Request, Time, rows,
};
use axum::Json;
use axum::extract::{Path, Query, State};
use serde::Deserialize;
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};
use std::sync::Arc;

/// Length of the response, s.
const SECONDS: f64 = 3.0;
/// Departure of the first joint from which it begins, rad.
const LEAN_RAD: f64 = 0.02;

/// The page.
pub(super) async fn show(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || Ok(page(pages::page(&session)?))).await
}

/// What is asked of the design.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct GainsAsked {
    /// Weight of the states, times that by their ranges.
    states: f64,
    /// Weight of the speeds, times that again.
    speeds: f64,
    /// Sampling time, s.
    ts_s: f64,
    /// Delay of the inputs, s; the model's own without.
    delay_s: Option<f64>,
    /// The pose, as after `--pose`; the model's default without.
    pose: Option<String>,
}

impl GainsAsked {
    fn request(&self, model: &Model) -> Result<Request> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if ![self.states, self.speeds, self.ts_s]
            .into_iter()
            .all(positive)
        {
            return Err(Error::usage(
                "a weight or the sampling time is not above 0",
                "raise it",
            ));
        }
        let standard = Request::standard(model);
        let pose_rad = match self.pose() {
            Some(pose) => pose
                .parse::<PoseText>()
                .map_err(|remedy| Error::usage(format!("the pose is `{pose}`"), remedy))?
                .resolve(model)?,
            None => standard.pose_rad.clone(),
        };
        Ok(Request {
            pose_rad,
            weights: CostWeights::ByRange {
                states: self.states,
                speeds: self.speeds,
            },
            time: Time::Sampled {
                ts_s: self.ts_s,
                delay_s: self.delay_s,
            },
            ..standard
        })
    }

    /// A pose that is asked for.
    fn pose(&self) -> Option<&str> {
        let pose = self.pose.as_deref().map(str::trim);
        pose.filter(|pose| !pose.is_empty())
    }

    fn options(&self, model: &Model) -> Result<String> {
        let delay = self.delay_s.map(|delay| format!(" --delay {delay}"));
        let [q, r] = self.request(model)?.weights_for(model)?;
        Ok(format!(
            " --q {q} --r {r} --ts {}{}{}",
            self.ts_s,
            delay.unwrap_or_default(),
            self.pose().map_or_else(String::new, |pose| {
                let pose: String = pose.split_whitespace().collect();
                format!(" --pose {pose}")
            })
        ))
    }
}

/// The design of these sliders.
pub(super) async fn design(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(asked): Json<GainsAsked>,
) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || {
        let (model, made) = model(&session, &asked)?;
        Ok(reply(&designed(&model, &made, &asked)?))
    })
    .await
}

fn model(session: &LabSession, asked: &GainsAsked) -> Result<(Model, Provenance), LabError> {
    let saved = session.saved();
    let model = session.model(&saved)?.ok_or(LabError::NotFound("model"))?;
    let toml = saved.step().map_or("", |step| &step.toml);
    let made = Provenance {
        model: format!("model-{}.toml", saved.current),
        sha256: hex(Sha256::digest(toml)),
        command: saved.gains_command() + &asked.options(&model)?,
    };
    Ok((model, made))
}

fn designed(model: &Model, made: &Provenance, asked: &GainsAsked) -> Result<Value> {
    let request = asked.request(model)?;
    let design = Design::of(model, &request)?;
    let mut start = vec![0.0; model.link_count()];
    start[0] = LEAN_RAD;
    let response = response(model, &design, &request, &start, SECONDS)?;
    let fixed = design.fixed.as_ref().map(|fixed| {
        json!({
            "radius": fixed.loss.radius,
            "radius_fixed": fixed.loss.radius_fixed,
            "margin_bits": fixed.loss.margin_bits,
            "gain_error": fixed.loss.gain_error,
            "bits": fixed.law.bits,
        })
    });
    let poles = design.gains.poles.iter().map(|pole| [pole.re, pole.im]);
    let figures = LoopFigures::of(model, &design)?;
    let omitted = design.omitted.iter();
    Ok(json!({
        "poles": poles.collect::<Vec<_>>(),
        "k": rows(&design.gains.k),
        "states": design.states.iter().map(|signal| &signal.name).collect::<Vec<_>>(),
        "joints": (0..model.link_count())
            .map(|joint| format!("joint {}", design.names.label(joint)))
            .collect::<Vec<_>>(),
        "inputs": design.inputs.iter().map(|signal| &signal.name).collect::<Vec<_>>(),
        "fixed": fixed,
        "margins": margins_parts(figures.as_ref(), &design),
        "omitted": omitted.map(|o| omitted_text(o, &design)).collect::<Vec<_>>(),
        "degrees": in_degrees(model),
        "response": {
            "time_s": response.time_s,
            "angle_rad": response.angle_rad,
            "command": response.command,
        },
        "command": made.command,
    }))
}

fn omitted_text(omitted: &OmittedEffect, design: &Design) -> String {
    let title = omitted.effect.info().title;
    match omitted.joint {
        Some(joint) => format!("{title} at joint {}", design.names.label(joint)),
        None => title.to_string(),
    }
}

/// What the simulated loop does with every effect of the model, in the words of `handstand gains`;
/// it takes seconds.
pub(super) async fn verified(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(asked): Json<GainsAsked>,
) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || {
        let (model, _) = model(&session, &asked)?;
        let request = asked.request(&model)?;
        let design = Design::of(&model, &request).map_err(Error::from)?;
        let left_out = left_out(&model, &model, &design);
        let verified = aside(|| verify(&model, &design, &request, &left_out, &|| ()))?;
        let text = verification_text(&verified, &model);
        let lines: Vec<&str> = text.lines().filter(|line| !line.is_empty()).collect();
        Ok(reply(&json!({
            "lines": lines,
            "stabilised": verified.stabilised,
            "stays_uncontrolled": verified.stays_uncontrolled,
            "region_rad": verified.region_rad,
        })))
    })
    .await
}

/// The law as a header, for other programs, or as a page with pictures, which takes seconds.
pub(super) async fn file(
    State(lab): State<Arc<LabState>>,
    Path((number, what)): Path<(u32, String)>,
    Query(asked): Query<GainsAsked>,
) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || {
        let (model, made) = model(&session, &asked)?;
        let design = Design::of(&model, &asked.request(&model)?).map_err(Error::from)?;
        let fixed = design.fixed.as_ref();
        let fixed = fixed.ok_or(LabError::NotFound("fixed-point law"))?;
        match what.as_str() {
            "gains.rs" => {
                let text = export::rust_file(&design, fixed, &made);
                Ok(download("text/plain; charset=utf-8", "gains.rs", text))
            }
            "gains.h" => {
                let text = export::c_header(&design, fixed, &made, export::C_NAME);
                Ok(download("text/plain; charset=utf-8", "gains.h", text))
            }
            "gains.html" => {
                let request = asked.request(&model)?;
                let left_out = left_out(&model, &model, &design);
                let figures = LoopFigures::of(&model, &design).map_err(Error::from)?;
                let page = aside(|| {
                    let verified = verify(&model, &design, &request, &left_out, &|| ())?;
                    gains_page(&GainsReport {
                        model: &model,
                        request: &request,
                        design: &design,
                        figures: figures.as_ref(),
                        verified: &verified,
                        made: &made,
                    })
                })?;
                Ok(typed("text/html; charset=utf-8", page))
            }
            "gains.csv" => Ok(download("text/csv", "gains.csv", export::csv(&design))),
            _ => Err(LabError::NotFound("file")),
        }
    })
    .await
}
