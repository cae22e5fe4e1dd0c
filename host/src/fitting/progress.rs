//! How far a fit or a diagnosis has come.

use std::borrow::Cow;

/// How far a fit or a diagnosis has come, in steps of about the same length.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// Steps done.
    pub done: usize,
    /// Steps in all, unless the work ends early.
    pub total: usize,
    /// What is being done.
    pub what: Cow<'static, str>,
}

/// The steps of a refit: the fit without what is added, or the only one; those of a fit with it; and
/// one for its values.
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
        }
    }
}
