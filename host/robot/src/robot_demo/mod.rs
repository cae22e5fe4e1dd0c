//! The whole circle on a virtual robot behind the CM-5's firmware: balance with what its owner
//! believes, measure, diagnose, balance with what was learned.
//!
//! `hidden` (what is drawn by seed, and sealed) -> [`crate::deploy::rehearsal`] (a plan balances
//! the robot) -> `recording` (excitation, played through the firmware, the robot hanging) ->
//! `learning` (diagnose, add) -> [`crate::deploy::PlanBasis`] (a plan for what was learned) ->
//! `page` (both attempts side by side).
//!
//! The robot is a model of this crate on simulated servos, the firmware its own logic in process;
//! nothing of the true state reaches the diagnosis, and only the first link's attitude the law.

mod hidden;
mod learning;
mod page;
mod recording;
mod run;

pub use hidden::{HiddenRobot, RobotAnswer, RobotEffect};
pub use learning::Learned;
pub use page::{effect_columns, html};
pub use recording::{MOTIONS, PAYLOAD_KG, RecordedMotion};
pub use run::{DemoStep, LIMIT_OPTIONS, RobotDemo, ScoredEffect, run};
