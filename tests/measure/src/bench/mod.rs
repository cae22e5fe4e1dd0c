//! The bench of the firmware: the same scenarios on the logic in process and on the real ELF in
//! simavr.

#[cfg(simavr)]
mod ages;
mod balance;
#[cfg(simavr)]
mod boot;
mod frames;
#[cfg(simavr)]
mod law;
mod laws;
mod loss;
mod power;
mod robot;
mod run;
#[cfg(unix)]
mod serve;
mod servo_faults;
mod servos;
mod stream;

#[cfg(simavr)]
pub use ages::{Ages, Spread, ages};
pub use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};

pub use balance::{
    Balanced, Conditions, LONGEST_TICK_US, Source, Tick, arm_balance, balance, plan,
};
#[cfg(simavr)]
pub use boot::{Boot, boot, eeprom_with, noise};
pub use frames::{FrameTally, bit_flips, patterns, random_bytes, resynchronised};
#[cfg(simavr)]
pub use law::{CHOSEN, Cycles, LawRun, ObserverRun, SHIFTS, law, observer_law};
pub use laws::{Fixed, Float, HostLaw, Sides, balance_by_host, different, side_by_side};
#[cfg(simavr)]
pub use loss::hang;
pub use loss::{Loss, Worst, arm, link_loss, worst_of};
pub use power::{PowerCuts, power_cuts};
pub use robot::model;
pub use run::REPORT_MS;
#[cfg(unix)]
pub use serve::serve;
pub use servo_faults::{gyro_at_rail, restart};
pub use servos::{Rig, corners, random_starts};
pub use stream::{StreamRun, stream};
