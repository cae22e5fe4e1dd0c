//! From recordings to a better model.

use crate::diagnose::conventions::ModelFile;
use crate::diagnose::{DiagnoseOptions, Diagnosis, FittedEffect, diagnose_logs};
use crate::effects::EFFECTS;
use crate::error::Result;
use crate::fitting::{Addition, Candidate, Horizon, Progress, add_effects, candidates_named};
use crate::log::LogSet;
use crate::model::edit::{add_effect, set_step};
use crate::model::{EffectInstance, Model};
use std::path::Path;

/// Kinds of effects that are tried: those of servos and links that a designer can do something
/// about. All others are left out, that the diagnosis takes a minute; `handstand diagnose` tries
/// them on the same files.
const TRIED: [&str; 4] = ["delay", "dead_zone", "coulomb", "mass"];
/// Length of the windows that are judged, s: dry friction of the bar, which has no encoder, shows
/// in how a swing dies down, and in shorter windows their start states take it up.
const HORIZON: Horizon = Horizon::Seconds(0.6);

/// What the recordings taught.
#[derive(Debug, Clone)]
pub struct Learned {
    /// What was found.
    pub diagnosis: Diagnosis,
    /// Effects that were added, as `delay@all`; none where nothing was found.
    pub added: Vec<String>,
    /// The model file with them; the old one where there are none.
    pub model_toml: String,
}

impl Learned {
    /// Diagnoses the model of `file` and adds what is missing.
    ///
    /// # Errors
    /// Logs that cannot be read, or effects that the model has no room for.
    pub fn from_logs(
        text: &str,
        file: &Path,
        logs: &LogSet,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<Learned> {
        let model = Model::parse(text, file)?;
        let options = DiagnoseOptions {
            without: (EFFECTS.iter().map(|effect| effect.info().id))
                .filter(|id| !TRIED.contains(id))
                .map(String::from)
                .collect(),
            horizon: Some(HORIZON),
            most_effects: 2,
            // Columns and drives are the recorder's own: what makes others look better is missing.
            trust_log: true,
            ..DiagnoseOptions::default()
        };
        let named = ModelFile { path: file, text };
        let found = diagnose_logs(&model, named, logs, &options, progress)?;
        let added: Vec<String> = (found.diagnosis.effects.iter())
            .map(FittedEffect::address)
            .collect();
        let model_toml = if added.is_empty() {
            text.to_string()
        } else {
            let candidates = candidates_named(&added, &model)?;
            let horizon = Some(HORIZON);
            let addition = add_effects(text, file, &candidates, &found.split, horizon, &|_| {})?;
            match addition {
                Addition::Added { text, .. } => text,
                Addition::Undetermined(_) => as_diagnosed(text, file, &found.diagnosis)?,
                Addition::Unhelpful(_) => text.to_string(),
            }
        };
        Ok(Learned {
            diagnosis: found.diagnosis,
            added,
            model_toml,
        })
    }
}

/// The model file with the effects and values of the diagnosis itself: where a dead zone takes away
/// as much as it is wide, no motion tells a smaller width, and a fit of all values is refused.
fn as_diagnosed(text: &str, file: &Path, diagnosis: &Diagnosis) -> Result<String> {
    let add = |text: String, fitted: &FittedEffect| {
        let candidate = Candidate::named(&fitted.address(), &Model::parse(&text, file)?)?;
        let instance = EffectInstance {
            effect: candidate.effect,
            joint: candidate.joint,
            values: fitted.parameters.iter().map(|it| it.value).collect(),
        };
        add_effect(&text, file, &instance, None)
    };
    let text = diagnosis.effects.iter().try_fold(text.to_string(), add)?;
    match diagnosis.shorter_step_s {
        Some(step_s) => set_step(&text, file, step_s),
        None => Ok(text),
    }
}
