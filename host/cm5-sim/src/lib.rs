//! A bus of simulated AX-12 servos, in pure Rust: for tests, for the bench, and behind a virtual serial port.
//!
//! Time is whatever the caller says it is, in nanoseconds: the simulation has no clock of its own. [`Bus::hear`] takes the
//! controller's bytes with the moment their last stop bit ended; [`Bus::take`] gives the servos' bytes back, each with
//! its own. Timing, registers and faults are those of the data sheet and of published measurements; every constant says which.

mod bus;
mod collision;
mod ear;
mod fault;
mod motor;
mod obey;
mod output;
mod overload;
mod robot;
mod servo;

pub use bus::Bus;
pub use fault::Faults;
pub use motor::Motor;
pub use output::Output;
pub use overload::Protection;
pub use robot::{DriveState, Robot, State};
pub use servo::Servo;

/// A bit at 1 Mbps, ns.
pub const BIT_NS: u64 = 1000;
/// A byte of 8N1 at 1 Mbps, ns.
pub const BYTE_NS: u64 = 10 * BIT_NS;

#[cfg(test)]
mod robot_tests;
#[cfg(test)]
mod tests;
