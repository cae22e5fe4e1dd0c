//! Simulated CM-5: AX-12 servos, servos of Protocol 2.0, their half-duplex bus, and the firmware's
//! logic on a host board.
//!
//! Simulated time only, in nanoseconds since power-on: nothing here reads a clock. [`Bus`] takes
//! the controller's bytes with the end of their stop bits and returns the servos' bytes the same
//! way. [`VirtualCm5`] runs the firmware's logic on a [`HostBoard`] in front of it;
//! [`SimulatedCm5`] is the interface that the ELF in simavr implements too. [`AdapterPort`] and
//! [`Cm5Port`] are serial ports of both kinds. The robot behind the servos is a [`Plant`], which
//! the caller provides.

mod adapter;
mod bad_checksum;
mod bus;
mod cm5;
mod collision;
mod fault;
mod host_board;
mod pc;
mod plant;
mod port;
mod protection;
mod regulator;
mod requests;
mod robot;
mod servo;
mod shaft;
mod spec;
mod spec_error;
mod x_line;
mod x_requests;
mod x_servo;
mod x_spec;
#[cfg(test)]
mod x_tests;

pub use adapter::AdapterPort;
pub use bus::Bus;
pub use cm5::{SimulatedCm5, VirtualCm5};
pub use fault::Faults;
pub use host_board::HostBoard;
pub use pc::Pc;
pub use plant::{Plant, Start};
pub use port::{Cm5Port, STARTED_MS, SimulatedPort};
pub use protection::Protection;
pub use regulator::Regulator;
pub use robot::{DrivenJoint, Robot, RobotState};
pub use servo::Servo;
pub use shaft::Shaft;
pub use spec::{BusSpec, GyroSpec, RobotSpec};
pub use spec_error::SpecError;
pub use x_line::XLine;
pub use x_servo::XServo;

#[cfg(test)]
mod tests;
