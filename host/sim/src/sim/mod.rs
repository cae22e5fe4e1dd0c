//! The one plant: a model with all its effects, simulated along a log, live behind servos, or in a
//! closed loop.
//!
//! `plant` (a model compiled) -> `drive` (input to torque) -> `forces` (accelerations)
//! -> `stepper` (one step, friction that sticks) -> `run` (along a
//! log), `live` (step by step), [`closed_loop`] (held by a controller).

mod auxiliary;
pub mod closed_loop;
mod drive;
mod forces;
mod hidden;
mod input;
mod joint_plan;
mod live;
mod memory;
mod plant;
mod rows;
mod run;
mod sensor_state;
mod stepper;

pub use hidden::{HiddenQuantity, HiddenUnknown};
pub use live::{Live, bare_motors};
pub use memory::PlantMemory;
pub use plant::Plant;
pub use run::{KnownRun, StartState, predict, predict_beside};
