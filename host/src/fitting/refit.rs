//! A model refitted, alone or with one more effect: its values, how well they are known, and how
//! far the error is reduced.

#[cfg(test)]
mod tests;

use super::data::FitData;
use super::error_reduction::ErrorReduction;
use super::fit::{Fit, FitOptions};
use super::fitted_value::{FittedValue, fitted_values};
use super::horizon::Horizon;
use super::mixture::untold_mixture;
use super::polish::{polish, settle};
use super::progress::{Progress, RefitSteps};
use super::residual::residuals;
use super::solve::{fit, fit_start_states};
use super::staged::fit_staged;
use super::stairs::told_by_others;
use super::windows::MotionWindow;
use crate::fitting::Candidate;
use crate::log::Split;
use crate::model::edit::FitRecord;
use crate::model::{EffectInstance, MeasuredSignal, Model, ParameterPath};

/// Over short windows the squared error has few false valleys: where start values are told apart,
/// s.
const SCREENING_S: f64 = 1.0;
/// Iterations that tell a promising start from a hopeless one.
const SCREENING: FitOptions = FitOptions {
    rough: true,
    glance: false,
    iterations: 8,
    tolerance: 1e-3,
};

/// A refitted model.
#[derive(Debug, Clone)]
pub struct Refitted {
    /// The model with its new values.
    pub model: Model,
    /// What was free: the base's parameters first, then the effect's.
    pub free: Vec<ParameterPath>,
    /// Fitted values in the order of `free`.
    pub values: Vec<FittedValue>,
    /// Error before and after.
    pub error: ErrorReduction,
    /// The integration step, s, where the logs ask for a shorter one than the model's own.
    pub shorter_step_s: Option<f64>,
    /// How long the model ran without correction at most.
    pub horizon: Horizon,
    /// How long the windows of each motion are, those held out last.
    pub windows: Vec<MotionWindow>,
    /// What the logs cannot observe of the joints' motion, a sentence each.
    pub unobserved: Vec<String>,
    /// Whether the search met its tolerance before its iterations ran out.
    pub converged: bool,
}

/// The motions do not determine the values.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", undetermined(.blind, .mixed))]
pub struct Undetermined {
    /// Parameters that change nothing in these motions; none when only a mixture of several is
    /// undetermined.
    pub blind: Vec<String>,
    /// Parameters of which these motions tell only a mixture, where that is known.
    pub mixed: Vec<String>,
}

fn undetermined(blind: &[String], mixed: &[String]) -> String {
    match blind {
        [] if !mixed.is_empty() => format!(
            "these motions tell only mixtures of `{}`",
            mixed.join("`, `")
        ),
        [] => "these motions do not tell the free parameters apart".to_string(),
        [one] => format!("`{one}` has no effect on these motions"),
        several => format!("`{}` have no effect on these motions", several.join("`, `")),
    }
}

impl Refitted {
    /// Addresses and values of those parameters that `model` has too.
    pub fn values_of(&self, model: &Model) -> Vec<(ParameterPath, f64)> {
        let values = self.values.iter().map(|value| value.value);
        let all = self.free.iter().copied().zip(values);
        all.filter(|(path, _)| path.get(model).is_some()).collect()
    }

    /// The effect that was added, at its fitted values, and how they came about; `logs` are name
    /// and SHA-256 of every file it was fitted to.
    pub fn added(
        &self,
        candidate: Candidate,
        logs: Vec<(String, String)>,
    ) -> (EffectInstance, FitRecord) {
        let own: Vec<ParameterPath> = candidate.paths().collect();
        let values = own.iter().filter_map(|path| {
            let at = self.free.iter().position(|free| free == path)?;
            Some(self.values[at].value)
        });
        let fitted = self.record(logs).about(|path| own.contains(&path));
        (candidate.instance(&values.collect::<Vec<f64>>()), fitted)
    }

    /// How all fitted values came about; `logs` as for [`added`](Self::added).
    pub fn record(&self, logs: Vec<(String, String)>) -> FitRecord {
        let values = self.free.iter().zip(&self.values);
        let signals: Vec<MeasuredSignal> =
            self.model.log.joints.iter().map(|j| j.signal()).collect();
        FitRecord {
            intervals: values
                .map(|(path, value)| (*path, value.low, value.high))
                .collect(),
            logs,
            error_before: self.error.before_rad,
            error_after: self.error.after_rad,
            error_unit: MeasuredSignal::pooled(&signals).unit().to_string(),
            horizon_s: self.horizon.seconds(),
        }
    }
}

/// Fits `free` to the training motions. The error before is that of the model as it is. `progress`
/// hears what is being done.
///
/// # Errors
/// The motions do not determine the values.
pub fn refit(
    model: &Model,
    free: &[ParameterPath],
    split: &Split,
    horizon: Option<Horizon>,
    progress: &dyn Fn(Progress),
) -> Result<Refitted, Undetermined> {
    let steps = RefitSteps::with_starts(0);
    progress(steps.fitting());
    let horizon = horizon.unwrap_or(Horizon::Whole);
    let data = FitData::new(model, split.training.clone(), horizon);
    let found = fit_staged(model, free, &data);
    let found = polish(found, &data, FitOptions::default());
    told_apart(&found)?;
    progress(steps.settling());
    finish(model, found, &data, split, horizon)
}

/// Refuses values of which the data tell only a mixture.
pub(super) fn told_apart(found: &Fit) -> Result<(), Undetermined> {
    let mixed = untold_mixture(found);
    match mixed.is_empty() {
        true => Ok(()),
        false => Err(Undetermined {
            blind: Vec::new(),
            mixed: mixed.iter().map(ToString::to_string).collect(),
        }),
    }
}

/// Adds the candidates, one after the other, and fits their values along with the model's free
/// ones, from every start value of each effect. The error before is that of the model refitted
/// without them. `progress` hears what is being done.
///
/// # Errors
/// The motions do not determine the values.
pub fn refit_with(
    model: &Model,
    candidates: &[Candidate],
    split: &Split,
    horizon: Option<Horizon>,
    progress: &dyn Fn(Progress),
) -> Result<Refitted, Undetermined> {
    let horizon = horizon.unwrap_or(Horizon::Whole);
    let data = FitData::new(model, split.training.clone(), horizon);
    let base = fit_staged(model, &model.free, &data);
    let short = data.recut(horizon.shorter(Horizon::Seconds(SCREENING_S)));
    let starts = candidates.iter().map(|candidate| candidate.starts().len());
    let steps = RefitSteps::with_starts(starts.sum());
    let (mut done, mut with, mut free) = (0, base.model.clone(), model.free.clone());
    for candidate in candidates {
        free.extend(candidate.paths().filter(|path| !model.free.contains(path)));
        let screened = candidate.starts().into_iter().map(|start| {
            progress(steps.tried(done));
            done += 1;
            let mut started = with.clone();
            started.effects.push(candidate.instance(&start));
            fit(&started, &free, &short, None, SCREENING)
        });
        let cost = |fit: &Fit| fit.residuals.cost();
        let best = screened.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        with = best.map_or(with.clone(), |best| best.model);
    }
    progress(steps.fitting());
    // Whoever goes on with this model refits the new values too.
    with.free.clone_from(&free);
    let found = fit_staged(&with, &free, &data);
    let found = polish(found, &data, FitOptions::default());
    progress(steps.settling());
    finish(&base.model, found, &data, split, horizon)
}

fn finish(
    before: &Model,
    found: Fit,
    data: &FitData,
    split: &Split,
    horizon: Horizon,
) -> Result<Refitted, Undetermined> {
    let judged = match split.held_out.as_slice() {
        [] => data.clone(),
        held_out => FitData::new(before, held_out.to_vec(), horizon).weighted_like(data),
    };
    let mut found = settle(found, data);
    if !split.held_out.is_empty() {
        found = told_by_others(found, data, &judged);
    }
    let (values, Some(_)) = fitted_values(&found, data) else {
        let blind = blind(&found, data);
        return Err(Undetermined {
            blind,
            mixed: Vec::new(),
        });
    };
    let mut windows = data.motion_windows(horizon);
    if !split.held_out.is_empty() {
        windows.extend(judged.motion_windows(horizon));
    }
    let rms_rad = |model: &Model| fit_start_states(model, &judged).rms(&judged);
    Ok(Refitted {
        values,
        error: ErrorReduction {
            quantity: MeasuredSignal::pooled(&judged.signals),
            before_rad: rms_rad(before),
            refitted_rad: None,
            after_rad: rms_rad(&found.model),
            floor_rad: judged.floor(),
            floor_interval_rad: judged.floor_interval(),
            held_out: !split.held_out.is_empty(),
            reduction: None,
        },
        free: found.free,
        windows,
        unobserved: before.log.notes(),
        converged: found.converged,
        shorter_step_s: (found.model.step_s < before.step_s).then_some(found.model.step_s),
        model: found.model,
        horizon,
    })
}

/// The free parameters whose change leaves every prediction as it was.
pub(super) fn blind(found: &Fit, data: &FitData) -> Vec<String> {
    let base = residuals(&found.model, data, &found.nodes);
    let changes_nothing = |path: &&ParameterPath| {
        let value = path.get(&found.model).unwrap_or(0.0);
        let (_, high) = path.bounds(&found.model);
        let size = 1e-3 * value.abs().max(1e-3);
        let size = if value + size > high { -size } else { size };
        let mut moved = found.model.clone();
        path.set(&mut moved, value + size) && residuals(&moved, data, &found.nodes) == base
    };
    let blind = found.free.iter().filter(changes_nothing);
    blind.map(ToString::to_string).collect()
}
