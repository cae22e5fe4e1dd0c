//! Effects added to a model's text, their values fitted along with the free ones.

use super::candidate::Candidate;
use super::error_reduction::ErrorReduction;
use super::horizon::Horizon;
use super::progress::Progress;
use super::refit::{MOST_LEFT, NotAdded, Refitted, Undetermined, refit_from};
use crate::error::{Error, Result};
use crate::model::{Model, ParameterPath, edit};
use crate::motion::{Motion, Split};
use crate::output::number::mrad;
use std::path::Path;

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
    /// They bring nothing that shows.
    Unhelpful(Unhelpful),
    /// The motions do not determine the values.
    Undetermined(Undetermined),
}

/// Effects that bring nothing that shows.
#[derive(Debug, Clone, PartialEq)]
pub enum Unhelpful {
    /// The fit found no better values than those at which the effects vanish: the error of the
    /// motions fitted.
    NotFound(ErrorReduction),
    /// The error on the motions held out is not reduced, though that on the motions fitted is.
    NotReduced {
        /// The error on the motions held out.
        error: ErrorReduction,
        /// That on the motions fitted, before and after, rad.
        fitted_rad: [f64; 2],
    },
}

impl Unhelpful {
    /// The error that decided.
    pub fn error(&self) -> &ErrorReduction {
        match self {
            Unhelpful::NotFound(error) | Unhelpful::NotReduced { error, .. } => error,
        }
    }

    /// Why the effects of these names are not added, as a clause.
    pub fn why(&self, names: &[String]) -> String {
        let (names, error) = (names.join(", "), self.error());
        let [before, after] = [error.before_rad, error.after_rad].map(mrad);
        match self {
            Unhelpful::NotFound(_) => format!(
                "with {names} the fit did not find a better value: {before} mrad on fitted motions \
                 without, {after} mrad with"
            ),
            Unhelpful::NotReduced { fitted_rad, .. } => {
                let [fitted_before, fitted_after] = fitted_rad.map(mrad);
                format!(
                    "with {names} the error on held-out motions goes from {before} to {after} mrad, \
                     though that on fitted motions goes from {fitted_before} to {fitted_after} mrad"
                )
            }
        }
    }

    /// What to do about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            Unhelpful::NotFound(_) => {
                "take shorter windows, which tell more of a motion that the model loses, or other \
                 motions"
            }
            Unhelpful::NotReduced { .. } => "the diagnosis says which effect the logs ask for",
        }
    }
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
            return Err(Error::usage(
                format!("`{candidate}` is named twice"),
                "name each effect once",
            ));
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
    add_effects_from(text, path, candidates, &[], split, horizon, progress)
}

/// The same from values that are known already, as those of a diagnosis: of the effects, and of
/// what is free beside them. On the motions fitted it leaves no more than with these.
///
/// # Errors
/// As [`add_effects`].
pub fn add_effects_from(
    text: &str,
    path: &Path,
    candidates: &[Candidate],
    start: &[(ParameterPath, f64)],
    split: &Split,
    horizon: Option<Horizon>,
    progress: &dyn Fn(Progress),
) -> Result<Addition> {
    let model = Model::parse(text, path)?;
    let refitted = match refit_from(&model, candidates, start, split, horizon, progress) {
        Ok(refitted) => Box::new(refitted),
        Err(NotAdded::Undetermined(why)) => return Ok(Addition::Undetermined(why)),
        Err(NotAdded::NotBetter(error)) => {
            return Ok(Addition::Unhelpful(Unhelpful::NotFound(error)));
        }
    };
    let (error, fitted_rad) = (refitted.error, refitted.fitted_rad);
    if error.after_rad > MOST_LEFT * error.before_rad {
        return Ok(Addition::Unhelpful(if error.held_out {
            Unhelpful::NotReduced { error, fitted_rad }
        } else {
            Unhelpful::NotFound(error)
        }));
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
    let values = refitted.values_of(model);
    let paths: Vec<ParameterPath> = values.iter().map(|(path, _)| *path).collect();
    let text = edit::keep_given(text, path, &paths, model)?;
    let text = edit::set_values(&text, path, &values)?;
    match refitted.shorter_step_s {
        Some(step_s) => edit::set_step(&text, path, step_s),
        None => Ok(text),
    }
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
