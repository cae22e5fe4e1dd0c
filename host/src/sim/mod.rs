//! Simulation of a model along a motion's recorded inputs.

mod drive;
mod input;
mod live;
mod plant;
mod rows;
mod run;
mod stepper;

pub use live::{Live, hanging};
pub use plant::Plant;
pub use run::{Memory, Start, predict};
