//! What is said of a linear loop without simulating it.

use super::design::Design;
use super::error::DesignError;
use super::margins::{DesignMargins, design_margins};
use super::stiffness::{Stiffness, stiffness};
use crate::model::Model;

/// Margins and stiffness of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopFigures {
    /// Margins of the loop.
    pub margins: DesignMargins,
    /// How far it leans; none with a filter, whose estimate a lasting torque leads astray.
    pub stiffness: Option<Stiffness>,
}

impl LoopFigures {
    /// The figures of `design` for the `model` that it was made for; none of a loop that is not
    /// stable.
    ///
    /// # Errors
    /// Entries that are no numbers.
    pub fn of(model: &Model, design: &Design) -> Result<Option<LoopFigures>, DesignError> {
        let Some(margins) = design_margins(model, design)? else {
            return Ok(None);
        };
        Ok(Some(LoopFigures {
            margins,
            stiffness: match design.estimator {
                Some(_) => None,
                None => Some(stiffness(model, design)?),
            },
        }))
    }
}
