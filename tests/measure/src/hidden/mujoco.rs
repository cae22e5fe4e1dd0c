//! The truth by MuJoCo: a script that shares nothing with the library.

use super::case::{Case, Files, TruthFile};
use handstand_xtask::program::run as succeeds;
use handstand_xtask::root;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Where the script is, and the folder of the environment it runs in.
fn places() -> (PathBuf, PathBuf) {
    (root().join("tests/peers"), root().join("target/peers"))
}

/// Installs MuJoCo from PyPI into `target/peers/venv` where it is not there yet; whether it is
/// there.
pub fn install() -> bool {
    let (scripts, folder) = places();
    let python = folder.join("venv/bin/python");
    let is_there = || {
        Command::new(&python)
            .args(["-c", "import mujoco, numpy"])
            .stderr(Stdio::null())
            .status()
            .is_ok_and(|status| status.success())
    };
    if is_there() {
        return true;
    }
    eprintln!("Needed: MuJoCo (PyPI). Installing it into target/peers/venv.");
    let venv = folder.join("venv");
    let mut pip = Command::new(venv.join("bin/pip"));
    pip.args(["install", "--quiet", "-r"])
        .arg(scripts.join("requirements-hidden.txt"));
    (python.is_file() || succeeds(Command::new("python3").args(["-m", "venv"]).arg(&venv)))
        && succeeds(&mut pip)
}

/// Runs the script.
pub(super) fn write(case: &Case, dir: &Path) -> Result<Files, String> {
    let (scripts, folder) = places();
    let effects = match case.hidden.as_slice() {
        [] => "nothing".to_string(),
        kinds => kinds.join(","),
    };
    let output = Command::new(folder.join("venv/bin/python"))
        .arg(scripts.join("hidden_mujoco.py"))
        .arg(dir)
        .args(["--motions", case.motions(), "--effects", &effects])
        .args(["--seed", &case.seed.to_string()])
        // A rig of three joints gains nothing from threads.
        .env("OMP_NUM_THREADS", "1")
        .env("OPENBLAS_NUM_THREADS", "1")
        .output()
        .map_err(|error| format!("hidden_mujoco.py cannot be run: {error}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.lines().last().unwrap_or("no message");
        return Err(format!("hidden_mujoco.py: {last}"));
    }
    let truth: TruthFile = serde_json::from_slice(&output.stdout)
        .map_err(|error| format!("hidden_mujoco.py: {error}"))?;
    let all = |names: &[String]| names.iter().map(|name| dir.join(name)).collect();
    Ok(Files {
        nominal: dir.join("nominal.toml"),
        truth: truth.in_library.then(|| dir.join("true.toml")),
        fit: all(&truth.fit),
        held_out: all(&truth.held_out),
        effects: truth.effects,
    })
}
