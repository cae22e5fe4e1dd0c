//! `cargo xtask`: the project's own chores, one file each under `src/xtask/`.

#[path = "../xtask/mod.rs"]
mod xtask;

use clap::Parser as _;
use std::process::ExitCode;

fn main() -> ExitCode {
    xtask::Chores::parse().run()
}
