//! One case diagnosed as a user would, with default settings, and what was said of it.
//!
//! Everything is read from what `handstand diagnose --json` prints.

use super::case::{Case, Files, HiddenEffect};
use super::family::Family;
use super::outcome::{Answer, Outcome};
use super::said::{Said, said};
use super::score::{answer, values};
use crate::measured::version;
use handstand::compare::compare;
use handstand::diagnose::{DiagnoseOptions, diagnose};
use handstand::fitting::Horizon;
use handstand::log::{LogRequest, read};
use handstand::model::edit::{add_effect, set_values};
use handstand::model::{EffectInstance, ParameterPath};
use handstand::motion::Motion;
use handstand::report::diagnosis_json;
use handstand::{Model, effects};
use std::path::{Path, PathBuf};
use std::time::Instant;

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
        skipped: case.skipped.clone(),
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
        values: if answer == Answer::Right && case.family != Family::Outside {
            values(&files.effects, &said)
        } else {
            Vec::new()
        },
        answer,
        hidden,
        verdict: said.verdict,
        sets: said.sets,
        before_rad: errors.before_rad,
        after_rad: errors.after_rad,
        true_rad: errors.true_rad,
        seconds,
        version: version().to_string(),
    })
}

pub(super) fn motions(model: &Model, logs: &[PathBuf]) -> handstand::Result<Vec<Motion>> {
    let requests: Vec<LogRequest> = logs.iter().cloned().map(LogRequest::whole).collect();
    read(&requests, &model.log)
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
    // A robot's file lies beside it.
    let file = &files.nominal.with_file_name("found.toml");
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
