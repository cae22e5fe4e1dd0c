//! Control laws for the handstand: one file each, told only what a designer can know, and tried under what the robot
//! does to them.
//!
//! `known` -> designs ([`DESIGNS`]) -> `trial` (starts held, per [`CONDITIONS`]) and `delay` (longest survived).
//! Adding a controller is one file and one line in [`DESIGNS`].

mod best;
mod card;
mod chain;
mod conditions;
mod dead_zone;
mod delay;
mod integral;
mod known;
mod lqg;
mod observed;
mod offset;
mod on_board;
mod paper;
mod plant;
mod robust;
mod servo;
mod sliding;
mod trial;
mod uncertain;

#[cfg(test)]
mod tests;

pub use card::{Card, Design, Speeds};
pub use chain::{CHAINS, Chain, SERVO_DEAD_TIME_S};
pub use conditions::{CONDITIONS, Condition, condition};
pub use delay::{Longest, longest_held, longest_linear};
pub use known::Known;
pub use on_board::{
    Fitting, OnBoard, Servo, Timing, plan as board_plan, plan_file, reading_steps, regulator_plan,
    si as board_steps,
};
pub use robust::{SHARE, WEIGHTS, gain as robust_gain};
pub use servo::ServoLag;
pub use trial::{REGION_RUNS, Region, Robots, Tried, region, try_out};
pub use uncertain::Uncertain;

/// Every controller, plainest first.
pub const DESIGNS: &[&dyn Design] = &[
    &paper::PLAIN,
    &paper::DIFFERENCED,
    &paper::COMPENSATED,
    &dead_zone::DeadZoneInverse,
    &integral::Integral,
    &offset::OffsetObserver,
    &lqg::Lqg,
    &servo::ServoModel,
    &sliding::PLAIN,
    &sliding::OBSERVED,
    &robust::Robust,
    &best::Best,
];

/// The controller of this name.
pub fn design(id: &str) -> Option<&'static dyn Design> {
    DESIGNS.iter().copied().find(|d| d.card().id == id)
}
