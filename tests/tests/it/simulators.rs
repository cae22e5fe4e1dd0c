//! MuJoCo and Pinocchio, which compute what the library is compared with.

use serde_json::{Value, json};
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

/// Coordinates, speeds and torques of a robot's joints.
pub type State = [Vec<f64>; 3];

/// A robot's file, its joints in an order of ours, and where it is compared.
pub struct Case {
    pub file: PathBuf,
    pub joints: Vec<String>,
    pub states: Vec<State>,
}

/// The largest difference of accelerations from theirs, as a share of the largest of a state, which
/// is less than 1e-9; `ours` are those of a case's number at a state.
pub fn largest_difference(
    python: &Path,
    cases: &[Case],
    ours: impl Fn(usize, &State) -> Vec<f64>,
) -> f64 {
    let asked: Vec<Value> = cases
        .iter()
        .map(|case| {
            let states = case.states.iter();
            let states = states.map(|[q, dq, tau]| json!({ "q": q, "dq": dq, "tau": tau }));
            let states: Vec<Value> = states.collect();
            json!({ "file": case.file, "joints": case.joints, "states": states })
        })
        .collect();
    let theirs = answers(python, "forward_dynamics.py", &asked);
    assert_eq!(theirs.len(), cases.len());
    let mut worst = 0.0f64;
    for (number, (case, theirs)) in cases.iter().zip(theirs).enumerate() {
        let theirs: Vec<Vec<f64>> = serde_json::from_value(theirs).unwrap();
        assert_eq!(theirs.len(), case.states.len(), "{}", case.file.display());
        for (state, theirs) in case.states.iter().zip(theirs) {
            let ours = ours(number, state);
            let size = theirs.iter().fold(1.0, |most: f64, a| most.max(a.abs()));
            assert_eq!(ours.len(), theirs.len(), "{}", case.file.display());
            for (ours, theirs) in ours.iter().zip(&theirs) {
                let off = (ours - theirs).abs() / size;
                worst = worst.max(off);
                let file = case.file.display();
                assert!(off < 1e-9, "{file}: {ours} instead of {theirs}");
            }
        }
    }
    worst
}
