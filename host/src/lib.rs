//! Model a chain of links, compare it with measured logs, and find the physical effect that is
//! missing.
//!
//! All of it under one name; each part is a crate of its own (`handstand-model`, `handstand-sim`,
//! ..), for those who need no more. `ARCHITECTURE.md` says which part knows what.

pub use handstand_challenge as challenge;
pub use handstand_control::{synth, sysid};
pub use handstand_diagnose::{diagnose, discover, first_model};
pub use handstand_experiment as experiment;
pub use handstand_fit::{compare, fitting};
#[cfg(feature = "lab")]
pub use handstand_lab as lab;
pub use handstand_link as link;
pub use handstand_logs as log;
pub use handstand_model::{Error, Model, Place, Result};
pub use handstand_model::{dynamics, effects, error, model, motion, output};
pub use handstand_paper as paper;
pub use handstand_report as report;
pub use handstand_report::plot;
#[cfg(feature = "robot")]
pub use handstand_robot::deploy;
#[cfg(feature = "virtual-cm5")]
pub use handstand_robot::robot_demo;
pub use handstand_sim::sim;
pub use handstand_study as study;
