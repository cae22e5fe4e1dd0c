//! The chores of `cargo xtask` that measure, one file each under `src/measure/`; it runs this
//! program.

#[path = "../measure/mod.rs"]
mod measure;

use clap::Parser as _;
use std::process::ExitCode;

fn main() -> ExitCode {
    measure::Chores::parse().run()
}
