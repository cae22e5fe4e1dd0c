//! The firmware's safety, its logic in process.

mod arming;
mod attitude;
mod bus;
mod fault_log;
mod invariants;
mod joints;
mod let_down;
mod life;
mod plan_store;
mod rig;
mod start;
mod supply;
mod torque;
