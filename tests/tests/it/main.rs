//! Benchmarks sampled, the firmware run, the guides followed. One test program: each more would
//! link the library again.

mod contributing;
mod dependencies;
#[cfg(all(unix, simavr))]
mod deploy;
mod firmware;
mod fuzz;
mod hidden;
mod import;
mod intervals;
#[cfg(unix)]
mod kills;
mod mjcf;
mod next;
mod simulators;
mod spoiled;
