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

/// The steps of a refit: one for each start value, one for the fit from the best of them, one for
/// its values.
#[derive(Debug, Clone, Copy)]
pub(super) struct RefitSteps {
    starts: usize,
}

impl RefitSteps {
    pub fn with_starts(starts: usize) -> Self {
        RefitSteps { starts }
    }

    /// So many start values were tried.
    pub fn tried(self, starts: usize) -> Progress {
        self.at(starts, "start values")
    }

    /// All is fitted from the best of them.
    pub fn fitting(self) -> Progress {
        self.at(self.starts, "fit")
    }

    /// The values are fitted as exactly as they are stated.
    pub fn settling(self) -> Progress {
        self.at(self.starts + 1, "exact values")
    }

    fn at(self, done: usize, what: &'static str) -> Progress {
        Progress {
            done,
            total: self.starts + 2,
            what: what.into(),
        }
    }
}
