//! The README's own path, walked on drawn rigs: from a log to `init`, `log check`, `diagnose` and
//! `add`, by the program's own commands or by the lab's pages, with nothing mended by hand.
//!
//! The rigs have their own equations and integrator (`simulation.rs`), apart from the library's and
//! from those of the challenges.

mod judge;
mod lab_walk;
mod names;
mod rig;
mod simulation;
mod walk;

pub use judge::{End, Walk};
pub use lab_walk::walk_in_lab;
pub use rig::{DrawnRig, DriveKind, Hidden};
pub use walk::walk;
