//! Why no design follows from a model, weights and timing that are well formed.

use super::unsolvable::StuckMode;
use crate::error::{Error, Problem};
use std::fmt;

/// What stands in the way of a design: a kind for each that somebody acts on.
///
/// As [`Error::Design`], which holds it, it ends a command with exit code 3.
#[derive(Debug, Clone, PartialEq)]
pub enum DesignError {
    /// The request's own numbers, whatever the model is.
    Request(Problem),
    /// Model, weights and timing together.
    Model(Problem),
    /// A mode of the plant, which gets the name of its state where that is known.
    Mode(Box<StuckMode>),
    /// Gains exist, and no longer stabilise in fixed point.
    Rounded(Problem),
}

impl DesignError {
    /// The request's own numbers make no design, whatever the model is.
    pub(super) fn request(what: impl Into<String>, remedy: impl Into<String>) -> DesignError {
        DesignError::Request(Problem::new(what, remedy))
    }

    /// No design follows from model, weights and timing together.
    pub(super) fn model(what: impl Into<String>, remedy: impl Into<String>) -> DesignError {
        DesignError::Model(Problem::new(what, remedy))
    }

    /// What was found, and what mends it.
    pub fn problem(&self) -> Problem {
        match self {
            DesignError::Request(problem)
            | DesignError::Model(problem)
            | DesignError::Rounded(problem) => problem.clone(),
            DesignError::Mode(stuck) => stuck.problem(),
        }
    }
}

impl fmt::Display for DesignError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.problem().what)
    }
}

impl std::error::Error for DesignError {}

impl From<DesignError> for Error {
    fn from(error: DesignError) -> Error {
        Error::Design {
            problem: error.problem(),
            in_request: matches!(error, DesignError::Request(_)),
        }
    }
}
