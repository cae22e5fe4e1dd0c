//! A robot with the physical effects of its joints: its file, and the motions that were measured of
//! it. The equations are those of `handstand-physics`, which stands here under this crate's name.
//!
//! Nothing here simulates, fits, or knows a log's format.

#[cfg(any(test, feature = "testkit"))]
pub mod fixture;
pub mod model;
pub mod motion;

pub use handstand_physics::{Error, Place, Result};
pub use handstand_physics::{dynamics, effects, error, output};
pub use model::Model;
