//! Benchmarks sampled, the firmware run. One test program: each more would link the library again.

#[cfg(all(unix, simavr))]
mod deploy;
mod firmware;
mod fuzz;
mod hidden;
mod intervals;
#[cfg(unix)]
mod kills;
