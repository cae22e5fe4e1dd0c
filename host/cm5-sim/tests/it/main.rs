//! The firmware's safety, its logic in process.

mod arming;
mod attitude;
mod bus;
mod fault_log;
mod invariants;
mod joints;
mod life;
mod rig;
mod start;
mod supply;
mod torque;
