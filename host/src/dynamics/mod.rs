//! The rigid planar chain: equations of motion in O(n).

mod articulated;
mod chain;
mod inverse;

pub use articulated::Workspace;
pub use chain::{Chain, ChainLink};
