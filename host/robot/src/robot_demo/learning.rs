//! From recordings to a better model.

use crate::diagnose::conventions::ModelFile;
use crate::diagnose::{DiagnoseOptions, Diagnosis, FittedEffect, diagnose_logs};
use crate::error::Result;
use crate::fitting::{Addition, Candidate, Progress, add_effects, candidates_named};
use crate::log::LogSet;
use crate::model::edit::{add_effect, set_step};
use crate::model::{EffectInstance, Model};
use std::path::Path;

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
    /// Diagnoses the model of `file` as `handstand diagnose` does unless told otherwise, and adds
    /// what is missing as `handstand add` does.
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
        let named = ModelFile { path: file, text };
        let found = diagnose_logs(&model, named, logs, &DiagnoseOptions::default(), progress)?;
        let added: Vec<String> = (found.diagnosis.effects.iter())
            .map(FittedEffect::address)
            .collect();
        let model_toml = if added.is_empty() {
            text.to_string()
        } else {
            let candidates = candidates_named(&added, &model)?;
            let addition = add_effects(text, file, &candidates, &found.split, None, &|_| {})?;
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
