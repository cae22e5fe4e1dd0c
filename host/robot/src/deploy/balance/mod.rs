//! Balance a robot through the CM-5's firmware: set its servos up, arm, supervise, let it down.
//!
//! `attitude` (where the first link's attitude comes from), `wheel_mode` (servos that turn without
//! end) -> [`Balancer`], which talks with the firmware -> `outcome` (how it ended). `supervise` is
//! the whole of it.

mod attitude;
mod balancer;
mod outcome;
mod set_up;
mod status;
mod supervise;
mod wheel_mode;

pub use attitude::{AttitudeLines, AttitudeSource, check_attitude};
pub use balancer::Balancer;
pub use outcome::{BalanceEnd, BalanceOutcome};
pub use status::BalanceStatus;
pub use supervise::{BalanceWatch, Supervision};
pub use wheel_mode::WheelChange;

#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod tests;
