//! Control laws for the handstand, one file each, designed with what a designer can know.
//!
//! `design_model` (what is known) -> designs ([`DESIGNS`]) ->
//! [`Controller`](crate::sim::closed_loop::Controller). The studies try them. Adding a controller
//! is one file and one line in [`DESIGNS`].

mod best;
mod board_timing;
mod compensator_law;
mod dead_zone;
mod design_model;
mod fixed_point;
mod given;
mod info;
mod integral;
mod linear_law;
mod lqg;
mod observed;
mod offset;
mod on_board;
mod paper;
mod plant;
mod regulator;
mod robust;
mod servo;
mod sliding;

pub use board_timing::BoardTiming;
pub use compensator_law::CompensatorLaw;
pub use design_model::DesignModel;
pub use fixed_point::FixedPointFeedback;
pub use given::GivenGains;
pub use info::{ControllerDesign, ControllerInfo, Speeds};
pub use linear_law::LinearLaw;
pub use observed::ObservedDesign;
pub use on_board::{OnBoard, board_plant};
pub use robust::{MASS_ERROR, MultiModel, WEIGHT};
pub use servo::{ServoLag, ThroughServos};

/// Every controller, plainest first.
pub const DESIGNS: &[&dyn ControllerDesign] = &[
    &paper::PLAIN,
    &paper::DIFFERENCED,
    &paper::COMPENSATED,
    DEFAULT,
    &dead_zone::DeadZoneInverse,
    &integral::Integral,
    &offset::OFFSET_OBSERVER,
    &lqg::LQG,
    &servo::SERVO_MODEL,
    &sliding::Sliding,
    &sliding::OBSERVED,
    &robust::Robust,
    &best::BEST,
];

/// The controller of a study that names none.
pub const DEFAULT: &dyn ControllerDesign = &regulator::Regulator;

/// The controller of this name.
pub fn design(id: &str) -> Option<&'static dyn ControllerDesign> {
    DESIGNS.iter().copied().find(|d| d.info().id == id)
}
