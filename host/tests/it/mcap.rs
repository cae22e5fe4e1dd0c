//! Recordings as MCAP's own Python library reads them (PyPI `mcap`), whole and torn.

use crate::common::Bench;
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// What the library sees in a file; none if it is not installed.
fn seen(file: &Path, options: &[&str]) -> Option<serde_json::Value> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let python = root.join("target/sdk/venv/bin/python");
    let has = Command::new(&python).args(["-c", "import mcap"]).output();
    if !has.is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: PyPI's mcap is not installed; `cargo xtask test` installs it");
        return None;
    }
    let mut reader = Command::new(python);
    reader.arg(root.join("tests/peers/read_mcap.py")).arg(file);
    let output = reader.args(options).output().unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

#[test]
fn a_whole_recording_is_read_by_another_library() {
    let bench = Bench::new();
    let line = "record a.mcap --seconds 1 --port sim:ids=1-3,delay=0,dead=2 --ids 1-3 --json";
    let ran = bench.run(line);
    let Some(seen) = seen(&bench.path("a.mcap"), &[]) else {
        return;
    };
    let samples = &ran.json()["samples"];
    assert_eq!(&seen["topics"]["/joint_states"], samples);
    assert_eq!(&seen["topics"]["/servo_health"], samples);
    assert_eq!(
        seen["schemas"]["/joint_states"],
        serde_json::json!(["sensor_msgs/msg/JointState", "ros2msg", "cdr"])
    );
    // A dead servo is there, and has no angle.
    let state = serde_json::json!([["servo1", "servo2", "servo3"], [0.0, null, 0.0]]);
    assert_eq!(seen["last"], state);
    assert_eq!(seen["counted"].as_u64(), samples.as_u64().map(|n| 2 * n));
}

/// A child that does not outlive its owner.
struct Owned(Child);

impl Drop for Owned {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn spawn(words: &[&str]) -> Owned {
    let mut command = Command::new(env!("CARGO_BIN_EXE_handstand"));
    let command = command.args(words).arg("--quiet").stdout(Stdio::piped());
    Owned(command.spawn().unwrap())
}

#[test]
fn of_a_torn_one_it_reads_as_much_as_we_do() {
    let bench = Bench::new();
    let mut robot = spawn(&["virtual", "--pty", "--seconds", "60", "ids=1,delay=0"]);
    let mut port = String::new();
    let stdout = robot.0.stdout.take().unwrap();
    BufReader::new(stdout).read_line(&mut port).unwrap();
    let file: PathBuf = bench.path("torn.mcap");
    let name = file.to_string_lossy();
    let line = ["--port", port.trim(), "--baud", "1000000", "--ids", "1"];
    let recorder = spawn(&[&["record", &name], &line[..]].concat());
    // Until several chunks are there, whatever the machine's speed.
    while std::fs::metadata(&file).map_or(0, |facts| facts.len()) < 20_000 {
        std::thread::sleep(Duration::from_millis(20));
    }
    drop(recorder);
    let ours = bench.run("record whole.csv --from torn.mcap --json").json();
    assert_eq!(ours["torn"], true);
    assert!(ours["samples"].as_u64().unwrap() > 20, "{ours}");
    let Some(seen) = seen(&file, &["--torn"]) else {
        return;
    };
    assert_eq!(seen["topics"]["/joint_states"], ours["samples"]);
}
