//! The README's own path, walked on drawn rigs: from a log to `init`, `log check`, `diagnose` and
//! `add`, by the program's own commands, with nothing mended by hand.
//!
//! The rigs have their own equations and integrator (`simulation.rs`), apart from the library's and
//! from those of the challenges.

mod names;
mod rig;
mod simulation;
mod walk;

pub use rig::{DrawnRig, DriveKind, Hidden};
pub use walk::{End, Walk, walk};
