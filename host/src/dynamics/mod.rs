//! The rigid planar chain: equations of motion in O(n), and dense ones for few links.

mod articulated;
mod chain;
mod dense;
mod inverse;
mod lanes;
mod sin_cos;

pub use articulated::Workspace;
pub use chain::{Chain, ChainLink};
pub use dense::Dense;
pub use lanes::{Lane, Lanes};
