//! The error of a model along a whole log.

use crate::error::Result;
use crate::fitting::{FitProblem, Horizon, fit_start_states};
use crate::log::{LogRequest, read};
use crate::model::Model;
use std::path::Path;

/// Root-mean-square error of a model simulated along a whole log from fitted start states, rad.
///
/// # Errors
/// Those of reading the log.
pub fn whole_error_rad(model: &Model, log: &Path) -> Result<f64> {
    let motions = read(&[LogRequest::whole(log.to_path_buf())], &model.log)?;
    let data = FitProblem::new(model, motions, Horizon::Whole);
    Ok(fit_start_states(model, &data).rms(&data))
}
