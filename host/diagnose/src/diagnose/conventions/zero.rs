//! A wrong zero, fitted with its interval where the search found it by steps.

use super::correction::{Correction, LogColumn, is_regulated};
use super::rating::ModelReading;
use super::search::{SAMPLES, affordable};
use crate::effects::named;
use crate::fitting::{Candidate, FitOptions, fit, free_parameters, locally_fitted_values};
use crate::model::{Model, effect_on};
use crate::motion::{Motion, excerpts};

/// Iterations of the fit, which begins near the zero.
const ITERATIONS: usize = 25;

/// What to add to the offsets of a joint's columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedZero {
    /// The likeliest, rad or m.
    pub added: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
}

/// The zero of a correction fitted together with the model's free values; none of what is no zero,
/// and of an angle whose servo holds it by another sensor, for what that one reads is not logged.
pub(super) fn fitted(
    correction: &Correction,
    model: &Model,
    motions: &[Motion],
) -> Option<FittedZero> {
    let Correction::Offset(columns, added) = correction else {
        return None;
    };
    let joint = columns.iter().find_map(|column| match column {
        LogColumn::Position(joint) => Some(*joint),
        _ => None,
    })?;
    if is_regulated(model, joint) && correction.calibrates().is_none() {
        return None;
    }
    let motions = correction.reread(model, &excerpts(motions, affordable(SAMPLES, model)));
    let mut model = correction.applied(model);
    let rest = Candidate {
        effect: effect_on(named("encoder_zero")?, Some(joint), &model.joints)?,
        joint: Some(joint),
    };
    if rest.in_model(&model) {
        return None;
    }
    model.effects.push(rest.instance(&[0.0]));
    let mut free: Vec<_> = rest.paths().collect();
    free.extend(free_parameters(&model, &[]).unwrap_or_default());
    let data = ModelReading::new(model.clone(), motions).data;
    let fit = fit(
        &model,
        &free,
        &data,
        None,
        FitOptions::iterations(ITERATIONS),
    );
    let (values, _) = locally_fitted_values(&fit, &data);
    let rest = values.first()?;
    let of_rest = |value: f64| added - value;
    let interval = [of_rest(rest.high), of_rest(rest.low)];
    interval
        .iter()
        .all(|end| end.is_finite())
        .then_some(FittedZero {
            added: of_rest(rest.value),
            interval,
        })
}
