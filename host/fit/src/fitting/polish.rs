//! The end of a fit that is judged: on no stair of a law that jumps, in steps that are not too
//! long.

use super::data::FitProblem;
use super::fit::{Fit, FitOptions};
use super::jumping_law::{descend_jumping_law, descend_jumping_law_fully};
use super::step_size::{in_fine_steps, in_steps_for_values};

/// The fit, or one that leaves less: lower down the stairs of its error, and in shorter integration
/// steps. The fit must have its derivatives.
pub fn polish(found: Fit, data: &FitProblem, options: FitOptions) -> Fit {
    in_fine_steps(descend_jumping_law(found, data, options), data, options)
}

/// A polished fit, or one whose values neither its steps nor a stair move by what their intervals
/// do not allow. The fit must have its derivatives.
pub(crate) fn settle(found: Fit, data: &FitProblem) -> Fit {
    let options = FitOptions::default();
    let found = in_steps_for_values(found.resume(data, options), data, options);
    descend_jumping_law_fully(found, data, options)
}
