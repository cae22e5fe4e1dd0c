//! Model a chain of links, compare it with measured logs, and find the physical effect that is missing.
//!
//! Numbers for people are written by `number`, which every layer may read. Layers read downward only: `model` -> `dynamics` -> `effects` -> `sim`; `sim` + `log` -> `identify` ->
//! `diagnose` -> `report`; `model` + `dynamics` + `effects` -> `synth`; `model` + `dynamics` -> `closed_loop`;
//! `synth` + `closed_loop` -> `study`; `bus_sim` -> `link` -> `record`; `cli` sits on top and nothing depends on it.

pub mod bus_sim;
pub mod challenge;
pub mod closed_loop;
pub mod compare;
pub mod controllers;
pub mod diagnose;
pub mod dynamics;
pub mod effects;
pub mod error;
pub mod fitting;
pub mod link;
pub mod log;
pub mod model;
pub mod number;
pub mod output;
pub mod paper;
pub mod plot;
pub mod record;
pub mod report;
pub mod sim;
pub mod study;
pub mod synth;
pub mod sysid;

pub use error::{Error, Place, Result};
pub use model::Model;
