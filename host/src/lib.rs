//! Model a chain of links, compare it with measured logs, and find the physical effect that is
//! missing.
//!
//! Layers read downward only: `dynamics` (plain chain) -> `effects` (laws) -> `model` (instances,
//! TOML) -> `sim` (the one plant, along a log or in a closed loop); `sim` + `log` -> `fitting` ->
//! `diagnose` -> `report`; `model` -> `synth`; `sim` + `synth` -> `study`; `synth` + `link` ->
//! `deploy`; `cli` sits on top and nothing depends on it. Every layer may read `error`, and
//! `output`, which writes files, numbers and plots.


pub use handstand_challenge as challenge;
pub use handstand_control::{study, synth, sysid};
pub use handstand_diagnose::{diagnose, experiment, first_model};
pub use handstand_link as link;
pub use handstand_logs as log;
pub use handstand_model::{Error, Model, Place, Result};
pub use handstand_model::{dynamics, effects, error, model, motion, output};
pub use handstand_paper as paper;
pub use handstand_report as report;
pub use handstand_report::plot;
pub use handstand_robot::deploy;
#[cfg(feature = "virtual-cm5")]
pub use handstand_robot::robot_demo;
pub use handstand_sim::{compare, fitting, sim};
pub use handstand_lab as lab;
