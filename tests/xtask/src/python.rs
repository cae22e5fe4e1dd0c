//! Python packages that some tests need, in an environment of their own under `target`.

use handstand_xtask::program::{self, found};
use handstand_xtask::root;
use std::path::PathBuf;
use std::process::Command;

/// The environment: ROBOTIS's SDK drives simulated servos in a test, MCAP's own reader reads our
/// recordings in another.
fn sdk() -> PathBuf {
    root().join("target/sdk/venv")
}

/// Installs what is not there yet; what cannot be is said, and its test skipped.
pub fn all() {
    let wanted_for =
        "the tests that drive simulated servos by ROBOTIS's own SDK and read recordings by MCAP's";
    let venv = sdk();
    let is_there = || {
        Command::new(venv.join("bin/python"))
            .args(["-c", "import dynamixel_sdk, mcap"])
            .status()
            .is_ok_and(|s| s.success())
    };
    if venv.join("bin/python").exists() && is_there() {
        println!("dynamixel-sdk and mcap, for {wanted_for}: here already.");
        return;
    }
    println!("dynamixel-sdk and mcap (PyPI), for {wanted_for}: installing into target/sdk/venv.");
    let well = found(&["python3"])
        && program::run(Command::new("python3").args(["-m", "venv"]).arg(&venv))
        && program::run(Command::new(venv.join("bin/python")).args([
            "-m",
            "pip",
            "install",
            "--quiet",
            "dynamixel-sdk==4.1.0",
            "mcap==1.6.0",
        ]));
    if !well {
        println!("They could not be installed; these tests are skipped.");
    }
}
