//! From a model to a controller: linearise at a pose, discretise, solve for gains, judge the loop.
//!
//! `operating_point` -> `linearise` -> `discretise`; `riccati` -> `gains`, `estimator`; `eigen` ->
//! `controllability`, `zeros` look at plants; `quantise` -> `fixed_law` is what
//! ships; `design` is all of it as one value, `export` writes that, `plan` reads its law back;
//! `robust` makes one gain for many plants; [`controllers`] lists all the laws that there are.

mod controllability;
pub mod controllers;
mod cost_weights;
mod descent;
mod design;
mod discretise;
mod eigen;
mod error;
mod estimator;
pub mod export;
mod fixed_law;
mod gains;
mod integral;
mod joint_slope;
mod linearise;
mod loop_figures;
mod margins;
mod omitted;
mod operating_point;
mod plan;
mod pose;
mod pose_text;
mod quantise;
mod request;
mod riccati;
mod rigid;
mod robust;
mod signal;
mod stationary;
mod stiffness;
mod system;
mod unsolvable;
mod weight;
mod weights;
mod zeros;

pub use crate::model::{default_pose, upright};
pub use controllability::{Controllability, controllability, observability};
pub use cost_weights::CostWeights;
pub use design::{Design, Estimation, FixedDesign};
pub use discretise::{zoh, zoh_each};
pub use eigen::{Mode, poles};
pub use error::DesignError;
pub use estimator::{Compensator, Estimator, kalman, lqg, rounding_variance};
pub use fixed_law::{FixedLaw, Loss};
pub use gains::{Gains, continuous_period_s, dlqr, lqr};
pub use integral::{Integral, Sums};
pub use linearise::{Linearisation, linearise};
pub use loop_figures::LoopFigures;
pub use margins::{
    DesignMargins, DiskMargin, LoopMargin, Margins, OpenLoop, Peak, SingularValues, SupplyRange,
    design_margins, singular_values,
};
pub use omitted::{NonSmooth, OmittedEffect};
pub use operating_point::input_delay_s;
pub use plan::StateFeedbackPlan;
pub use pose::balanced;
pub use pose_text::PoseText;
pub use quantise::{Format, Ranges, quantise};
pub use request::{Readings, Request, Sensors, Time};
pub use robust::{multi_model, multi_model_continuation, spectral_radius};
pub use signal::Signal;
pub use stationary::{Beyond, Stationary};
pub use stiffness::{Stiffness, stiffness, torque_inputs};
pub use system::{Continuous, Discrete, rows};
pub use unsolvable::{PlantMode, RiccatiRole, StuckMode};
pub use weight::Weight;
pub use zeros::transmission_zeros;
