//! The rigid planar chain: equations of motion in O(n).

mod articulated;
mod chain;
mod inverse;
mod sin_cos;

pub use articulated::Workspace;
pub use chain::{Chain, ChainLink};
