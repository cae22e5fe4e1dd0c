//! Model a chain of links, compare it with measured logs, and find the physical effect that is missing.
//!
//! Numbers for people are written by `number`, which every layer may read. Layers read downward only: `model` -> `dynamics` -> `effects` -> `sim`; `sim` + `log` -> `identify` ->
//! `diagnose` -> `report`; `cli` sits on top and nothing depends on it.

pub mod challenge;
pub mod compare;
pub mod diagnose;
pub mod dynamics;
pub mod effects;
pub mod error;
pub mod extend;
pub mod identify;
pub mod log;
pub mod model;
pub mod number;
pub mod output;
pub mod report;
pub mod sim;

pub use error::{Error, Place, Result};
pub use model::Model;
