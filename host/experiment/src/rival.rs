//! The explanations that a diagnosis leaves open, each fitted to all logs.

use super::proposal::RivalName;
use crate::diagnose::{Diagnosis, FittedEffect, WrongValue, independent_share, values_behind};
use crate::fitting::{Fit, FitOptions, FitProblem, FittedValue, fit};
use crate::model::{Model, ParameterPath};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Iterations of a rival's fit to the logs.
const ITERATIONS: usize = 25;

/// An explanation fitted to the logs.
pub(super) struct Rival {
    pub name: RivalName,
    pub fit: Fit,
    /// Precision of its free values from the logs, and before them.
    pub known: DMatrix<f64>,
    /// Share of the samples that count as independent.
    pub share: f64,
    /// Values of the file whose measurement judges it: its own, and those behind its effects.
    pub measurable: Vec<String>,
}

impl Rival {
    /// A model with these values free, fitted to the logs.
    pub fn fitted(
        name: RivalName,
        model: &Model,
        free: &[ParameterPath],
        logs: &FitProblem,
    ) -> Rival {
        let fit = fit(model, free, logs, None, FitOptions::iterations(ITERATIONS));
        Rival {
            measurable: name.values.clone(),
            name,
            known: fit.information().matrix + fit.weak_prior(),
            share: independent_share(&fit, logs),
            fit,
        }
    }
}

/// The explanation of a diagnosis, then the alternatives that say something else.
pub(super) fn rivals(model: &Model, diagnosis: &Diagnosis, logs: &FitProblem) -> Vec<Rival> {
    let own = (&diagnosis.effects, &diagnosis.wrong_values);
    let others = diagnosis
        .alternatives
        .iter()
        .filter(|other| !other.same_law);
    let others = others.map(|other| (&other.effects, &other.wrong_values));
    let all: Vec<_> = std::iter::once(own).chain(others).collect();
    let given = model;
    let fitted = all.into_par_iter().map(|(effects, wrong)| {
        let (model, free) = explained(given, &diagnosis.base, effects, wrong);
        let name = RivalName::of(effects, &own_values(given, wrong));
        let mut rival = Rival::fitted(name, &model, &free, logs);
        let candidates = effects.iter().filter_map(|effect| effect.candidate(given));
        let behind = candidates.flat_map(|candidate| values_behind(&candidate, given));
        rival.measurable.extend(behind.map(|path| path.to_string()));
        rival
    });
    fitted.collect()
}

/// The wrong values that are an explanation's own: those that the file frees go with every one.
fn own_values(given: &Model, wrong: &[WrongValue]) -> Vec<String> {
    let is_free = |path: &String| {
        let path = path.parse::<ParameterPath>();
        path.is_ok_and(|path| given.free.contains(&path))
    };
    let paths = wrong.iter().map(|wrong| wrong.fitted.path.clone());
    paths.filter(|path| !is_free(path)).collect()
}

/// The model with effects and values, and what is free of it.
fn explained(
    model: &Model,
    base: &[FittedValue],
    effects: &[FittedEffect],
    wrong: &[WrongValue],
) -> (Model, Vec<ParameterPath>) {
    let mut explained = model.clone();
    let mut free = model.free.clone();
    let wrong = wrong.iter().map(|wrong| &wrong.fitted);
    for value in base.iter().chain(wrong) {
        let Ok(path) = value.path.parse::<ParameterPath>() else {
            continue;
        };
        if path.set(&mut explained, value.value) && !free.contains(&path) {
            free.push(path);
        }
    }
    for effect in effects {
        let Some(candidate) = effect.candidate(model) else {
            continue;
        };
        let values: Vec<f64> = effect.parameters.iter().map(|value| value.value).collect();
        explained.effects.push(candidate.instance(&values));
        free.extend(candidate.paths());
    }
    // What no other explanation has is not left free by it.
    free.retain(|path| path.get(&explained).is_some_and(f64::is_finite));
    (explained, free)
}
