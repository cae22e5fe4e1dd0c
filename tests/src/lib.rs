//! What the benchmarks measure with; `cargo xtask` prints it and the tests sample it.

pub mod bench;
pub mod firmware;
pub mod hidden;
#[cfg(unix)]
pub mod kills;
pub mod peers;
