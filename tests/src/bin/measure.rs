//! The chores of `cargo xtask` that measure, one file each under `src/xtask/`; it runs this program.

#[path = "../xtask/mod.rs"]
mod xtask;

use clap::Parser as _;
use std::process::ExitCode;

fn main() -> ExitCode {
    xtask::Chores::parse().run()
}
