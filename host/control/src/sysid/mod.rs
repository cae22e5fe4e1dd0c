//! A servo as a black box: discrete-time models from commanded to measured speed, by the
//! prediction-error method, and static maps of what it does at rest.

mod blocks;
mod dead_zone;
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
mod supply;
mod text;

#[cfg(test)]
mod tests;

pub use blocks::{BlockMean, blocks};
pub use dead_zone::{DeadZoneMap, Inverse, Side};
pub use dynamics::{Dynamics, IntervalEstimate, Pole, dynamics, settling_samples};
pub use estimate::{Estimate, Unfitted, estimate};
pub use model::TransferModel;
pub use record::{OutputQuantity, Record, record, sampling_period_s, velocity};
pub use score::{FitScore, prediction_errors, score};
pub use select::{FittedModel, TriedStructure, select, try_all};
pub use structure::{FAMILIES, Family, Structure, structures};
pub use supply::{SupplyLine, errors as supply_errors};
pub use text::transfer_function;
