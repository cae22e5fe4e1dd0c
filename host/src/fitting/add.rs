//! Effects added to a model's text, their values fitted along with the free ones.

use super::candidate::{Candidate, CandidateError};
use super::horizon::Horizon;
use super::progress::Progress;
use super::refit::{Refitted, Undetermined, refit_with};
use crate::error::Result;
use crate::log::{Motion, Split};
use crate::model::{Model, edit};
use crate::output::number::mrad;
use std::path::Path;

/// Share of the error that effects leave at most: what lowers it by less than a thousandth, a value
/// at which the effect vanishes for one, does not show.
const MOST_LEFT: f64 = 0.999;

/// What became of effects that were to be added.
#[derive(Debug, Clone)]
pub enum Addition {
    /// The model's text with them, and what was fitted.
    Added {
        /// Comments and layout are those of the text before.
        text: String,
        /// The fit.
        refitted: Box<Refitted>,
    },
    /// The error is not reduced, or by less than shows; the fit says by how much it misses.
    NotReduced(Box<Refitted>),
    /// The motions do not determine the values.
    Undetermined(Undetermined),
}

/// The effects of these names (`delay`, `coulomb@2`), each once.
///
/// # Errors
/// As [`Candidate::named`]; a name that stands there twice.
pub fn candidates_named(names: &[String], model: &Model) -> Result<Vec<Candidate>> {
    let mut candidates: Vec<Candidate> = Vec::new();
    for name in names {
        let candidate = Candidate::named(name, model)?;
        if candidates.contains(&candidate) {
            return Err(CandidateError::Twice(candidate).into());
        }
        candidates.push(candidate);
    }
    Ok(candidates)
}

/// Adds the candidates to the model that `text` describes, and refits its free values;
/// `path` names the text in errors, `progress` hears what is being done.
///
/// # Errors
/// A text that is no model, or a value that it cannot hold.
pub fn add_effects(
    text: &str,
    path: &Path,
    candidates: &[Candidate],
    split: &Split,
    horizon: Option<Horizon>,
    progress: &dyn Fn(Progress),
) -> Result<Addition> {
    let model = Model::parse(text, path)?;
    let refitted = match refit_with(&model, candidates, split, horizon, progress) {
        Ok(refitted) => Box::new(refitted),
        Err(why) => return Ok(Addition::Undetermined(why)),
    };
    if refitted.error.after_rad > MOST_LEFT * refitted.error.before_rad {
        return Ok(Addition::NotReduced(refitted));
    }
    let mut text = with_values(text, path, &model, &refitted)?;
    let logs = files(&split.training);
    let old = refitted.record(logs.clone());
    let old = old.about(|path| path.get(&model).is_some());
    text = edit::renew_provenance(&text, path, &old)?;
    for candidate in candidates {
        let (effect, fitted) = refitted.added(*candidate, logs.clone());
        text = edit::add_effect(&text, path, &effect, Some(&fitted))?;
    }
    Ok(Addition::Added { text, refitted })
}

/// The text of a model with the values of a fit in place of its own, and where they came from;
/// `path` names the text in errors.
///
/// # Errors
/// A value that the model cannot hold.
pub fn with_refitted(
    text: &str,
    path: &Path,
    model: &Model,
    refitted: &Refitted,
    split: &Split,
) -> Result<String> {
    let text = with_values(text, path, model, refitted)?;
    edit::renew_provenance(&text, path, &refitted.record(files(&split.training)))
}

/// The text with the values of a fit, and the integration step that they need.
fn with_values(text: &str, path: &Path, model: &Model, refitted: &Refitted) -> Result<String> {
    let text = edit::set_values(text, path, &refitted.values_of(model))?;
    match refitted.shorter_step_s {
        Some(step_s) => edit::set_step(&text, path, step_s),
        None => Ok(text),
    }
}

/// Why effects whose error is not reduced are not added.
pub fn not_reduced(refitted: &Refitted, names: &[String]) -> String {
    let error = &refitted.error;
    let motions = if error.held_out { "held-out" } else { "fitted" };
    let [before, after] = [error.before_rad, error.after_rad].map(mrad);
    format!(
        "with {} the error on {motions} motions goes from {before} to {after} mrad",
        names.join(", ")
    )
}

/// Name and SHA-256 of every file the motions came from, each once.
fn files(motions: &[Motion]) -> Vec<(String, String)> {
    let mut files: Vec<(String, String)> = Vec::new();
    for source in motions.iter().map(|motion| &motion.source) {
        let name = source.path.file_name().unwrap_or(source.path.as_os_str());
        let file = (name.to_string_lossy().into_owned(), source.sha256.clone());
        if !files.contains(&file) {
            files.push(file);
        }
    }
    files
}
