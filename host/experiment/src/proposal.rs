//! What a proposal says, as plain values for every writer: text and JSON.

use super::condition::Condition;
use crate::diagnose::{FittedEffect, Verdict};
use crate::excite::ExcitationKind;
use crate::motion::Motion;
use serde::Serialize;

/// An explanation by name.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RivalName {
    /// Its effects, as `handstand add` takes them.
    pub effects: Vec<String>,
    /// Its values of the model file.
    pub values: Vec<String>,
    /// All of it, for people.
    pub name: String,
}

/// How far an experiment puts two explanations apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Separation {
    /// The two, counted from 0 in the order of the rivals.
    pub rivals: (usize, usize),
    /// Distance after either has been refitted to what the other predicts, in standard errors.
    pub standard_errors: f64,
    /// Whether that is enough for a diagnosis to name one of them.
    pub parted: bool,
}

/// A motion under a condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProposedExperiment {
    /// Kinds of motion, in the order in which they are played.
    pub motions: Vec<ExcitationKind>,
    /// Duration, s.
    pub seconds: f64,
    /// Samples per second.
    pub hz: f64,
    /// Share of the allowed ranges that its goals use.
    pub width: f64,
    /// What a person sets.
    pub condition: Condition,
    /// The same as sentences.
    pub instructions: Vec<String>,
    /// Times, inputs, and what the first explanation predicts.
    #[serde(skip)]
    pub motion: Motion,
}

/// A value of the model file that is measured by itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasuredValue {
    /// Its address.
    pub path: String,
    /// How.
    pub instruction: String,
}

/// How much tighter an experiment makes a value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TightenedValue {
    /// Its address.
    pub path: String,
    /// Its unit.
    pub unit: String,
    /// Its value with the logs there are.
    pub value: f64,
    /// Its standard error with them.
    pub standard_error_before: f64,
    /// The same with the experiment too.
    pub standard_error_after: f64,
}

/// The experiment to do next, and what it is expected to give.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExperimentProposal {
    /// Verdict of the diagnosis that it follows; absent where values were named to be tightened.
    pub verdict: Option<Verdict>,
    /// The explanations that are left, or the one whose values are tightened.
    pub rivals: Vec<RivalName>,
    /// The experiment; absent where none within the limits helps.
    pub experiment: Option<ProposedExperiment>,
    /// What it parts.
    pub separations: Vec<Separation>,
    /// Pairs, counted from 0, that no simulated experiment would part by one standard error: they
    /// are one law within the limits.
    pub alike: Vec<(usize, usize)>,
    /// What it tightens.
    pub values: Vec<TightenedValue>,
    /// Values to be measured by themselves, where no motion parts explanations.
    pub measure: Vec<MeasuredValue>,
    /// Experiments that were simulated.
    pub simulated: usize,
    /// Those that stay within the limits.
    pub within_limits: usize,
}

impl RivalName {
    /// The name of these effects and values.
    pub(super) fn of(effects: &[FittedEffect], values: &[String]) -> RivalName {
        let effects: Vec<String> = effects.iter().map(FittedEffect::address).collect();
        let all: Vec<&str> = effects.iter().chain(values).map(String::as_str).collect();
        let name = if all.is_empty() {
            "the model with its free values refitted".to_string()
        } else {
            all.join(" + ")
        };
        RivalName {
            effects,
            values: values.to_vec(),
            name,
        }
    }
}

impl ExperimentProposal {
    /// Pairs of explanations that the experiment does not part, by name.
    pub fn unparted(&self) -> impl Iterator<Item = (&str, &str)> {
        let pairs = self.separations.iter().filter(|pair| !pair.parted);
        pairs.map(|pair| {
            let (a, b) = pair.rivals;
            (self.rivals[a].name.as_str(), self.rivals[b].name.as_str())
        })
    }

    /// Whether every explanation is one law with every other.
    pub fn all_alike(&self) -> bool {
        let rivals = self.rivals.len();
        rivals > 1 && self.alike.len() == rivals * (rivals - 1) / 2
    }

    /// Whether it says what to do.
    pub fn helps(&self) -> bool {
        self.experiment.is_some() || !self.measure.is_empty()
    }
}
