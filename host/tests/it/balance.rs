//! `balance` on the simulated robot behind a CM-5.

use crate::common::Bench;

const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/models/handstand.toml");

/// The robot with ideal servos, held until torque comes on.
fn line(more: &str, options: &str) -> String {
    format!("balance {MODEL} --port sim-cm5:robot={MODEL},start=held{more} --yes --json {options}")
}

#[test]
fn a_robot_is_set_up_and_stands_and_is_let_down() {
    let bench = Bench::new();
    let ran = bench.run(&line(",lean=1/-1/1", "--seconds 10 --record run.csv"));
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let data = ran.json();
    assert_eq!(data["ended"], "finished");
    assert!(
        data["cause"].is_null() && data["uploaded"] == true,
        "{data}"
    );
    assert!(
        (10.0..10.1).contains(&data["balanced_s"].as_f64().unwrap()),
        "{data}"
    );
    let rms_rad = data["lean_rms_rad"].as_f64().unwrap();
    assert!((0.001..0.06).contains(&rms_rad), "{rms_rad}");
    // 18 servos with their factory's return delay, four of them in joint mode.
    let changes = data["changes"].as_array().unwrap();
    assert_eq!(changes.len(), 18 + 4, "{changes:?}");
    let recorded = bench.get("run.csv");
    assert_eq!(data["samples"], recorded.lines().count() - 1);
    assert!(recorded.lines().count() > 900 && recorded.starts_with("time_s,q1_rad"));
}

/// Servos of `models/robot_servos.toml`: a lag of 34 ms, back-EMF, friction, backlash, a dead zone
/// of 8 %, a supply that sags.
#[test]
fn a_robot_with_real_servos_stands() {
    let bench = Bench::new();
    let model = MODEL.replace("handstand.toml", "robot_servos.toml");
    let port = format!("--port sim-cm5:robot={model},start=held,lean=-1/1/-1,lag=0.034,delay=0");
    let options = "--yes --json --seconds 10";
    let ran = bench.run(&format!(
        "balance {model} {port} {options} --servo-lag 0.034"
    ));
    assert_eq!(ran.code, Some(0), "{ran:?}");
    // A plan that believes the torque to come at once fells it.
    let ran = bench.run(&format!("balance {model} {port} {options}"));
    assert_eq!(ran.code, Some(5), "{ran:?}");
}

/// The gyro's zero is not the plan's: it is measured before torque comes on.
#[test]
fn a_robot_stands_by_its_gyro_alone() {
    let bench = Bench::new();
    for gyro in ["512/1", "515/1", "513/10"] {
        let step = if gyro.ends_with("/10") {
            "0.174533"
        } else {
            "0.0174533"
        };
        let options = format!("--seconds 10 --gyro-per-code {step} --joint-range 1.5");
        let options = format!("{options} --joint-speed 20 --fallen 0.8");
        let ran = bench.run(&line(&format!(",lean=1/-1/1,gyro={gyro}"), &options));
        assert_eq!(ran.code, Some(0), "{gyro}: {ran:?}");
        assert!(ran.json()["lean_rms_rad"].is_null(), "{ran:?}");
    }
}

#[test]
fn a_plan_of_a_file_is_the_model_s() {
    let bench = Bench::new();
    let header = format!("gains deploy {MODEL} --dry-run --states 10 --header p.rs");
    assert_eq!(bench.run(&header).code, Some(0));
    let port = format!("--port sim-cm5:robot={MODEL},start=held,delay=0 --yes --seconds 1 --json");
    let ran = bench.run(&format!("balance p.rs {port}"));
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let fingerprint = ran.json()["fingerprint"].as_str().unwrap().to_string();
    assert!(bench.get("p.rs").contains(&fingerprint));
    // A damaged one is refused, and without any a CM-5 that has none says so.
    bench.put("q.rs", bench.get("p.rs").replacen("0x", "9x", 1));
    let ran = bench.run(&format!("balance q.rs {port}"));
    assert_eq!(ran.code, Some(3), "{ran:?}");
    assert!(ran.stderr.contains("q.rs:4:1"), "{ran:?}");
    let ran = bench.run(&format!("balance {port}"));
    assert_eq!(ran.code, Some(4), "{ran:?}");
    assert!(ran.stderr.contains("has no plan"), "{ran:?}");
}

#[test]
fn what_speaks_against_arming_is_said() {
    let bench = Bench::new();
    for (more, options, code, said) in [
        (",start=hanging", "", 4, "too far from the pose"),
        (",supply=8", "", 4, "supply is too low"),
        ("", "--ids 1-11", 2, "servo 12"),
        (",dead=2", "", 4, "servo 2"),
        ("", "--attitude gyro", 2, "attitude from the PC"),
        (
            "",
            "--gyro-per-code 0.0175 --attitude robot",
            2,
            "CM-5's gyro",
        ),
        ("", "--torque 2", 2, "--torque"),
        ("", "--record run.txt", 2, "unknown format"),
    ] {
        let ran = bench.run(&line(more, &format!("--seconds 2 {options}")));
        assert_eq!(ran.code, Some(code), "{more} {options}: {ran:?}");
        assert!(ran.stderr.contains(said), "{more} {options}: {ran:?}");
    }
    let unasked = bench.run(&line("", "--seconds 1").replace("--yes", ""));
    assert_eq!(unasked.code, Some(2), "{unasked:?}");
    assert!(unasked.stderr.contains("--yes"), "{unasked:?}");
}

#[test]
fn a_safety_stop_names_the_servo() {
    let bench = Bench::new();
    let refused = bench.run(&line(",hot=5", "--seconds 5"));
    assert_eq!(refused.code, Some(4), "{refused:?}");
    assert!(refused.stderr.contains("overheating"), "{refused:?}");
    let ran = bench.run(&line(",warms=5", "--seconds 8"));
    assert_eq!(ran.code, Some(5), "{ran:?}");
    let data = ran.json();
    assert_eq!(data["ended"], "stopped");
    assert_eq!(data["tripped"]["id"], 5);
    assert_eq!(data["tripped"]["error_flags"][0], "overheat");
    let cause = data["cause"].as_str().unwrap();
    for said in [
        "overloaded or too hot",
        "silent for",
        "servo 5 reports overheat",
        "11.1 V",
    ] {
        assert!(cause.contains(said), "{said}: {cause}");
    }
}

/// A plan for a robot that is not this one: it falls, and the CM-5 says so.
#[test]
fn a_robot_that_falls_is_let_down() {
    let bench = Bench::new();
    let ran = bench.run(&line(",lean=3/3/3", "--seconds 5"));
    assert_eq!(ran.code, Some(5), "{ran:?}");
    assert_eq!(ran.json()["ended"], "stopped", "{ran:?}");
    assert!(ran.json()["balanced_s"].as_f64().unwrap() < 2.0);
}

#[cfg(unix)]
mod signals {
    use super::*;
    use std::io::{BufRead as _, BufReader};
    use std::process::{Child, Command, Stdio};
    use std::time::{Duration, Instant};

    fn spawn(bench: &Bench, line: &str) -> Child {
        let mut command = Command::new(env!("CARGO_BIN_EXE_handstand"));
        command
            .args(line.split_whitespace())
            .current_dir(bench.path("."));
        let command = command.stdin(Stdio::piped()).stdout(Stdio::piped());
        command.stderr(Stdio::null()).spawn().unwrap()
    }

    fn signal(name: &str, child: &Child) {
        let pid = child.id().to_string();
        let sent = Command::new("kill").args([name, &pid]).status().unwrap();
        assert!(sent.success());
    }

    fn until(what: &str, mut done: impl FnMut() -> bool) {
        let began = Instant::now();
        while !done() {
            std::thread::sleep(Duration::from_millis(10));
            assert!(
                began.elapsed() < Duration::from_secs(60),
                "{what} does not come"
            );
        }
    }

    fn lines(bench: &Bench, file: &str) -> usize {
        std::fs::read_to_string(bench.path(file)).map_or(0, |text| text.lines().count())
    }

    #[test]
    fn ctrl_c_lets_the_robot_down() {
        let bench = Bench::new();
        let balance = spawn(&bench, &line("", "--record run.csv"));
        until("the recording", || lines(&bench, "run.csv") > 100);
        signal("-INT", &balance);
        let ended = balance.wait_with_output().unwrap();
        assert_eq!(ended.status.code(), Some(0), "{ended:?}");
        let data: serde_json::Value = serde_json::from_slice(&ended.stdout).unwrap();
        assert_eq!(data["ended"], "interrupted");
    }

    /// A line that is no attitude is named; the robot is let go.
    #[test]
    fn lines_on_standard_input_are_read() {
        use std::io::Write as _;
        let bench = Bench::new();
        let mut command = line("", "--seconds 2 --attitude lines");
        command = command.replace("--json", "");
        let mut child = Command::new(env!("CARGO_BIN_EXE_handstand"));
        let child = child
            .args(command.split_whitespace())
            .current_dir(bench.path("."));
        let child = child
            .stdin(Stdio::piped())
            .stderr(Stdio::piped())
            .env("NO_COLOR", "1");
        let mut balance = child.spawn().unwrap();
        let mut input = balance.stdin.take().unwrap();
        input.write_all(b"0 0\n0.1 tilted\n").unwrap();
        drop(input);
        let ended = balance.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(3), "{said}");
        assert!(said.contains("stdin:2:1"), "{said}");
    }

    /// Over a pseudo terminal in real time, with the gyro: a program that dies in the middle leaves
    /// a robot that is let down.
    #[test]
    fn a_killed_program_leaves_torque_off() {
        let bench = Bench::new();
        let serve = format!(
            "virtual --pty --cm5 ids=1-18,delay=0,start=held --robot {MODEL} --log truth.csv \
             --seconds 60"
        );
        let mut robot = spawn(&bench, &serve);
        let mut port = String::new();
        BufReader::new(robot.stdout.take().unwrap())
            .read_line(&mut port)
            .unwrap();
        let balanced = format!(
            "balance {MODEL} --port {} --gyro-per-code 0.0174533 --countdown 0 --yes",
            port.trim()
        );
        let mut balance = spawn(&bench, &balanced);
        // The last column but the supply: whether torque is on in the hip.
        let torque = || {
            let log = std::fs::read_to_string(bench.path("truth.csv")).unwrap_or_default();
            let whole = log.rfind('\n').map_or("", |end| &log[..end]);
            let field = whole
                .lines()
                .last()
                .and_then(|row| row.split(',').nth_back(1));
            field == Some("1")
        };
        // On a machine that is busy with other tests a reading may be too old to arm by: once more.
        until("torque", || {
            if balance.try_wait().unwrap().is_some() {
                balance = spawn(&bench, &balanced);
            }
            torque()
        });
        balance.kill().unwrap();
        balance.wait().unwrap();
        until("the let-down", || !torque());
        robot.kill().unwrap();
        robot.wait().unwrap();
    }
}
