//! MuJoCo and Pinocchio, which compute what the library is compared with.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Python with both, as `cargo xtask install` brings it; none, and a line that says so, where it is
/// not there.
pub fn python() -> Option<PathBuf> {
    let python = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/peers/venv/bin/python");
    let imports = ["-c", "import mujoco, numpy, pinocchio"];
    let works = Command::new(&python).args(imports).output();
    let is_there = works.is_ok_and(|output| output.status.success());
    if !is_there {
        println!("skipped: MuJoCo and Pinocchio are not here, `cargo xtask install` brings them");
    }
    is_there.then_some(python)
}

/// What a script of `tests/peers` prints for these cases.
pub fn answers(python: &Path, script: &str, cases: &[Value]) -> Vec<Value> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cases.json");
    std::fs::write(&path, serde_json::to_string(cases).unwrap()).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("peers")
        .join(script);
    let output = Command::new(python)
        .arg(script)
        .arg(&path)
        .output()
        .unwrap();
    let complaints = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{complaints}");
    serde_json::from_slice(&output.stdout).unwrap()
}
