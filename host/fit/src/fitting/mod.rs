//! Fitting a model's free parameters to measured motions by multiple shooting.
//!
//! The solver is our own. With n joints, W windows and P free parameters there are P + 3 n W
//! unknowns, and a general least-squares solver (the crate `levenberg-marquardt`) asks for the
//! derivatives of each. A start state touches its own window alone: all windows are moved at once,
//! so that P + 3 n simulations make the whole Jacobian, and eliminating the start states leaves a
//! system of P unknowns (`normal`).

mod add;
mod added;
mod assumed;
mod base_parameters;
mod before_log;
mod broyden;
mod candidate;
mod cluster;
mod covariance;
mod cut;
mod data;
mod drift;
mod error_reduction;
mod fit;
mod fitted_value;
mod free;
mod growth;
mod halt;
mod horizon;
mod information;
mod initial_guess;
mod jacobian;
mod jumping_law;
mod least_horizon;
mod levenberg_marquardt;
#[cfg(test)]
mod log_tests;
mod longer_windows;
mod mixture;
mod motion_start;
mod noise;
mod normal;
mod polish;
mod prior;
mod profile;
mod progress;
mod projector;
#[cfg(test)]
mod rate_tests;
mod refit;
mod residual;
mod search_windows;
#[cfg(test)]
mod sensor_tests;
mod solve;
mod staged;
mod step;
mod step_size;
mod student;
mod told_values;
mod ways;
mod window_start;
mod windows;

pub use add::{
    Addition, Unhelpful, add_effects, add_effects_from, candidates_named, with_refitted,
};
pub use base_parameters::{BaseParameter, BaseParameters};
pub use candidate::{Candidate, effect_ids, effect_named};
pub use covariance::{Interval, intervals, intervals_of};
pub use data::FitProblem;
pub use drift::{Drift, DriftReport, DriftSession, OneValue, drift};
pub use error_reduction::ErrorReduction;
pub use fit::{Fit, FitOptions};
pub use fitted_value::locally_fitted_values;
pub use fitted_value::{FittedValue, fitted_values};
pub use free::{free_parameters, freed};
pub use halt::{Abandoned, StopSwitch};
pub use halt::{Halt, Halted};
pub use horizon::{Horizon, Window};
pub use information::Information;
pub use initial_guess::{
    InitialGuess, PredictionChange, ProjectedResidual, Sizes, change, changes, changes_like,
};
pub use jumping_law::{choose_by_other_motions, descend_jumping_law};
pub use least_horizon::HorizonTooShort;
pub use longer_windows::best_fit_in_longest_windows;
pub use noise::{Noise, estimated_resolution, noise};
pub use polish::polish;
pub use profile::profile_intervals;
pub use progress::{BestSoFar, Progress};
pub use projector::Projector;
pub use refit::{NotAdded, Refitted, Undetermined, refit, refit_from, refit_with};
pub use residual::{Residuals, predicted, residuals};
pub use search_windows::{enough_to_search, is_followed, search_horizons};
pub use solve::{fit, fit_start_states, fit_start_states_roughly, guessed_window_starts};
pub use step_size::coarsened;
pub use student::quantile_975;
pub use ways::{best_fit, stated, stated_from};
pub use window_start::WindowStart;
pub use windows::{MotionWindow, in_windows};
