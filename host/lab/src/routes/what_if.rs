//! What if a value were another one: curves and error while a slider moves.

use super::arrays::Arrays;
use super::shown_model::ShownModel;
use super::{act, blocking, session};
use crate::compare::ModelRun;
use crate::error::{Error, Result};
use crate::fitting::Candidate;
use crate::model::{Model, ParameterPath, edit};
use crate::output::number::{exact, with_unit};
use crate::pages::what_if as pages;
use crate::reply::{Answer, LabError, page};
use crate::server::LabState;
use crate::session::{SavedStep, listed, pooled_rms, value_name};
use axum::Json;
use axum::extract::{Path, State};
use serde::Deserialize;
use serde_json::json;
use std::sync::Arc;

/// The page.
pub(super) async fn show(State(lab): State<Arc<LabState>>, Path(number): Path<u32>) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || Ok(page(pages::page(&session)?))).await
}

/// What is tried.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct TriedChange {
    /// The motion to draw.
    #[serde(default)]
    motion: usize,
    /// Whether a slider moves still: windows then start where those of the model in force start,
    /// which takes one simulation; else their starts are refitted.
    #[serde(default)]
    moving: bool,
    /// Effects to add: `coulomb@1`, at their start values.
    effects: Vec<String>,
    /// Addresses and values.
    values: Vec<(String, f64)>,
}

impl TriedChange {
    /// The model with what is tried, and the effects that it adds.
    fn applied_to(&self, model: &Model) -> Result<(Model, Vec<Candidate>)> {
        let mut tried = model.clone();
        let mut added = Vec::new();
        for name in &self.effects {
            let candidate = Candidate::named(name, &tried)?;
            let first = candidate
                .parameters()
                .iter()
                .map(|parameter| parameter.starts[0]);
            tried
                .effects
                .push(candidate.instance(&first.collect::<Vec<_>>()));
            added.push(candidate);
        }
        for (path, value) in self.paths()? {
            let (low, high) = path.bounds(&tried);
            let allowed = value.is_finite() && (low..=high).contains(&value);
            if !(allowed && path.set(&mut tried, value)) {
                return Err(Error::usage(
                    format!("{path} cannot be {value} here"),
                    format!("choose a value from {low} to {high} of the model"),
                ));
            }
        }
        Ok((tried, added))
    }

    /// What was done, in words: "set by hand: mass of link 1 to 0.2 kg".
    fn title(&self, with: &Model) -> String {
        let set = self.values.iter().map(|(address, value)| {
            let path = address.parse::<ParameterPath>().ok();
            let unit = path.filter(|path| path.get(with).is_some());
            let unit = unit.map_or("", |path| path.unit());
            let value = with_unit(&exact(*value), unit);
            format!("{} to {value}", value_name(address))
        });
        let set: Vec<String> = set.collect();
        format!("set by hand: {}", listed(set))
    }

    fn paths(&self) -> Result<Vec<(ParameterPath, f64)>> {
        let values = self.values.iter();
        values
            .map(|(path, value)| Ok((path.parse()?, *value)))
            .collect()
    }
}

/// Runs the tried model over the windows of the model in force.
pub(super) async fn run(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
    Json(tried): Json<TriedChange>,
) -> Answer {
    let session = session(&lab, number)?;
    blocking(move || {
        let saved = session.view();
        shown.check(&saved)?;
        let base = session.evaluation(&saved, saved.current)?;
        let base = base.ok_or(LabError::NotFound("comparison"))?;
        let (model, _) = tried.applied_to(&base.run.model)?;
        let (data, horizon) = (base.run.data.clone(), base.run.horizon);
        let run = if tried.moving {
            ModelRun::from_window_starts(model, data, horizon, base.run.window_starts.clone())
        } else {
            ModelRun::new(model, data, horizon)
        };
        let predicted = run.predicted.get(tried.motion);
        let mut arrays = Arrays::default();
        for (joint, angles) in predicted
            .ok_or(LabError::NotFound("motion"))?
            .iter()
            .enumerate()
        {
            arrays.push(format!("other_{joint}"), angles.iter().copied());
        }
        Ok(arrays.reply(&json!({ "rms": pooled_rms(&run), "error": base.shown_error() })))
    })
    .await
}

/// Keeps what is tried as the next step.
pub(super) async fn keep(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
    Json(tried): Json<TriedChange>,
) -> Answer {
    act(lab, number, "learn", move |session, saved| {
        shown.check(saved)?;
        let file = &session.model_path(saved.current);
        let step = saved.step().ok_or(LabError::NotFound("model"))?;
        let model = Model::parse(&step.toml, file)?;
        let (with, added) = tried.applied_to(&model)?;
        let paths = tried.paths()?;
        let of_model = paths
            .into_iter()
            .filter(|(path, _)| path.get(&model).is_some());
        let mut toml = edit::set_values(&step.toml, file, &of_model.collect::<Vec<_>>())?;
        for candidate in added {
            let instance = with
                .effects
                .iter()
                .find(|e| Candidate::from(*e) == candidate);
            if let Some(instance) = instance {
                toml = edit::add_effect(&toml, file, instance, None)?;
            }
        }
        Ok(session.push_step(SavedStep::by_hand(tried.title(&with), toml))?)
    })
    .await
}
