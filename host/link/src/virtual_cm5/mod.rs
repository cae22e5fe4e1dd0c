//! Simulated CM-5 and servos as links, and models of this crate as their robots (feature
//! `virtual-cm5`).
//!
//! The simulation itself is the crate `handstand-cm5-sim`. [`SimLink`] makes its serial ports
//! links, [`Live`] is the plant behind its servos, and [`set_up`] makes a bus with a robot
//! from a [`BusSpec`].
//!
//! [`Live`]: crate::sim::Live

mod attitude;
mod link;
mod robot;
#[cfg(unix)]
mod serve;
mod state_log;

pub use attitude::{AttitudeSensor, attitude_sensor, attitude_sensor_of};
pub use handstand_cm5_sim::{AdapterPort, Bus, BusSpec, Cm5Port, RobotSpec, RobotState};
pub use link::SimLink;
pub use robot::{set_up, set_up_model, spec, spec_with_robot};
#[cfg(unix)]
pub use serve::serve;
pub use state_log::StateLog;

#[cfg(test)]
mod tests;
