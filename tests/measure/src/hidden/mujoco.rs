//! The truth by MuJoCo: scripts that share nothing with the library.

use super::case::{Case, Files, TruthFile};
use handstand_xtask::program::run as succeeds;
use handstand_xtask::root;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Where the scripts are, and the folder of the environment they run in.
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

/// Runs the script of the case's rig.
pub(super) fn write(case: &Case, dir: &Path) -> Result<Files, String> {
    let (scripts, folder) = places();
    let effects = match case.hidden.as_slice() {
        [] => "nothing".to_string(),
        kinds => kinds.join(","),
    };
    let in_space = case.family.is_in_space();
    let script = if in_space {
        "hidden_space.py"
    } else {
        "hidden_mujoco.py"
    };
    let mut python = Command::new(folder.join("venv/bin/python"));
    python.arg(scripts.join(script)).arg(dir);
    if !in_space {
        python.args(["--motions", case.motions()]);
    }
    let output = python
        .args(["--effects", &effects])
        .args(["--seed", &case.seed.to_string()])
        // A rig of three joints gains nothing from threads.
        .env("OMP_NUM_THREADS", "1")
        .env("OPENBLAS_NUM_THREADS", "1")
        .output()
        .map_err(|error| format!("{script} cannot be run: {error}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.lines().last().unwrap_or("no message");
        return Err(format!("{script}: {last}"));
    }
    let truth: TruthFile =
        serde_json::from_slice(&output.stdout).map_err(|error| format!("{script}: {error}"))?;
    let all = |names: &[String]| names.iter().map(|name| dir.join(name)).collect();
    Ok(Files {
        nominal: dir.join("nominal.toml"),
        truth: truth.in_library.then(|| dir.join("true.toml")),
        fit: all(&truth.fit),
        held_out: all(&truth.held_out),
        effects: truth.effects,
    })
}
