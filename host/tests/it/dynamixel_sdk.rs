//! ROBOTIS's own SDK (PyPI `dynamixel-sdk`) speaks with the simulated servos through `virtual
//! --pty`.

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

struct Virtual(Child);

impl Drop for Virtual {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// What the SDK saw; none if it is not installed.
fn talk(words: &[&str], baud: &str) -> Option<serde_json::Value> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let python = root.join("target/sdk/venv/bin/python");
    if !python.exists() {
        eprintln!("SKIPPED: dynamixel-sdk is not installed; `cargo xtask test` installs it");
        return None;
    }
    let mut robot = Command::new(env!("CARGO_BIN_EXE_handstand"));
    robot
        .args(["virtual", "--pty", "--seconds", "60"])
        .args(words);
    let mut robot = Virtual(
        robot
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap(),
    );
    let mut port = String::new();
    BufReader::new(robot.0.stdout.take().unwrap())
        .read_line(&mut port)
        .unwrap();
    let output = Command::new(python)
        .arg(root.join("tests/peers/dynamixel_sdk_talk.py"))
        .args([port.trim(), baud])
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

fn check(words: &[&str], baud: &str) {
    let Some(saw) = talk(words, baud) else {
        return;
    };
    println!("{} baud: {saw}", baud);
    assert_eq!(saw["models"], serde_json::json!([12, 12, 12]));
    assert_eq!((&saw["silent"], &saw["led"]), (&true.into(), &1.into()));
    assert_eq!(saw["written"], saw["goals"]);
    for (reached, goal) in saw["reached"]
        .as_array()
        .unwrap()
        .iter()
        .zip(saw["goals"].as_array().unwrap())
    {
        let error = reached.as_i64().unwrap() - goal.as_i64().unwrap();
        assert!(error.abs() <= 8, "{saw}");
    }
}

#[test]
fn the_sdk_works_on_a_virtual_adapter() {
    check(&["ids=1-3"], "1000000");
}

#[test]
fn the_sdk_works_through_a_virtual_cm5() {
    check(&["--cm5", "ids=1-3"], "57600");
}
