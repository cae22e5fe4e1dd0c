//! How far a fit or a diagnosis has come.

use crate::model::MeasuredSignal;
use crate::output::number::short;
use std::borrow::Cow;
use std::fmt;

/// How far a fit or a diagnosis has come, in steps of about the same length.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// Steps done; of one work it never falls.
    pub done: usize,
    /// Steps in all, unless the work ends early.
    pub total: usize,
    /// What is being done.
    pub what: Cow<'static, str>,
    /// The best explanation so far, of a diagnosis that has one.
    pub best: Option<BestSoFar>,
    /// At most so long the work goes on, s, if its steps take as long as those before; absent while
    /// that is not known.
    pub left_s: Option<f64>,
}

/// The best explanation that a diagnosis has found so far; nothing of it is judged yet.
#[derive(Debug, Clone, PartialEq)]
pub struct BestSoFar {
    /// Its effects as `coulomb@1`, or its values' addresses; none for the model as it is.
    pub names: Vec<String>,
    /// Root-mean-square error of the model as given, rad (of slides m), on the motions that decide.
    pub before_rad: f64,
    /// With the explanation.
    pub error_rad: f64,
    /// What resolution and noise alone leave.
    pub floor_rad: f64,
    /// What the errors are errors of.
    pub quantity: MeasuredSignal,
}

/// "coulomb@1 + delay@1: 3.21 of 41.2 mrad, floor 1.50".
impl fmt::Display for BestSoFar {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [before, error, floor] =
            [self.before_rad, self.error_rad, self.floor_rad].map(|rad| short(1e3 * rad));
        let names = match self.names.as_slice() {
            [] => "the model as it is".to_string(),
            names => names.join(" + "),
        };
        let milli = self.quantity.milli();
        write!(f, "{names}: {error} of {before} {milli}, floor {floor}")
    }
}

/// The steps of a refit: the fit without what is added, or the only one; those of a fit with it;
/// and one for its values.
#[derive(Debug, Clone, Copy)]
pub(super) struct RefitSteps {
    with: usize,
}

impl RefitSteps {
    /// With so many steps of the fit with what is added.
    pub fn new(with: usize) -> Self {
        RefitSteps { with }
    }

    /// The fit without what is added, or the only one.
    pub fn fitting(self) -> Progress {
        self.at(0, "fit")
    }

    /// So many steps with what is added are done.
    pub fn tried(self, steps: usize) -> Progress {
        self.at(1 + steps.min(self.with), "fit from several starts")
    }

    /// The values are fitted as exactly as they are stated.
    pub fn settling(self) -> Progress {
        self.at(1 + self.with, "exact values")
    }

    fn at(self, done: usize, what: &'static str) -> Progress {
        Progress {
            done,
            total: self.with + 2,
            what: what.into(),
            best: None,
            left_s: None,
        }
    }
}
