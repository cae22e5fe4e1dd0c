//! The result of a diagnosis, as plain values for every writer: text, JSON, HTML.

use crate::fitting::Interval;
use crate::model::ParameterPath;
use serde::Serialize;

/// What a diagnosis may end in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The model already explains the measurement; no candidate gains anything worth naming.
    Nominal,
    /// The missing effects are known.
    Named,
    /// Several sets of effects explain the measurement equally well.
    Ambiguous,
    /// Something is missing and no candidate explains it.
    Unexplained,
    /// The data can't answer the question.
    Unfit,
}

/// A value with its 95 % interval.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FittedValue {
    /// Address in the model: `coulomb@1.torque_nm`.
    pub path: String,
    /// Key alone: `torque_nm`.
    pub key: String,
    /// Unit for people.
    pub unit: String,
    /// Fitted value.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
    /// Whether the value lies on a bound: a warning, not a result.
    pub on_bound: bool,
}

impl FittedValue {
    /// The value at this address.
    pub fn of(path: ParameterPath, value: f64, interval: Interval, on_bound: bool) -> Self {
        FittedValue {
            path: path.to_string(),
            key: path.key().to_string(),
            unit: path.unit().to_string(),
            value,
            low: interval.low,
            high: interval.high,
            on_bound,
        }
    }
}

/// An effect with its fitted values.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FittedEffect {
    /// Id in the library.
    pub kind: String,
    /// Name for people.
    pub title: String,
    /// Joint counted from 1; absent when it acts on the whole rig.
    pub joint: Option<usize>,
    /// Its values.
    pub parameters: Vec<FittedValue>,
}

/// Root-mean-square error before and after, on held-out motions where there are any.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ErrorFall {
    /// Unit of the figures: `rad`.
    pub unit: String,
    /// With the model as it is, refitted.
    pub before: f64,
    /// With the named effects added.
    pub after: f64,
    /// What noise and resolution alone leave.
    pub floor: f64,
    /// Whether the figures are of motions that took no part in the fit.
    pub held_out: bool,
    /// 95 % interval of the relative fall, 1 - after / before, by block bootstrap: its lower end.
    pub fall_low: f64,
    /// Its upper end.
    pub fall_high: f64,
}

/// A rival explanation that the data do not rule out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Alternative {
    /// Its effects.
    pub effects: Vec<FittedEffect>,
    /// Error it leaves, in the unit of [`ErrorFall`].
    pub error: f64,
}

/// A candidate that was tried and not chosen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RuledOut {
    /// Effects tried together, as `id@joint`.
    pub set: Vec<String>,
    /// Error it leaves on training motions, rad.
    pub training_error: f64,
    /// Error it leaves on held-out motions, rad, where it came that far.
    pub held_out_error: Option<f64>,
    /// Change of the Bayesian information criterion against the base model; negative is better.
    pub bic_change: f64,
    /// Why it was not chosen, in words.
    pub why: String,
}

/// What is left after the best explanation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Remainder {
    /// Share of the remaining squared error above the floor that a free-form term could still gain.
    pub explainable_share: f64,
    /// 95 % lower limit of that share.
    pub explainable_low: f64,
    /// Which variables the free form used most, in words.
    pub shape: String,
}

/// Error of one motion before and after.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotionError {
    /// The motion.
    pub motion: String,
    /// Whether it was held out.
    pub held_out: bool,
    /// Root-mean-square error of the base model, rad.
    pub before: f64,
    /// Root-mean-square error with the effects added, rad.
    pub after: f64,
}

/// Everything a diagnosis says.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Diagnosis {
    /// The verdict.
    pub verdict: Verdict,
    /// Effects that are missing: all of them when named, the best set when ambiguous, a partial set when unexplained.
    pub effects: Vec<FittedEffect>,
    /// Error before, after and floor.
    pub error: ErrorFall,
    /// Sets that do as well, when ambiguous.
    pub alternatives: Vec<Alternative>,
    /// Base values refitted along.
    pub base: Vec<FittedValue>,
    /// What was tried and ruled out, best first.
    pub ruled_out: Vec<RuledOut>,
    /// What remains.
    pub remainder: Option<Remainder>,
    /// Per motion.
    pub motions: Vec<MotionError>,
    /// Pairs of parameters the data hardly tell apart: addresses and correlation.
    pub collinear: Vec<(String, String, f64)>,
    /// Sentences for a student: what is missing, its size, how the error falls.
    pub summary: Vec<String>,
    /// What to do next.
    pub next: Vec<String>,
    /// Things to be wary of: values on bounds, shams that rank, data warnings.
    pub warnings: Vec<String>,
    /// Seconds of one window on which the judgement rests; absent for whole motions.
    pub horizon_s: Option<f64>,
}
