//! The firmware's safety, its logic in process.

mod arming;
mod attitude;
mod boot_counter;
mod bus;
mod fault_log;
mod floods;
mod gyro;
mod invariants;
mod joints;
mod law;
mod let_down;
mod life;
mod line;
mod plan_store;
mod reports;
mod restarts;
mod rig;
mod start;
mod supply;
mod torque;
