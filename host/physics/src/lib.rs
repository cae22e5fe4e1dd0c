//! How a rigid chain or tree of links moves, and the laws by which a real rig departs from it; with
//! the errors and the written output that everything above shares.
//!
//! Nothing here knows a model's file: numbers in, accelerations and torques out.

pub mod dynamics;
pub mod effects;
pub mod error;
pub mod output;

pub use error::{Error, Place, Result};
