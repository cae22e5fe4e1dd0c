//! From a model to a controller: linearise at a pose, discretise, solve for gains, judge the loop.
//!
//! `equations` -> `rest` -> `linearise` -> `discretise` -> `riccati` -> `gains`; `analysis` looks at plants; `robust` makes one
//! gain for many plants.

mod discretise;
mod equations;
mod gains;
mod linearise;
mod rest;
mod riccati;
mod robust;
mod system;
mod weights;

pub use discretise::zoh;
pub use equations::Equations;
pub use gains::{Gains, dlqr, lqr};
pub use linearise::linearise;
pub use rest::{Rest, input_delay_s, upright};
pub use robust::{grown, lost_share, multi_model, spectral_radius};
pub use system::{Continuous, Discrete, poles};
