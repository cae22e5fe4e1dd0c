//! What the benchmarks measure with; `cargo xtask` prints it and the tests sample it.

pub use handstand_xtask::firmware;

pub mod bench;
pub mod conventions;
pub mod discover;
pub mod experiment;
pub mod first_hour;
pub mod hidden;
pub mod jobs;
#[cfg(unix)]
pub mod kills;
pub mod measured;
pub mod pages;
pub mod peers;
pub mod reading;
pub mod refit;
pub mod spoiled;
pub mod verdicts;
