//! A chain of links with the physical effects of its joints: its equations, its file, the motions
//! that were measured of it, and the errors that everything around it says.
//!
//! Nothing here simulates, fits, or knows a file's format but the model's own.

pub mod dynamics;
pub mod effects;
pub mod error;
#[cfg(any(test, feature = "testkit"))]
pub mod fixture;
pub mod model;
pub mod motion;
pub mod output;

pub use error::{Error, Place, Result};
pub use model::Model;
