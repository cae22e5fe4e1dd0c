//! A model refitted, alone or with one more effect: its values, how well they are known, and how
//! far the error is reduced.

#[cfg(test)]
mod tests;

use super::added::AddedEffects;
use super::base_parameters::{BaseParameters, base_parameters, values_to_hold};
use super::data::FitProblem;
use super::error_reduction::ErrorReduction;
use super::fit::{Fit, FitOptions};
use super::fitted_value::FittedValue;
use super::horizon::Horizon;
use super::jumping_law::choose_by_other_motions;
use super::longer_windows::best_fit_in_longest_windows;
use super::mixture::untold_mixture;
use super::polish::polish;
use super::progress::{Progress, RefitSteps};
use super::solve::fit_start_states;
use super::told_values::{ToldValues, told_values};
use super::ways::{best_fit, stated};
use super::windows::MotionWindow;
use crate::fitting::Candidate;
use crate::model::edit::FitRecord;
use crate::model::{EffectInstance, MeasuredSignal, Model, ParameterPath};
use crate::motion::Split;
use std::cell::Cell;

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
    /// The same of the motions that were fitted, rad.
    pub fitted_rad: [f64; 2],
    /// The integration step, s, where the logs ask for a shorter one than the model's own.
    pub shorter_step_s: Option<f64>,
    /// How long the model ran without correction at most.
    pub horizon: Horizon,
    /// How long the windows of each motion are, those held out last.
    pub windows: Vec<MotionWindow>,
    /// What the logs cannot observe of the joints' motion, a sentence each.
    pub unobserved: Vec<String>,
    /// Values that the motions tell only together.
    pub together: BaseParameters,
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
    /// Parameters to hold at what is known of them, with which these motions tell the others.
    pub hold: Vec<String>,
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
        // What was held, its fitted model has alone.
        let values = own.iter().filter_map(|path| {
            let at = self.free.iter().position(|free| free == path);
            at.map_or(path.get(&self.model), |at| Some(self.values[at].value))
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
    let steps = RefitSteps::new(0);
    progress(steps.fitting());
    let horizon = horizon.unwrap_or(Horizon::Whole);
    let data = FitProblem::new(model, split.training.clone(), horizon);
    let (found, data) = best_fit_in_longest_windows(model, free, data, horizon);
    told_apart(&found)?;
    progress(steps.settling());
    let refit = Refit {
        before: fit_start_states(model, &data),
        data,
        split,
        horizon,
    };
    refit.finish(found)
}

/// Refuses values of which the data tell only a mixture.
pub(super) fn told_apart(found: &Fit) -> Result<(), Undetermined> {
    let mixed = untold_mixture(found);
    if mixed.is_empty() {
        Ok(())
    } else {
        Err(Undetermined {
            blind: Vec::new(),
            mixed: mixed.iter().map(ToString::to_string).collect(),
            hold: values_to_hold(found)
                .iter()
                .map(ToString::to_string)
                .collect(),
        })
    }
}

/// Why effects are not added.
#[derive(Debug, Clone, PartialEq)]
pub enum NotAdded {
    /// The motions do not determine the values.
    Undetermined(Undetermined),
    /// The fit found no values with which the motions it was fitted to leave less than without the
    /// effects, by what shows. The figures are of those motions.
    NotBetter(ErrorReduction),
}

/// Share of the error that effects leave at most: what lowers it by less than a thousandth, a value
/// at which the effect vanishes for one, does not show.
pub(super) const MOST_LEFT: f64 = 0.999;

/// Adds the candidates, and fits their values along with the model's free ones. The error before is
/// that of the model refitted without them; on the motions fitted none after it is larger.
/// `progress` hears what is being done.
///
/// # Errors
/// As [`NotAdded`] says.
pub fn refit_with(
    model: &Model,
    candidates: &[Candidate],
    split: &Split,
    horizon: Option<Horizon>,
    progress: &dyn Fn(Progress),
) -> Result<Refitted, NotAdded> {
    refit_from(model, candidates, &[], split, horizon, progress)
}

/// The same from values that are known already, of the effects and of what is free beside them: on
/// the motions fitted none after it is larger than with these.
///
/// # Errors
/// As [`refit_with`].
pub fn refit_from(
    model: &Model,
    candidates: &[Candidate],
    start: &[(ParameterPath, f64)],
    split: &Split,
    horizon: Option<Horizon>,
    progress: &dyn Fn(Progress),
) -> Result<Refitted, NotAdded> {
    let horizon = horizon.unwrap_or(Horizon::Whole);
    let data = FitProblem::new(model, split.training.clone(), horizon);
    let mut free = model.free.clone();
    let own = candidates
        .iter()
        .flat_map(|c| c.paths().collect::<Vec<_>>());
    free.extend(own.filter(|path| !model.free.contains(path)));
    let added = AddedEffects {
        model,
        candidates,
        free: &free,
        data: &data,
        start,
    };
    let steps = RefitSteps::new(added.steps());
    progress(steps.fitting());
    let options = FitOptions::default();
    let base = polish(best_fit(model, &model.free, &data), &data, options);
    progress(steps.tried(0));
    let done = Cell::new(0);
    let mut found = added.fitted(&base, horizon, &|| {
        done.set(done.get() + 1);
        progress(steps.tried(done.get()));
    });
    // Whoever goes on with this model refits the new values too.
    found.model.free.clone_from(&free);
    progress(steps.settling());
    let is_better = found.residuals.cost() < MOST_LEFT.powi(2) * base.residuals.cost();
    let refit = Refit {
        before: base,
        data,
        split,
        horizon,
    };
    if is_better {
        refit.finish(found).map_err(NotAdded::Undetermined)
    } else {
        Err(NotAdded::NotBetter(refit.error_on_fitted(&found)))
    }
}

/// What a fit is of, and what it is compared with.
struct Refit<'a> {
    /// The fit that leaves the error before.
    before: Fit,
    data: FitProblem,
    split: &'a Split,
    horizon: Horizon,
}

impl Refit<'_> {
    /// States the values of a fit, with their intervals, and the errors before and after: on the
    /// motions held out where there are any.
    fn finish(self, found: Fit) -> Result<Refitted, Undetermined> {
        let data = &self.data;
        let model = &self.before.model;
        let held_out = (!self.split.held_out.is_empty()).then(|| {
            let held_out = self.split.held_out.clone();
            FitProblem::new(model, held_out, self.horizon).weighted_like(data)
        });
        let mut found = stated(found, data);
        if let Some(judged) = &held_out {
            found = choose_by_other_motions(found, data, judged);
        }
        let mut unobserved = model.log.notes();
        let ToldValues {
            fit: found,
            values,
            held,
        } = told_values(found, data)?;
        unobserved.extend(held);
        let fitted = self.error_on_fitted(&found);
        let rms_rad = |model: &Model, data: &FitProblem| fit_start_states(model, data).rms(data);
        let mut windows = data.motion_windows(self.horizon);
        windows.extend(
            held_out
                .iter()
                .flat_map(|held_out| held_out.motion_windows(self.horizon)),
        );
        Ok(Refitted {
            values,
            fitted_rad: [fitted.before_rad, fitted.after_rad],
            error: match &held_out {
                None => fitted,
                Some(judged) => ErrorReduction {
                    before_rad: rms_rad(model, judged),
                    after_rad: rms_rad(&found.model, judged),
                    held_out: true,
                    ..fitted
                },
            },
            together: base_parameters(model, &found, data),
            free: found.free,
            windows,
            unobserved,
            converged: found.converged,
            shorter_step_s: (found.model.step_s < model.step_s).then_some(found.model.step_s),
            model: found.model,
            horizon: self.horizon,
        })
    }

    /// Errors on the motions that were fitted: of both in the same windows.
    fn error_on_fitted(&self, found: &Fit) -> ErrorReduction {
        ErrorReduction {
            quantity: MeasuredSignal::pooled(&self.data.signals),
            before_rad: self.before.rms(&self.data),
            refitted_rad: None,
            after_rad: found.rms(&self.data),
            floor_rad: self.data.floor(),
            floor_interval_rad: self.data.floor_interval(),
            held_out: false,
            reduction: None,
        }
    }
}
