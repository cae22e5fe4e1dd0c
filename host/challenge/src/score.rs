//! A model against the answer of its challenge.

use super::seal::{ChallengeAnswer, unseal};
use handstand_model::error::{Error, Place, Result};
use handstand_model::model::{EffectInstance, Model};
use handstand_model::output::number::exact;
use serde::Serialize;
use std::path::Path;

/// How well a model names what was hidden.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChallengeScore {
    /// The hidden effect; absent when nothing was.
    pub hidden: Option<String>,
    /// Effects the model has beyond `nominal.toml`.
    pub added: Vec<String>,
    /// Whether exactly the hidden effect was added, and none where none was hidden.
    pub solved: bool,
    /// The hidden effect's values, true and estimated.
    pub values: Vec<ScoredValue>,
    /// Root-mean-square error of `nominal.toml` on `c.csv`, rad.
    pub nominal_error_rad: f64,
    /// The same of the model.
    pub error_rad: f64,
    /// The same of the truth.
    pub true_error_rad: f64,
}

/// A true value and its estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScoredValue {
    /// Its key.
    pub key: String,
    /// The truth.
    pub true_value: f64,
    /// The model's, if it has the effect.
    pub estimate: Option<f64>,
}

/// Opens the answer of the challenge in `dir` and scores `model` by it. `error_rad` simulates a
/// model along a log from fitted start states; a challenge knows no simulation but its own.
///
/// # Errors
/// Files of the challenge that are missing or were changed, and those of `error_rad`.
pub fn score(
    dir: &Path,
    model: &Model,
    error_rad: impl Fn(&Model, &Path) -> Result<f64>,
) -> Result<ChallengeScore> {
    let file = dir.join("answer.sealed");
    let text = std::fs::read_to_string(&file).map_err(|error| Error::file(&file, "read", error))?;
    let answer: ChallengeAnswer = unseal(&text).map_err(|why| why.at(Place::file(&file)))?;
    let nominal = Model::load(&dir.join("nominal.toml"))?;
    let truth = Model::parse(&answer.true_model_toml, &file)?;
    let added = beyond(model, &nominal);
    let name = |effect: &&EffectInstance| effect.name();
    let names: Vec<String> = added.iter().map(name).collect();
    let hidden = beyond(&truth, &nominal).first().map(name);
    let last = dir.join("c.csv");
    let error = |model: &Model| error_rad(model, &last);
    Ok(ChallengeScore {
        solved: names.iter().eq(hidden.iter()),
        values: values(&answer, &added),
        hidden,
        added: names,
        nominal_error_rad: error(&nominal)?,
        error_rad: error(model)?,
        true_error_rad: error(&truth)?,
    })
}

/// A score as a table's rows: a header, then the hidden effect, its values and the error on the
/// last log, mrad, each by the truth and by the model.
pub fn score_rows<'a>(
    hidden: Option<&str>,
    added: &[String],
    values: impl Iterator<Item = (&'a str, f64, Option<f64>)>,
    errors_rad: [f64; 2],
) -> Vec<Vec<String>> {
    let nothing = || "nothing".to_string();
    let hidden = hidden.map_or_else(nothing, str::to_string);
    let added = Some(added.join(", ")).filter(|added| !added.is_empty());
    let [truth, own] = errors_rad.map(|rad| exact(1e3 * rad));
    let row = |what: &str, truth, own| vec![what.to_string(), truth, own];
    let mut rows = vec![
        row("", "True".to_string(), "Estimated".to_string()),
        row("effect", hidden, added.unwrap_or_else(nothing)),
    ];
    rows.extend(values.map(|(key, truth, estimate)| {
        row(key, exact(truth), estimate.map_or("-".to_string(), exact))
    }));
    rows.push(row("error on c.csv, mrad", truth, own));
    rows
}

/// Effects of `model` that `base` has not.
fn beyond<'a>(model: &'a Model, base: &Model) -> Vec<&'a EffectInstance> {
    let new = |effect: &&EffectInstance| !base.has_effect(effect.effect.info().id, effect.joint);
    model.effects.iter().filter(new).collect()
}

fn values(answer: &ChallengeAnswer, added: &[&EffectInstance]) -> Vec<ScoredValue> {
    let id = |effect: &EffectInstance| effect.effect.info().id;
    let mut added = added.iter();
    let found = added.find(|effect| Some(id(effect)) == answer.kind.as_deref());
    let estimate = |key: &str| {
        let parameters = found?.effect.info().parameters;
        let at = parameters
            .iter()
            .position(|parameter| parameter.key == key)?;
        found?.values.get(at).copied()
    };
    let values = answer.parameters.iter().map(|(key, value)| ScoredValue {
        key: key.clone(),
        true_value: *value,
        estimate: estimate(key),
    });
    values.collect()
}
