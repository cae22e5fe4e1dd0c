//! The rigid planar chain: equations of motion by recursion in O(n), and in closed form; and the
//! tree in space, likewise. The tests hold them to each other.

mod articulated;
mod chain;
mod dense;
mod equations;
mod inverse;
mod jacobians;
mod lanes;
mod link_motion;
mod runge_kutta;
mod sin_cos;
mod slide_axis;
mod spatial;

pub use articulated::{FreeBase, Workspace};
pub use chain::{Chain, ChainLink};
pub use dense::Dense;
pub use equations::EquationsOfMotion;
pub use lanes::{Lane, Lanes};
pub use runge_kutta::{RungeKutta, runge_kutta};
pub use slide_axis::SlideAxis;
pub use spatial::{SpatialEquations, SpatialLink, SpatialTree, SpatialWorkspace, TreeAtPose};
