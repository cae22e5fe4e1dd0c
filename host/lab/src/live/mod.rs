//! The robot at a port, as it is now: pages watch it while it is recorded or balanced.
//!
//! `access` says how the robot is reached, `slot` holds the one run there may be and who watches
//! it, `pose` turns samples into angles of links, `run` records and balances through the functions
//! that `handstand record` and `handstand balance` call. Nothing moves before it was asked for and
//! confirmed; a page that goes away ends the run.

mod access;
mod balance;
mod pose;
mod record;
mod run;
mod samples;
mod slot;

pub use access::RobotAccess;
pub(super) use run::{LiveTask, begin};
pub(super) use slot::{LiveRobot, Viewer};
