//! One case diagnosed as a user would, with default settings, and what was said of it.
//!
//! Everything is read from what `handstand diagnose --json` prints.

use super::case::{Case, Files, HiddenEffect, Truth};
use super::family::Family;
use super::said::{Said, said};
use handstand::compare::compare;
use handstand::diagnose::{DiagnoseOptions, diagnose};
use handstand::fitting::Horizon;
use handstand::log::{LogRequest, Motion, read};
use handstand::model::edit::{add_effect, set_values};
use handstand::model::{EffectInstance, ParameterPath};
use handstand::report::diagnosis_json;
use handstand::{Model, effects};
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// A value of a hidden effect beside its interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Value {
    /// Effect and key: `coulomb@1.torque_nm`.
    pub path: String,
    /// The truth.
    pub true_value: f64,
    /// What was fitted; none when the library's effect has no such value.
    pub estimate: Option<f64>,
    /// The 95 % interval.
    pub interval: Option<(f64, f64)>,
    /// Whether the truth lies in it.
    pub covered: bool,
}

/// What an answer is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// Exactly what is hidden was named; where nothing is hidden, nothing was; where the library
    /// lacks it, the answer is that it does.
    Right,
    /// What is hidden is one of the sets that cannot be told apart.
    Equivalent,
    /// Something else was named, or several sets without the truth.
    Wrong,
    /// Something is missing, none of the library's.
    Unexplained,
    /// Nothing is missing, though something is.
    Nominal,
    /// The data cannot tell.
    Unfit,
}

/// What a diagnosis said.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Who made the logs.
    pub truth: Truth,
    /// The family.
    pub family: Family,
    /// Kinds of the effects that were to be hidden.
    pub kinds: Vec<String>,
    /// Seed of the rig.
    pub seed: u64,
    /// What was hidden: `coulomb@1`.
    pub hidden: Vec<String>,
    /// The verdict, in its own word.
    pub verdict: String,
    /// Sets that were given, the best first.
    pub sets: Vec<Vec<String>>,
    /// What that is worth.
    pub answer: Answer,
    /// Error on the held-out motions before, rad.
    pub before_rad: Option<f64>,
    /// The same with what was found.
    pub after_rad: Option<f64>,
    /// The same of the true model, where the library can write it.
    pub true_rad: Option<f64>,
    /// The hidden effects' values, where exactly those effects were named.
    pub values: Vec<Value>,
    /// How long the diagnosis took, s.
    pub seconds: f64,
}

impl Outcome {
    /// Whether exactly the hidden effects were named, or it was said that nothing is missing, or
    /// that the library lacks what is.
    pub fn is_right(&self) -> bool {
        self.answer == Answer::Right
    }

    /// The hidden values that were fitted; one that was named as a value of the file, as a stall
    /// torque for the scale of torques, has no interval here.
    pub fn fitted(&self) -> impl Iterator<Item = &Value> {
        self.values.iter().filter(|value| value.interval.is_some())
    }

    /// Held-out error against the true model's.
    pub fn ratio(&self) -> Option<f64> {
        Some(self.after_rad? / self.true_rad?)
    }

    /// Whether this is the outcome of that case.
    pub fn is_of(&self, case: &Case) -> bool {
        (self.truth, self.family, self.seed) == (case.truth, case.family, case.seed)
            && self.kinds == case.hidden
    }
}

/// Writes the rig's logs, reads them as a user's, diagnoses those to learn from by those held out.
/// The files stay in a folder of `rigs`, if one is given.
///
/// # Errors
/// Logs that cannot be made, and files that cannot be written or are refused.
pub fn try_case(case: &Case, rigs: Option<&Path>) -> Result<Outcome, String> {
    let passing = tempfile::tempdir().map_err(|error| error.to_string())?;
    let kept = rigs.map(|rigs| rigs.join(case.name()));
    if let Some(dir) = &kept {
        std::fs::create_dir_all(dir).map_err(|error| format!("{}: {error}", dir.display()))?;
    }
    let files = case.write(kept.as_deref().unwrap_or(passing.path()))?;
    diagnosed(case, &files).map_err(|error| error.to_string())
}

/// What is said of the bench arm whose effect has this share of its strength, and what that is.
///
/// # Errors
/// As [`try_case`].
pub fn try_weakened(case: &Case, share: f64) -> Result<(Answer, Vec<HiddenEffect>), String> {
    let passing = tempfile::tempdir().map_err(|error| error.to_string())?;
    let files = case.write_weakened(share, passing.path())?;
    let outcome = diagnosed(case, &files).map_err(|error| error.to_string())?;
    Ok((outcome.answer, files.effects))
}

fn diagnosed(case: &Case, files: &Files) -> handstand::Result<Outcome> {
    let model = Model::load(&files.nominal)?;
    let (training, held_out) = (
        motions(&model, &files.fit)?,
        motions(&model, &files.held_out)?,
    );
    let options = DiagnoseOptions {
        without: case.without(),
        ..DiagnoseOptions::default()
    };
    let begun = Instant::now();
    let json = diagnosis_json(&diagnose(
        &model,
        training,
        held_out.clone(),
        &options,
        &|_| {},
    ));
    let seconds = begun.elapsed().as_secs_f64();
    let said = said(&json);
    let hidden: Vec<String> = files.effects.iter().map(HiddenEffect::address).collect();
    let errors = errors(&model, files, &said, &held_out)?;
    let answer = answer(case, &hidden, &said);
    Ok(Outcome {
        truth: case.truth,
        family: case.family,
        kinds: case.hidden.iter().map(|kind| kind.to_string()).collect(),
        seed: case.seed,
        values: match answer == Answer::Right && case.family != Family::Outside {
            true => values(&files.effects, &json),
            false => Vec::new(),
        },
        answer,
        hidden,
        verdict: said.verdict,
        sets: said.sets,
        before_rad: errors.before_rad,
        after_rad: errors.after_rad,
        true_rad: errors.true_rad,
        seconds,
    })
}

fn motions(model: &Model, logs: &[PathBuf]) -> handstand::Result<Vec<Motion>> {
    let requests: Vec<LogRequest> = logs.iter().cloned().map(LogRequest::whole).collect();
    read(&requests, &model.log)
}

/// What the answer is worth.
fn answer(case: &Case, hidden: &[String], said: &Said) -> Answer {
    let sorted = |set: &[String]| {
        let mut set = set.to_vec();
        set.sort();
        set
    };
    let truth = sorted(hidden);
    let best = said.sets.first().map(|set| sorted(set)).unwrap_or_default();
    let nothing = match said.verdict.as_str() {
        "nominal" | "adequate" => true,
        // Wrong are only the values of friction that the owner guesses.
        "wrong_value" => best.is_empty(),
        _ => false,
    };
    match said.verdict.as_str() {
        "unfit" => Answer::Unfit,
        _ if nothing && case.family.hides_nothing() => Answer::Right,
        _ if nothing => Answer::Nominal,
        "unexplained" if case.family == Family::Outside => Answer::Right,
        "unexplained" => Answer::Unexplained,
        _ if case.family == Family::Outside => Answer::Wrong,
        "ambiguous" if said.sets.iter().any(|set| sorted(set) == truth) => Answer::Equivalent,
        "named" | "wrong_value" if best == truth => Answer::Right,
        _ => Answer::Wrong,
    }
}

/// Root-mean-square errors on the held-out motions.
struct Errors {
    before_rad: Option<f64>,
    after_rad: Option<f64>,
    true_rad: Option<f64>,
}

/// Errors of the model as it is, of the one that was found, and of the true one, all over one
/// horizon: that of the result, or that of the true model where the result has none.
fn errors(
    model: &Model,
    files: &Files,
    said: &Said,
    held_out: &[Motion],
) -> handstand::Result<Errors> {
    let truth = files.truth.as_deref().map(Model::load).transpose()?;
    let truth = truth.map(|truth| in_fine_steps(truth, said));
    let found = in_fine_steps(found(files, said)?, said);
    let mut horizon = said.horizon_s.map(Horizon::Seconds);
    let mut error = |model: &Model| {
        let compared = compare(model, "model", held_out, horizon);
        horizon = Some(Horizon::from_seconds(compared.horizon_s));
        let squares = compared.pooled().map(|signal| signal.rms.powi(2));
        let mean = squares.sum::<f64>() / compared.pooled().count() as f64;
        mean.is_finite().then_some(mean.sqrt())
    };
    let true_rad = truth.as_ref().and_then(&mut error);
    Ok(Errors {
        true_rad,
        after_rad: error(&found),
        before_rad: error(model),
    })
}

/// The model in the shorter steps that the result asks for.
fn in_fine_steps(mut model: Model, said: &Said) -> Model {
    model.step_s = model
        .step_s
        .min(said.shorter_step_s.unwrap_or(f64::INFINITY));
    model
}

/// The model with what the result gives it.
fn found(files: &Files, said: &Said) -> handstand::Result<Model> {
    let file = Path::new("found.toml");
    let mut text = std::fs::read_to_string(&files.nominal)
        .map_err(|error| handstand::Error::file(&files.nominal, "read", error))?;
    let mut values = Vec::new();
    for (path, value) in &said.values {
        if let Ok(path) = path.parse::<ParameterPath>() {
            values.push((path, *value));
        }
    }
    text = set_values(&text, file, &values)?;
    for effect in &said.effects {
        if let Some(known) = effects::named(&effect.kind) {
            let off = known.info().parameters.iter();
            let instance = EffectInstance {
                effect: known,
                joint: effect.joint.map(|joint| joint - 1),
                values: off
                    .map(|parameter| effect.value(parameter.key).unwrap_or(f64::NAN))
                    .collect(),
            };
            text = add_effect(&text, file, &instance, None)?;
        }
    }
    Model::parse(&text, file)
}

fn values(hidden: &[HiddenEffect], json: &Json) -> Vec<Value> {
    let said = said(json);
    let mut values = Vec::new();
    for effect in hidden {
        let address = effect.address();
        let fitted = said.effects.iter().find(|said| said.address() == address);
        for (key, truth) in &effect.parameters {
            let Some(truth) = truth.as_f64() else {
                continue;
            };
            let fitted = fitted.and_then(|fitted| fitted.parameters.get(key));
            values.push(Value {
                path: format!("{address}.{key}"),
                true_value: truth,
                estimate: fitted.map(|fitted| fitted.value),
                interval: fitted.map(|fitted| (fitted.low, fitted.high)),
                covered: fitted.is_some_and(|fitted| {
                    covers(key, fitted.value, (fitted.low, fitted.high), truth)
                }),
            });
        }
    }
    values
}

/// Whether the interval holds the truth; a phase is known but for whole turns.
fn covers(key: &str, value: f64, (low, high): (f64, f64), truth: f64) -> bool {
    let truth = match key.contains("phase") {
        true => value + (truth - value + PI).rem_euclid(TAU) - PI,
        false => truth,
    };
    (low..=high).contains(&truth)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(family: Family, hidden: &[&'static str]) -> Case {
        Case {
            truth: Truth::Own,
            family,
            hidden: hidden.to_vec(),
            seed: 1,
        }
    }

    fn heard(verdict: &str, sets: &[&[&str]]) -> Said {
        let own = |set: &&[&str]| set.iter().map(|name| name.to_string()).collect();
        Said {
            verdict: verdict.to_string(),
            sets: sets.iter().map(own).collect(),
            ..Said::default()
        }
    }

    #[test]
    fn a_phase_is_covered_but_for_whole_turns() {
        assert!(covers("phase_rad", 3.1, (2.9, 3.3), -3.1));
        assert!(!covers("phase_rad", 3.1, (2.9, 3.3), -2.8));
        assert!(!covers("angle_rad", 3.1, (2.9, 3.3), -3.1));
    }

    #[test]
    fn only_the_hidden_set_is_right() {
        let pair = case(Family::Pairs, &["delay", "mass"]);
        let hidden = ["delay@1".to_string(), "mass@1".to_string()];
        let worth = |said: &Said| answer(&pair, &hidden, said);
        assert_eq!(
            worth(&heard("named", &[&["mass@1", "delay@1"]])),
            Answer::Right
        );
        assert_eq!(worth(&heard("named", &[&["delay@1"]])), Answer::Wrong);
        assert_eq!(
            worth(&heard("named", &[&["delay@2", "mass@1"]])),
            Answer::Wrong
        );
        let with = heard("ambiguous", &[&["delay@1"], &["delay@1", "mass@1"]]);
        assert_eq!(worth(&with), Answer::Equivalent);
        let lacks = heard("ambiguous", &[&["delay@1"], &["mass@1"]]);
        assert_eq!(worth(&lacks), Answer::Wrong);
        assert_eq!(
            worth(&heard("unexplained", &[&["delay@1", "mass@1"]])),
            Answer::Unexplained
        );
        assert_eq!(worth(&heard("nominal", &[])), Answer::Nominal);
        assert_eq!(worth(&heard("wrong_value", &[&[]])), Answer::Nominal);
        assert_eq!(worth(&heard("unfit", &[])), Answer::Unfit);
    }

    #[test]
    fn nothing_and_what_the_library_lacks_have_answers_of_their_own() {
        let nothing = case(Family::Nothing, &[]);
        assert_eq!(answer(&nothing, &[], &heard("nominal", &[])), Answer::Right);
        assert_eq!(
            answer(&nothing, &[], &heard("named", &[&["mass@1"]])),
            Answer::Wrong
        );
        let guessed = heard("wrong_value", &[&[]]);
        assert_eq!(answer(&nothing, &[], &guessed), Answer::Right);
        let heavy = heard("wrong_value", &[&["mass@1"]]);
        assert_eq!(answer(&nothing, &[], &heavy), Answer::Wrong);
        let none = heard("unexplained", &[&[]]);
        assert_eq!(answer(&nothing, &[], &none), Answer::Unexplained);
        let outside = case(Family::Outside, &["mass"]);
        let hidden = ["mass@1".to_string()];
        assert_eq!(
            answer(&outside, &hidden, &heard("unexplained", &[])),
            Answer::Right
        );
        let sets: &[&[&str]] = &[&["mass@1"], &["delay@1"]];
        assert_eq!(
            answer(&outside, &hidden, &heard("ambiguous", sets)),
            Answer::Wrong
        );
        assert_eq!(
            answer(&outside, &hidden, &heard("nominal", &[])),
            Answer::Nominal
        );
    }
    #[test]
    fn a_library_lacks_what_holds_the_hidden_effect_too() {
        let without = |kind| case(Family::Outside, &[kind]).without();
        assert_eq!(without("mass"), ["mass"]);
        assert_eq!(
            without("load_friction"),
            ["load_friction", "drive_asymmetry"]
        );
        assert!(case(Family::Single, &["mass"]).without().is_empty());
    }
}
