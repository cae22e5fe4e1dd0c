//! The truth by MuJoCo: scripts that share nothing with the library.

use super::case::{Case, Files, TruthFile};
use super::family::SpaceArm;
use handstand_xtask::program::run as succeeds;
use handstand_xtask::root;
use serde::de::DeserializeOwned;
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

/// Runs a script that writes a rig's files into a folder, and reads what it prints of the truth.
pub(crate) fn run<Truth: DeserializeOwned>(
    script: &str,
    dir: &Path,
    seed: u64,
    words: &[&str],
) -> Result<Truth, String> {
    let (scripts, folder) = places();
    let output = Command::new(folder.join("venv/bin/python"))
        .arg(scripts.join(script))
        .arg(dir)
        .args(words)
        .args(["--seed", &seed.to_string()])
        // A rig of a few joints gains nothing from threads.
        .env("OMP_NUM_THREADS", "1")
        .env("OPENBLAS_NUM_THREADS", "1")
        .output()
        .map_err(|error| format!("{script} cannot be run: {error}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.lines().last().unwrap_or("no message");
        return Err(format!("{script}: {last}"));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| format!("{script}: {error}"))
}

/// The SO-101's URDF of the public data; none where `HANDSTAND_DATA` is unset.
pub fn so101() -> Option<PathBuf> {
    let data = std::env::var_os("HANDSTAND_DATA")?;
    Some(PathBuf::from(data).join("robots/so101/so101_new_calib.urdf"))
}

/// What tells the script which robot in space is meant.
fn arm_words(arm: SpaceArm) -> Result<Vec<String>, String> {
    let [option, robot] = match arm {
        SpaceArm::Desk => ["--arm", "desk"].map(str::to_string),
        SpaceArm::Panda => ["--arm", "panda"].map(str::to_string),
        SpaceArm::So101 => {
            let urdf = so101().ok_or("HANDSTAND_DATA is not set, which has the SO-101's URDF")?;
            ["--urdf".to_string(), urdf.to_string_lossy().into_owned()]
        }
    };
    Ok(vec![option, robot])
}

/// Runs the script of the case's rig.
pub(super) fn write(case: &Case, dir: &Path) -> Result<Files, String> {
    let effects = match case.hidden.as_slice() {
        [] => "nothing".to_string(),
        kinds => kinds.join(","),
    };
    let (script, rig) = match case.family.arm() {
        Some(arm) => ("hidden_space.py", arm_words(arm)?),
        None => {
            let words = ["--motions", case.motions()];
            ("hidden_mujoco.py", words.map(str::to_string).to_vec())
        }
    };
    let mut words = vec!["--effects", &effects];
    words.extend(rig.iter().map(String::as_str));
    let truth: TruthFile = run(script, dir, case.seed, &words)?;
    let all = |names: &[String]| names.iter().map(|name| dir.join(name)).collect();
    Ok(Files {
        nominal: dir.join("nominal.toml"),
        truth: truth.in_library.then(|| dir.join("true.toml")),
        fit: all(&truth.fit),
        held_out: all(&truth.held_out),
        effects: truth.effects,
    })
}
