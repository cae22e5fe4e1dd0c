//! A model against the answer of its challenge.

use super::{Answer, unseal};
use crate::diagnose::Candidate;
use crate::error::{Error, Result};
use crate::fitting::rms_rad;
use crate::fitting::{Data, Horizon, settle};
use crate::log::{LogRequest, read};
use crate::model::{EffectInstance, Model};
use serde::Serialize;
use std::path::Path;

/// How well a model names what was hidden.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Score {
    /// The hidden effect; absent when nothing was.
    pub hidden: Option<String>,
    /// Effects the model has beyond `nominal.toml`.
    pub added: Vec<String>,
    /// Whether exactly the hidden effect was added, and none where none was hidden.
    pub solved: bool,
    /// The hidden effect's values beside those of the model.
    pub values: Vec<ScoredValue>,
    /// Root-mean-square error of `nominal.toml` on `c.csv`, rad.
    pub nominal_error_rad: f64,
    /// The same of the model.
    pub error_rad: f64,
    /// The same of the truth.
    pub true_error_rad: f64,
}

/// A value beside its truth.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScoredValue {
    /// Its key.
    pub key: String,
    /// The truth.
    pub hidden: f64,
    /// The model's, if it has the effect.
    pub found: Option<f64>,
}

/// Opens the answer of the challenge in `dir` and scores `model` by it.
///
/// # Errors
/// Files of the challenge that are missing or were changed.
pub fn score(dir: &Path, model: &Model) -> Result<Score> {
    let sealed = dir.join("answer.sealed");
    let text =
        std::fs::read_to_string(&sealed).map_err(|error| Error::file(&sealed, "read", error))?;
    let answer = unseal(&text, &sealed)?;
    let nominal = Model::load(&dir.join("nominal.toml"))?;
    let truth = Model::parse(&answer.true_model_toml, &sealed)?;
    let added = beyond(model, &nominal);
    let names: Vec<String> = added.iter().map(|effect| name(effect)).collect();
    let hidden = beyond(&truth, &nominal).first().map(|effect| name(effect));
    let last = LogRequest::whole(dir.join("c.csv"));
    let error = |model: &Model| -> Result<f64> {
        let data = Data::new(
            model,
            read(std::slice::from_ref(&last), &model.log)?,
            Horizon::Whole,
        );
        Ok(rms_rad(&settle(model, &data), &data))
    };
    Ok(Score {
        solved: names.iter().eq(hidden.iter()),
        values: values(&answer, &added),
        hidden,
        added: names,
        nominal_error_rad: error(&nominal)?,
        error_rad: error(model)?,
        true_error_rad: error(&truth)?,
    })
}

/// Effects of `model` that `base` has not.
fn beyond<'a>(model: &'a Model, base: &Model) -> Vec<&'a EffectInstance> {
    let new = |effect: &&EffectInstance| !base.has_effect(effect.effect.info().id, effect.joint);
    model.effects.iter().filter(new).collect()
}

fn name(effect: &EffectInstance) -> String {
    let candidate = Candidate {
        effect: effect.effect,
        joint: effect.joint,
    };
    candidate.to_string()
}

fn values(answer: &Answer, added: &[&EffectInstance]) -> Vec<ScoredValue> {
    let kind = answer.kind.as_deref();
    let found = added
        .iter()
        .find(|effect| Some(effect.effect.info().id) == kind);
    let value = |key: &str| {
        let effect = found?;
        let at = effect
            .effect
            .info()
            .parameters
            .iter()
            .position(|p| p.key == key)?;
        effect.values.get(at).copied()
    };
    let hidden = answer.parameters.iter().map(|(key, hidden)| ScoredValue {
        key: key.clone(),
        hidden: *hidden,
        found: value(key),
    });
    hidden.collect()
}
