//! Fitting a model's free parameters to measured motions by multiple shooting.

mod broyden;
mod cluster;
mod covariance;
mod data;
mod extend;
mod fit;
mod horizon;
mod jacobian;
mod node;
mod noise;
mod normal;
mod profile;
mod projector;
mod residual;
mod search;
mod staged;
mod step;
mod student;

pub use covariance::{Interval, intervals};
pub use data::{Data, Horizon, Window};
pub use extend::{Extension, Fall, Undetermined, extend, refit, rms_rad};
pub use fit::{Fit, FitOptions, fit, settle};
pub use horizon::longest_stable;
pub use node::Node;
pub use noise::{found_resolution_rad, noise_rad};
pub use profile::profiled;
pub use projector::Projector;
pub use residual::{Residuals, residuals};
pub use staged::{approach, fit_staged};
pub(crate) use student::quantile_975;
