//! What a fit's data tell of its values: their intervals, which values nothing shows, and which of
//! those are held beside others of their effect.

use super::data::FitProblem;
use super::fit::{Fit, FitOptions};
use super::fitted_value::{FittedValue, fitted_values};
use super::jacobian::difference;
use super::refit::Undetermined;
use super::residual::residuals;
use super::solve::fit;
use crate::model::{Model, ParameterPath};
use crate::output::number::exact;

/// A fit's values with their intervals.
pub(super) struct ToldValues {
    /// The fit, without what is held.
    pub fit: Fit,
    /// In the order of what it leaves free.
    pub values: Vec<FittedValue>,
    /// What is held because nothing shows of it, a sentence each.
    pub held: Vec<String>,
}

/// The values that data determine; one that changes nothing beside another of its effect is held.
///
/// # Errors
/// The data do not determine the values.
pub(super) fn told_values(found: Fit, data: &FitProblem) -> Result<ToldValues, Undetermined> {
    let (values, told) = fitted_values(&found, data);
    if told.is_some() {
        return Ok(ToldValues {
            fit: found,
            values,
            held: Vec::new(),
        });
    }
    let held = blind_beside_others(&found, data);
    if held.is_empty() {
        return Err(undetermined_by(&found, data));
    }
    let found = with_held(found, &held, data);
    match fitted_values(&found, data) {
        (values, Some(_)) => {
            let sentence = |path| said_of_held(path, &found.model);
            let held = held.iter().map(sentence).collect();
            Ok(ToldValues {
                fit: found,
                values,
                held,
            })
        }
        _ => Err(undetermined_by(&found, data)),
    }
}

/// The blind parameters of effects of which another one tells: a dead zone whose commands begin at
/// zero has a width below which nothing shows.
fn blind_beside_others(found: &Fit, data: &FitProblem) -> Vec<ParameterPath> {
    let mut blind = blind(found, data);
    let effect = |path: &ParameterPath| match path {
        ParameterPath::Effect { id, joint, .. } => Some((*id, *joint)),
        _ => None,
    };
    let all = blind.clone();
    blind.retain(|path| {
        let own = effect(path);
        let tells = |other: &&ParameterPath| effect(other) == own && !all.contains(other);
        own.is_some() && found.free.iter().any(|other| tells(&other))
    });
    blind
}

/// The fit with some values held where they are.
fn with_held(mut found: Fit, held: &[ParameterPath], data: &FitProblem) -> Fit {
    found.model.free.retain(|path| !held.contains(path));
    let mut free = found.free;
    free.retain(|path| !held.contains(path));
    let options = FitOptions::default();
    fit(
        &found.model,
        &free,
        data,
        Some(&found.window_starts),
        options,
    )
}

fn said_of_held(path: &ParameterPath, model: &Model) -> String {
    let value = path.get(model).unwrap_or(f64::NAN);
    format!(
        "`{path}` changes nothing in these motions: it is held at {}.",
        exact(value)
    )
}

/// Why a fit has no intervals: the parameters that change nothing in the data.
fn undetermined_by(found: &Fit, data: &FitProblem) -> Undetermined {
    let blind = blind(found, data);
    Undetermined {
        blind: blind.iter().map(ToString::to_string).collect(),
        mixed: Vec::new(),
        hold: Vec::new(),
    }
}

/// The free parameters whose change, by the step of their derivative up or down, leaves every
/// prediction as it was: of a law that jumps a smaller one moves no sample across.
pub(super) fn blind(found: &Fit, data: &FitProblem) -> Vec<ParameterPath> {
    let base = residuals(&found.model, data, &found.window_starts);
    let changes_nothing = |path: &&ParameterPath| {
        let value = path.get(&found.model).unwrap_or(0.0);
        let (low, high) = path.bounds(&found.model);
        let step = difference(path, value);
        [value - step, value + step].iter().all(|other| {
            let mut moved = found.model.clone();
            let is_free = path.set(&mut moved, other.clamp(low, high));
            is_free && residuals(&moved, data, &found.window_starts) == base
        })
    };
    found.free.iter().filter(changes_nothing).cloned().collect()
}
