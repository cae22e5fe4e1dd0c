//! The program that is measured.

use handstand_xtask::{cargo, program};
use std::path::PathBuf;

/// Builds `handstand` in release beside this program; none where it could not be built.
pub(super) fn built() -> Option<PathBuf> {
    let here = std::env::current_exe().ok()?;
    let mut cargo = cargo(&[
        "build",
        "--release",
        "--package",
        "handstand",
        "--bin",
        "handstand",
    ]);
    program::run(&mut cargo).then(|| here.with_file_name("handstand"))
}
