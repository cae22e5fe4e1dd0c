//! A servo as a black box: discrete-time models from commanded to measured speed, by the prediction-error method,
//! and static maps of what it does at rest.

mod dynamics;
mod estimate;
pub mod generate;
mod model;
pub mod polynomial;
mod record;
mod score;
mod select;
mod start;
mod structure;

#[cfg(test)]
mod tests;

pub use dynamics::{Dynamics, Known, Pole, dynamics, settling_samples};
pub use estimate::{Estimate, Unfitted, estimate};
pub use model::TransferModel;
pub use record::{Output, Record, record, sampling_period_s, velocity};
pub use score::{Score, prediction_errors, score};
pub use select::{Fitted, Trial, select, try_all};
pub use structure::{FAMILIES, Family, Structure, structures};
