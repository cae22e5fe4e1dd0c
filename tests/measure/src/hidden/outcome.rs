//! What was said of one case, as it is kept in a line of the outcomes' file.

use super::case::{Case, Truth};
use super::family::Family;
use serde::{Deserialize, Serialize};

/// A value of a hidden effect beside its interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Value {
    /// Effect and key: `coulomb@1.torque_nm`.
    pub path: String,
    /// The truth.
    pub true_value: f64,
    /// What was fitted; none when the library's effect has no such value.
    pub estimate: Option<f64>,
    /// The 95 % interval.
    pub interval: Option<(f64, f64)>,
    /// Whether the truth lies in it.
    pub covered: bool,
}

/// What an answer is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// Exactly what is hidden was named; where nothing is hidden, nothing was; where the library
    /// lacks it, the answer is that it does.
    Right,
    /// What is hidden is one of the sets that cannot be told apart.
    Equivalent,
    /// Something else was named, or several sets without the truth.
    Wrong,
    /// Something is missing, none of the library's.
    Unexplained,
    /// Nothing is missing, though something is.
    Nominal,
    /// The data cannot tell.
    Unfit,
}

/// What a diagnosis said.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Who made the logs.
    pub truth: Truth,
    /// The family.
    pub family: Family,
    /// Kinds of the effects that were to be hidden.
    pub kinds: Vec<String>,
    /// Seed of the rig.
    pub seed: u64,
    /// What was hidden: `coulomb@1`.
    pub hidden: Vec<String>,
    /// The verdict, in its own word.
    pub verdict: String,
    /// Sets that were given, the best first.
    pub sets: Vec<Vec<String>>,
    /// What that is worth.
    pub answer: Answer,
    /// Error on the held-out motions before, rad.
    pub before_rad: Option<f64>,
    /// The same with what was found.
    pub after_rad: Option<f64>,
    /// The same of the true model, where the library can write it.
    pub true_rad: Option<f64>,
    /// The hidden effects' values, where exactly those effects were named.
    pub values: Vec<Value>,
    /// How long the diagnosis took, s.
    pub seconds: f64,
    /// Version of the project that was measured, as in [`crate::measured::Provenance`].
    pub version: String,
}

impl Outcome {
    /// Whether exactly the hidden effects were named, or it was said that nothing is missing, or
    /// that the library lacks what is.
    pub fn is_right(&self) -> bool {
        self.answer == Answer::Right
    }

    /// The hidden values that were fitted; one that was named as a value of the file, as a stall
    /// torque for the scale of torques, has no interval here.
    pub fn fitted(&self) -> impl Iterator<Item = &Value> {
        self.values.iter().filter(|value| value.interval.is_some())
    }

    /// Held-out error against the true model's.
    pub fn ratio(&self) -> Option<f64> {
        Some(self.after_rad? / self.true_rad?)
    }

    /// Whether this is the outcome of that case.
    pub fn is_of(&self, case: &Case) -> bool {
        (self.truth, self.family, self.seed) == (case.truth, case.family, case.seed)
            && self.kinds == case.hidden
    }
}
