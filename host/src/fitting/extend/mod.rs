//! A model refitted, or carried on by one more effect: its values, how well they are known, and how far the
//! error falls.

mod fall;
#[cfg(test)]
mod tests;

pub use fall::{Fall, rms_rad};

use crate::diagnose::{Candidate, FittedValue};
use crate::fitting::{Data, Fit, FitOptions, Horizon, fit, intervals, longest_stable, settle};
use crate::fitting::{Node, approach, fit_staged, profiled, residuals};
use crate::log::Split;
use crate::model::{Model, ParameterPath};
use std::fmt;

/// Iterations that tell a promising start from a hopeless one.
const SCREENING: FitOptions = FitOptions {
    rough: true,
    iterations: 8,
    tolerance: 1e-3,
};

/// A refitted model.
#[derive(Debug, Clone)]
pub struct Extension {
    /// The model with its new values.
    pub model: Model,
    /// What was free: the base's parameters first, then the effect's.
    pub free: Vec<ParameterPath>,
    /// Fitted values in the order of `free`.
    pub values: Vec<FittedValue>,
    /// Error before and after.
    pub error: Fall,
    /// How long the model ran without correction.
    pub horizon: Horizon,
    /// Whether the search came to rest before its iterations ran out.
    pub converged: bool,
}

/// The motions do not determine the values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Undetermined {
    /// Parameters that change nothing in these motions; none when only a mixture of several is undetermined.
    pub blind: Vec<String>,
}

impl fmt::Display for Undetermined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.blind.as_slice() {
            [] => write!(f, "these motions do not tell the free parameters apart"),
            [one] => write!(f, "`{one}` has no effect on these motions"),
            several => write!(
                f,
                "`{}` have no effect on these motions",
                several.join("`, `")
            ),
        }
    }
}

/// Fits `free` to the training motions. The error before is that of the model as it is.
///
/// # Errors
/// The motions do not determine the values.
pub fn refit(
    model: &Model,
    free: &[ParameterPath],
    split: &Split,
    horizon: Option<Horizon>,
) -> Result<Extension, Undetermined> {
    let (data, horizon) = match horizon {
        Some(_) => training(model, split, horizon),
        // How long a run is stable depends on the values, which may be far off.
        None => {
            let whole = Data::new(model, split.training.clone(), Horizon::Whole);
            training(&approach(model, free, &whole), split, None)
        }
    };
    let found = fit_staged(model, free, &data);
    finish(model, found, &data, split, horizon)
}

/// Adds the candidate and fits its values along with the model's free ones, from every start value of the effect. The
/// error before is that of the model refitted without it. `progress` hears of starts done and starts in all.
///
/// # Errors
/// The motions do not determine the values.
pub fn extend(
    model: &Model,
    candidate: Candidate,
    split: &Split,
    horizon: Option<Horizon>,
    progress: &dyn Fn(usize, usize),
) -> Result<Extension, Undetermined> {
    let (data, horizon) = training(model, split, horizon);
    let base = fit(model, &model.free, &data, None, FitOptions::default());
    let mut free = model.free.clone();
    free.extend(candidate.paths().filter(|path| !model.free.contains(path)));

    let starts = candidate.starts();
    let mut best: Option<Fit> = None;
    for (done, start) in starts.iter().enumerate() {
        progress(done, starts.len());
        let mut with = base.model.clone();
        with.effects.push(candidate.instance(start));
        // Whoever goes on with this model refits the new values too.
        with.free.clone_from(&free);
        let tried = fit(&with, &free, &data, Some(&base.nodes), SCREENING);
        let cost = tried.residuals.cost();
        if best
            .as_ref()
            .is_none_or(|best| cost < best.residuals.cost())
        {
            best = Some(tried);
        }
    }
    progress(starts.len(), starts.len());
    let from = best.unwrap_or_else(|| base.clone());
    let options = FitOptions::default();
    let found = fit(&from.model, &free, &data, Some(&from.nodes), options);
    finish(&base.model, found, &data, split, horizon)
}

fn training(model: &Model, split: &Split, horizon: Option<Horizon>) -> (Data, Horizon) {
    let data = Data::new(model, split.training.clone(), Horizon::Whole);
    let horizon = horizon.unwrap_or_else(|| longest_stable(model, &data));
    (data.recut(horizon), horizon)
}

fn finish(
    before: &Model,
    found: Fit,
    data: &Data,
    split: &Split,
    horizon: Horizon,
) -> Result<Extension, Undetermined> {
    let Some((intervals, _)) = intervals(&found, data) else {
        return Err(Undetermined {
            blind: blind(&found, data),
        });
    };
    let intervals = profiled(&found, data, &intervals);
    let rows = found.free.iter().zip(found.values()).zip(intervals);
    let values = rows.zip(found.on_bound());
    let values = values.map(|(((path, value), interval), on_bound)| {
        FittedValue::of(*path, value, interval, on_bound)
    });
    let judged = if split.held_out.is_empty() {
        data.clone()
    } else {
        Data::new(before, split.held_out.clone(), horizon)
    };
    Ok(Extension {
        values: values.collect(),
        error: Fall {
            before_rad: rms_rad(&settle(before, &judged), &judged),
            after_rad: rms_rad(&settle(&found.model, &judged), &judged),
            floor_rad: fall::floor_rad(&judged),
            held_out: !split.held_out.is_empty(),
        },
        free: found.free,
        converged: found.converged,
        model: found.model,
        horizon,
    })
}

/// The free parameters whose change leaves every prediction as it was.
fn blind(found: &Fit, data: &Data) -> Vec<String> {
    let nodes: &[Node] = &found.nodes;
    let base = residuals(&found.model, data, nodes);
    let changes_nothing = |path: &&ParameterPath| {
        let value = path.get(&found.model).unwrap_or(0.0);
        let (_, high) = path.bounds(&found.model);
        let size = 1e-3 * value.abs().max(1e-3);
        let mut moved = found.model.clone();
        let to = if value + size > high {
            value - size
        } else {
            value + size
        };
        path.set(&mut moved, to) && residuals(&moved, data, nodes) == base
    };
    let blind = found.free.iter().filter(changes_nothing);
    blind.map(ToString::to_string).collect()
}
