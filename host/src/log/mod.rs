//! Measurements: reading logs as rigs write them, gating them, holding motions out.

mod motion;

pub use motion::{Motion, Source};
