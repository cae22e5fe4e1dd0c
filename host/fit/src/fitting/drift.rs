//! Whether values differ from session to session, or from servo to servo: each log fitted by
//! itself, then a test of homogeneity (Cochran 1954, Biometrics 10, 101).

use super::data::FitProblem;
use super::fitted_value::FittedValue;
use super::horizon::Horizon;
use super::longer_windows::best_fit_in_longest_windows;
use super::refit::{Undetermined, told_apart};
use super::told_values::{ToldValues, told_values};
use super::ways::stated;
use crate::model::{Model, ParameterPath};
use crate::motion::Motion;
use rayon::prelude::*;
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

/// Chance of a false alarm among all values.
const LEVEL: f64 = 0.05;
/// Half the width of a 95 % interval, in standard errors.
const HALF_WIDTH: f64 = 1.96;

/// A log and its motions: a session, or a servo on the bench.
#[derive(Debug, Clone)]
pub struct DriftSession {
    /// Its name.
    pub name: String,
    /// Its motions.
    pub motions: Vec<Motion>,
}

/// A value as one session or one servo has it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OneValue {
    /// The session's name, or the joint's (`joint2`).
    pub of: String,
    /// Its value with the 95 % interval.
    #[serde(flatten)]
    pub fitted: FittedValue,
    /// Whether it differs by more than chance from those that agree, which are more than half.
    pub stands_out: bool,
}

/// A value of several sessions or servos.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Drift {
    /// The value's address; between servos the effect and key alone: `coulomb.torque_nm`.
    pub path: String,
    /// Unit for people.
    pub unit: String,
    /// Each session's or servo's.
    pub values: Vec<OneValue>,
    /// Their mean, weighted by their certainty.
    pub mean: f64,
    /// Probability that values which are all the same scatter as much; absent of a single one.
    pub probability: Option<f64>,
    /// Whether they differ: the probability is below 5 % over the number of values tested (Holm
    /// 1979).
    pub differ: bool,
}

/// What became of the sessions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DriftReport {
    /// Per value: how it differs between sessions.
    pub sessions: Vec<Drift>,
    /// Per effect that several joints have: how its values differ between them, all sessions
    /// together.
    pub joints: Vec<Drift>,
    /// Sessions that do not determine the values, and why.
    pub refused: Vec<(String, String)>,
    /// Sessions in which a value shows nothing beside others of its effect, and at what it is held
    /// there.
    pub held: Vec<(String, String)>,
}

/// Fits `free` to each session by itself, and compares.
pub fn drift(
    model: &Model,
    free: &[ParameterPath],
    sessions: &[DriftSession],
    horizon: Option<Horizon>,
) -> DriftReport {
    let horizon = horizon.unwrap_or(Horizon::Whole);
    let fitted = sessions.par_iter().map(|session| {
        let data = FitProblem::new(model, session.motions.clone(), horizon);
        let (found, data) = best_fit_in_longest_windows(model, free, data, horizon);
        told_apart(&found)?;
        told_values(stated(found, &data), &data)
    });
    let fitted: Vec<Result<ToldValues, Undetermined>> = fitted.collect();
    let (mut refused, mut held, mut known) = (Vec::new(), Vec::new(), Vec::new());
    for (session, told) in sessions.iter().zip(fitted) {
        let name = || session.name.clone();
        match told {
            Ok(told) => {
                held.extend(told.held.into_iter().map(|sentence| (name(), sentence)));
                known.push((name(), told.values));
            }
            Err(why) => refused.push((name(), why.to_string())),
        }
    }
    // What a session holds, it does not tell.
    let (mut paths, mut between_sessions) = (Vec::new(), Vec::new());
    for path in free {
        let address = path.to_string();
        let of = known.iter().filter_map(|(name, values)| {
            let own = values.iter().find(|value| value.path == address)?;
            Some(one(name, own))
        });
        let of: Vec<OneValue> = of.collect();
        if !of.is_empty() {
            paths.push(*path);
            between_sessions.push((address, of));
        }
    }
    let sessions = tested(between_sessions);
    DriftReport {
        joints: tested(between_joints(&paths, &sessions)),
        sessions,
        refused,
        held,
    }
}

fn one(of: &str, fitted: &FittedValue) -> OneValue {
    OneValue {
        of: of.to_string(),
        fitted: fitted.clone(),
        stands_out: false,
    }
}

/// Per effect and key that several joints have: the mean of each joint.
fn between_joints(free: &[ParameterPath], sessions: &[Drift]) -> Vec<(String, Vec<OneValue>)> {
    let mut groups: Vec<(String, Vec<OneValue>)> = Vec::new();
    for (path, drift) in free.iter().zip(sessions) {
        let ParameterPath::Effect {
            id,
            joint: Some(joint),
            ..
        } = path
        else {
            continue;
        };
        let (Some(mean), Some(first)) = (weighted(&drift.values), drift.values.first()) else {
            continue;
        };
        let reach = HALF_WIDTH * mean.error;
        let fitted = FittedValue {
            value: mean.value,
            low: mean.value - reach,
            high: mean.value + reach,
            on_bound: drift.values.iter().all(|value| value.fitted.on_bound),
            ..first.fitted.clone()
        };
        let name = format!("{id}.{}", path.key());
        let value = one(&format!("joint{}", joint + 1), &fitted);
        match groups.iter_mut().find(|(group, _)| *group == name) {
            Some((_, values)) => values.push(value),
            None => groups.push((name, vec![value])),
        }
    }
    groups.retain(|(_, values)| values.len() > 1);
    groups
}

/// A mean and its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
struct MeanWithError {
    value: f64,
    error: f64,
}

/// Standard error of a value by the longer side of its interval.
fn error(fitted: &FittedValue) -> f64 {
    (fitted.value - fitted.low).max(fitted.high - fitted.value) / HALF_WIDTH
}

/// Mean weighted by inverse variance; none of no values.
fn weighted<'a>(values: impl IntoIterator<Item = &'a OneValue>) -> Option<MeanWithError> {
    let (mut sum, mut weights) = (0.0, 0.0);
    for value in values {
        let weight = error(&value.fitted).max(1e-300).powi(-2);
        sum += weight * value.fitted.value;
        weights += weight;
    }
    (weights > 0.0).then(|| MeanWithError {
        value: sum / weights,
        error: weights.powf(-0.5),
    })
}

/// The groups with their tests; the level is shared out among all of them.
fn tested(groups: Vec<(String, Vec<OneValue>)>) -> Vec<Drift> {
    let count = groups.len();
    let mut drifts: Vec<Drift> = groups
        .into_iter()
        .map(|group| homogeneity(group, count))
        .collect();
    let mut order: Vec<usize> = (0..count).collect();
    let probability = |drift: &Drift| drift.probability.unwrap_or(1.0);
    order.sort_by(|a, b| probability(&drifts[*a]).total_cmp(&probability(&drifts[*b])));
    for (rank, index) in order.into_iter().enumerate() {
        // Once one is left to chance, so are all less certain ones.
        if probability(&drifts[index]) >= LEVEL / (count - rank) as f64 {
            break;
        }
        drifts[index].differ = true;
    }
    drifts
}

/// Standard errors between a value and the mean of the others of these; none without others.
fn departure(values: &[OneValue], of: usize, among: &[usize]) -> f64 {
    let others = among.iter().filter(|other| **other != of);
    let own = &values[of].fitted;
    weighted(others.map(|other| &values[*other])).map_or(0.0, |others| {
        let error = error(own).hypot(others.error).max(1e-300);
        (own.value - others.value).abs() / error
    })
}

/// Which values stand out from those that agree: the one farthest from the mean of the others is
/// taken away until all that are left agree, for it draws the mean of the others to itself. Where
/// no more than half agree, there is nothing to stand out from.
fn standing_out(values: &[OneValue], most: f64) -> Vec<bool> {
    let mut agree: Vec<usize> = (0..values.len()).collect();
    loop {
        let far = agree.iter().map(|of| (*of, departure(values, *of, &agree)));
        match far.max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((farthest, departure)) if departure > most => {
                agree.retain(|of| *of != farthest);
            }
            _ => break,
        }
    }
    let settled = 2 * agree.len() > values.len();
    let stands_out = |of| settled && departure(values, of, &agree) > most;
    (0..values.len()).map(stands_out).collect()
}

/// Cochran's Q of one group, and which of its values stand out.
fn homogeneity((path, mut values): (String, Vec<OneValue>), groups: usize) -> Drift {
    let mean = weighted(&values);
    let probability = mean.filter(|_| values.len() > 1).and_then(|mean| {
        let squares = values.iter().map(|value| {
            ((value.fitted.value - mean.value) / error(&value.fitted).max(1e-300)).powi(2)
        });
        let q: f64 = squares.sum();
        let freedom = (values.len() - 1) as f64;
        Some(ChiSquared::new(freedom).ok()?.sf(q))
    });
    let level = LEVEL / (groups * values.len()).max(1) as f64;
    let most = Normal::standard().inverse_cdf(1.0 - level / 2.0);
    let out = standing_out(&values, most);
    for (value, out) in values.iter_mut().zip(out) {
        value.stands_out = out;
    }
    Drift {
        unit: values
            .first()
            .map_or(String::new(), |value| value.fitted.unit.clone()),
        path,
        mean: mean.map_or(f64::NAN, |mean| mean.value),
        values,
        probability,
        differ: false,
    }
}

#[cfg(test)]
mod tests;
