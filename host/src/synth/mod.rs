//! From a model to a controller: linearise at a pose, discretise, solve for gains, judge the loop.
//!
//! `equations` -> `rest` -> `linearise` -> `discretise` -> `riccati` -> `gains`; `analysis` looks at plants.

mod discretise;
mod equations;
mod gains;
mod linearise;
mod rest;
mod riccati;
mod system;
mod weights;

pub use discretise::zoh;
pub use equations::Equations;
pub use gains::{Gains, dlqr, lqr};
pub use linearise::linearise;
pub use rest::{Rest, input_delay_s, upright};
pub use system::{Continuous, Discrete, poles};
