//! Python packages that some tests need, each set in an environment of its own under `target`.

use super::program::{self, found};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The environment of ROBOTIS's SDK, which drives the simulated servos in a test.
fn sdk() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/sdk/venv")
}

/// Installs what is not there yet; what cannot be is said, and its test skipped.
pub fn all() {
    let wanted_for = "the test that drives simulated servos by ROBOTIS's own SDK";
    let venv = sdk();
    let is_there = || {
        Command::new(venv.join("bin/python"))
            .args(["-c", "import dynamixel_sdk"])
            .status()
            .is_ok_and(|s| s.success())
    };
    if venv.join("bin/python").exists() && is_there() {
        println!("dynamixel-sdk, for {wanted_for}: here already.");
        return;
    }
    println!("dynamixel-sdk (PyPI), for {wanted_for}: installing into target/sdk/venv.");
    let well = found(&["python3"])
        && program::run(Command::new("python3").args(["-m", "venv"]).arg(&venv))
        && program::run(Command::new(venv.join("bin/pip")).args([
            "install",
            "--quiet",
            "dynamixel-sdk==4.1.0",
        ]));
    if !well {
        println!("dynamixel-sdk could not be installed; its test is skipped.");
    }
}
