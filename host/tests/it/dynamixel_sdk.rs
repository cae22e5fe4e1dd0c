//! ROBOTIS's own SDK (PyPI `dynamixel-sdk`) speaks with the simulated servos through `virtual
//! --pty`.

use handstand_shared::dynamixel2::Request;
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
fn talk(script: &str, words: &[&str], baud: &str) -> Option<serde_json::Value> {
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
        .arg(root.join("tests/peers").join(script))
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
    let Some(saw) = talk("dynamixel_sdk_talk.py", words, baud) else {
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

/// Its handler of Protocol 2.0: ping, broadcast ping, read, write, sync, fast sync and bulk read,
/// the refusals, and the bus watchdog.
fn check_2(words: &[&str], baud: &str) {
    let Some(saw) = talk("dynamixel_sdk_talk2.py", words, baud) else {
        return;
    };
    println!("{baud} baud: {saw}");
    assert_eq!(saw["models"], serde_json::json!([1200, 1200, 1200]));
    assert_eq!((&saw["silent"], &saw["led"]), (&true.into(), &1.into()));
    assert_eq!(saw["broadcast"], serde_json::json!([1, 2, 3]));
    assert_eq!(saw["written"], saw["goals"]);
    assert_eq!((&saw["locked"], &saw["refused"]), (&7.into(), &4.into()));
    assert_eq!(saw["tripped"], 255);
    for read in ["slow", "fast"] {
        let states = saw[read].as_array().unwrap().iter();
        for (state, goal) in states.zip(saw["goals"].as_array().unwrap()) {
            let error = state[1].as_i64().unwrap() - goal.as_i64().unwrap();
            assert!(error.abs() <= 4, "{read}: {saw}");
        }
    }
    assert_eq!(saw["bulk"][2], 30);
    let datas = [
        &[0xff, 0xff, 0xfd, 0x00][..],
        &[0xfb, 0xff, 0xfd, 0xff, 0xff, 0xff, 0xfd, 0x08],
    ];
    for (theirs, data) in saw["stuffed"].as_array().unwrap().iter().zip(datas) {
        let mut ours = [0; 32];
        let write = Request::Write { address: 116, data };
        let length = write.emit(1, &mut ours).unwrap();
        assert_eq!(*theirs, serde_json::json!(ours[..length]));
    }
}

#[test]
fn the_sdk_drives_servos_of_protocol_2() {
    check_2(&["model=XL330-M288,ids=1-3"], "1000000");
}

#[test]
fn the_sdk_drives_them_through_a_virtual_cm5() {
    check_2(&["--cm5", "model=XL330-M288,ids=1-3"], "57600");
}
