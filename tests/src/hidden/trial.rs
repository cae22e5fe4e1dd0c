//! One bench diagnosed, and what was said of it.

use handstand::challenge::{ChallengeAnswer, Hidden, generate};
use handstand::diagnose::{DiagnoseOptions, Diagnosis, Verdict, diagnose};
use handstand::fitting::{FitData, FittedValue, Horizon, fit_start_states};
use handstand::log::{LogRequest, Motion, read};
use handstand::{Error, Model, Result};
use serde::Serialize;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::time::Instant;

/// A bench to diagnose.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Case {
    /// What it hides; none when it hides nothing.
    pub kind: Option<&'static str>,
    /// Its seed.
    pub seed: u64,
    /// Whether the library lacks that effect.
    pub left_out: bool,
}

/// A value of a hidden effect beside its interval.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Value {
    /// Its key.
    pub key: String,
    /// The truth.
    pub true_value: f64,
    /// What was fitted; none when the library's effect has no such value.
    pub estimate: Option<f64>,
    /// The 95 % interval.
    pub interval: Option<(f64, f64)>,
    /// Whether the truth lies in it.
    pub covered: bool,
}

/// What a diagnosis said.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outcome {
    /// What was hidden.
    pub hidden: Option<String>,
    /// Seed of the bench.
    pub seed: u64,
    /// Whether the library lacked that effect.
    pub left_out: bool,
    /// The verdict.
    pub verdict: Verdict,
    /// Kinds of the effects it gives.
    pub effects: Vec<String>,
    /// Sets it could not tell from them.
    pub alternatives: Vec<Vec<String>>,
    /// Error on the held-out motion before, rad.
    pub before_rad: f64,
    /// The same with the effects.
    pub after_rad: f64,
    /// The same of the true model.
    pub true_rad: f64,
    /// The hidden effect's values, where exactly that effect was named.
    pub values: Vec<Value>,
    /// How long the diagnosis took; not part of the JSON, so that equal runs give equal bytes.
    #[serde(skip)]
    pub seconds: f64,
}

impl Outcome {
    /// Whether exactly the hidden effect was named.
    pub fn is_right(&self) -> bool {
        self.verdict == Verdict::Named && self.effects.iter().eq(self.hidden.iter())
    }

    /// Whether it says that an effect is missing.
    pub fn names_effects(&self) -> bool {
        matches!(
            self.verdict,
            Verdict::Named | Verdict::Ambiguous | Verdict::Unexplained
        )
    }

    /// Held-out error against the true model's.
    pub fn ratio(&self) -> f64 {
        self.after_rad / self.true_rad
    }
}

/// Writes the bench's logs, reads them as a user's, diagnoses the first two by the third.
///
/// # Errors
/// A file that could not be written, or was refused.
pub fn try_case(case: &Case) -> Result<Outcome> {
    let challenge = generate(case.seed, case.kind.map_or(Hidden::Nothing, Hidden::Effect));
    let folder = std::env::temp_dir();
    let dir = tempfile::tempdir().map_err(|error| Error::file(&folder, "create", error))?;
    let mut motions = Vec::new();
    let model = Model::parse(&challenge.model_toml, Path::new("nominal.toml"))?;
    for (name, content) in &challenge.logs {
        let path = dir.path().join(name);
        std::fs::write(&path, content).map_err(|error| Error::file(&path, "write", error))?;
        motions.extend(read(&[LogRequest::whole(path)], &model.log)?);
    }
    let held_out = motions.split_off(2);
    let options = DiagnoseOptions {
        without: case
            .left_out
            .then_some(case.kind)
            .flatten()
            .map(str::to_owned)
            .into_iter()
            .collect(),
        ..DiagnoseOptions::default()
    };
    let begun = Instant::now();
    let said = diagnose(&model, motions.clone(), held_out.clone(), &options, &|_| {});
    let seconds = begun.elapsed().as_secs_f64();
    let truth = Model::parse(&challenge.answer.true_model_toml, Path::new("true.toml"))?;
    let mut outcome = Outcome {
        hidden: challenge.answer.kind.clone(),
        seed: case.seed,
        left_out: case.left_out,
        verdict: said.verdict,
        effects: said.effects.iter().map(|e| e.kind.clone()).collect(),
        alternatives: said
            .alternatives
            .iter()
            .map(|set| set.effects.iter().map(|e| e.kind.clone()).collect())
            .collect(),
        before_rad: said.error.before_rad,
        after_rad: said.error.after_rad,
        true_rad: true_error_rad(&truth, motions, held_out, said.horizon_s),
        values: Vec::new(),
        seconds,
    };
    if outcome.is_right() {
        outcome.values = values(&challenge.answer, &said);
    }
    Ok(outcome)
}

/// What the true model leaves of the held-out motion, weighed and cut as the diagnosis did.
fn true_error_rad(
    truth: &Model,
    training: Vec<Motion>,
    held_out: Vec<Motion>,
    horizon_s: Option<f64>,
) -> f64 {
    let horizon = horizon_s.map_or(Horizon::Whole, Horizon::Seconds);
    let data = FitData::new(truth, held_out, horizon)
        .weighted_like(&FitData::new(truth, training, horizon));
    fit_start_states(truth, &data).rms_rad(&data)
}

fn values(answer: &ChallengeAnswer, said: &Diagnosis) -> Vec<Value> {
    let fitted = |key: &str| {
        let mut all = said.effects.iter().flat_map(|effect| &effect.parameters);
        all.find(|value| value.key == key)
    };
    let value = |(key, truth): &(String, f64)| {
        let fitted = fitted(key);
        Value {
            key: key.clone(),
            true_value: *truth,
            estimate: fitted.map(|fitted| fitted.value),
            interval: fitted.map(|fitted| (fitted.low, fitted.high)),
            covered: fitted.is_some_and(|fitted| covers(fitted, *truth)),
        }
    };
    answer.parameters.iter().map(value).collect()
}

/// Whether the interval holds the truth; a phase is known but for whole turns.
fn covers(fitted: &FittedValue, truth: f64) -> bool {
    let truth = if fitted.key.contains("phase") {
        fitted.value + (truth - fitted.value + PI).rem_euclid(TAU) - PI
    } else {
        truth
    };
    (fitted.low..=fitted.high).contains(&truth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phase_is_covered_but_for_whole_turns() {
        let fitted = |key: &str| FittedValue {
            path: format!("cogging@1.{key}"),
            key: key.to_owned(),
            unit: "rad".to_owned(),
            value: 3.1,
            low: 2.9,
            high: 3.3,
            on_bound: false,
        };
        assert!(covers(&fitted("phase_rad"), -3.1));
        assert!(!covers(&fitted("phase_rad"), -2.8));
        assert!(!covers(&fitted("angle_rad"), -3.1));
    }
}
