//! Recorders that are killed or stopped lose little, and leave torque off.

use crate::common::Bench;
use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

fn spawn(bench: &Bench, words: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_handstand"));
    command.args(words).current_dir(bench.path("."));
    command
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

fn port_of(child: &mut Child) -> String {
    let mut port = String::new();
    BufReader::new(child.stdout.take().unwrap())
        .read_line(&mut port)
        .unwrap();
    port.trim().to_string()
}

/// `kill -9` in the middle: all but the last second is there, in both formats.
#[test]
fn a_killed_recorder_loses_a_second_at_most() {
    let bench = Bench::new();
    let mut robot = spawn(
        &bench,
        &["virtual", "--pty", "--seconds", "60", "ids=1-2,delay=0"],
    );
    let port = port_of(&mut robot);
    for file in ["r.csv", "r.mcap"] {
        let began = std::time::Instant::now();
        let words = [
            "record", file, "--port", &port, "--baud", "1000000", "--ids", "1-2", "--hz", "50",
        ];
        let mut recorder = spawn(&bench, &words);
        while !bench.path(file).exists() {
            std::thread::sleep(Duration::from_millis(5));
            assert!(
                began.elapsed() < Duration::from_secs(60),
                "{file} does not appear"
            );
        }
        let begun = std::time::Instant::now();
        std::thread::sleep(Duration::from_millis(2600));
        recorder.kill().unwrap();
        recorder.wait().unwrap();
        let recorded = begun.elapsed().as_secs_f64();
        let ran = bench.run(&format!("record {file}.csv --from {file} --json"));
        assert_eq!(ran.code, Some(0), "{file}: {ran:?}");
        let kept = ran.json()["seconds"].as_f64().unwrap();
        // A busy machine may start late by itself; what it wrote is what counts.
        assert!(kept > recorded - 1.6, "{file}: {kept} of {recorded} s");
        assert_eq!(ran.json()["torn"], file == "r.mcap", "{file}");
    }
    robot.kill().unwrap();
    robot.wait().unwrap();
}

/// Ctrl-C in the middle of a motion: torque goes off.
#[test]
fn ctrl_c_leaves_torque_off() {
    let bench = Bench::new();
    bench.put("motion.csv", super::motion(0.4));
    let mut robot = spawn(
        &bench,
        &["virtual", "--pty", "--seconds", "60", "ids=1-2,delay=0"],
    );
    let port = port_of(&mut robot);
    let words = [
        "replay",
        "motion.csv",
        "--port",
        &port,
        "--baud",
        "1000000",
        "--yes",
        "--record",
        "out.csv",
        "--hz",
        "50",
    ];
    let mut replay = spawn(&bench, &words);
    let torque = |code: u64| {
        let line = format!("bus read 1 torque-enable --port {port} --baud 1000000 --json");
        let read = bench.run(&line);
        assert_eq!(read.json()[0]["code"], code, "{read:?}");
    };
    while !bench.path("out.csv").exists() || bench.get("out.csv").lines().count() < 20 {
        std::thread::sleep(Duration::from_millis(20));
    }
    signal("-INT", &replay);
    assert_eq!(replay.wait().unwrap().code(), Some(5));
    torque(0);
    robot.kill().unwrap();
    robot.wait().unwrap();
}

/// Two Ctrl-C while the servos do not answer: the program ends at once, and torque goes off all
/// the same.
#[test]
fn a_second_ctrl_c_leaves_torque_off_too() {
    for (words, options, baud) in [
        (
            &["ids=1-2,delay=0"][..],
            &["--baud", "1000000", "--hz", "50"][..],
            1_000_000,
        ),
        (&["--cm5", "ids=1-2,delay=0"], &["--stream"], 57_600),
    ] {
        let counted = (0..10).any(|_| second_ctrl_c(words, options, baud));
        assert!(counted, "{words:?}: the keys never came first");
    }
}

/// One such try; false where the program found the servos silent or late before the keys came, as
/// it does on a busy machine.
fn second_ctrl_c(words: &[&str], options: &[&str], baud: u32) -> bool {
    let bench = Bench::new();
    bench.put("motion.csv", super::motion(0.4));
    let serve = ["virtual", "--pty", "--seconds", "60"];
    let mut robot = spawn(&bench, &[&serve, words].concat());
    let port = port_of(&mut robot);
    let follow = [
        "replay",
        "motion.csv",
        "--yes",
        "--record",
        "out.csv",
        "--port",
        &port,
    ];
    let mut replay = spawn(&bench, &[&follow, options].concat());
    while !bench.path("out.csv").exists() || bench.get("out.csv").lines().count() < 20 {
        if let Some(ended) = replay.try_wait().unwrap() {
            let busy = [Some(4), Some(5)].contains(&ended.code());
            assert!(busy, "{words:?}: it ended early, {ended:?}");
            robot.kill().unwrap();
            robot.wait().unwrap();
            return false;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    signal("-STOP", &robot);
    std::thread::sleep(Duration::from_millis(30));
    signal("-INT", &replay);
    std::thread::sleep(Duration::from_millis(5));
    signal("-INT", &replay);
    let code = replay.wait().unwrap().code();
    signal("-CONT", &robot);
    if code == Some(4) {
        robot.kill().unwrap();
        robot.wait().unwrap();
        return false;
    }
    assert_eq!(code, Some(5), "{words:?}");
    std::thread::sleep(Duration::from_millis(500));
    if baud == 57_600 {
        // It may have found the line silent, and stopped: greeted again it is an adapter
        // again.
        let line = format!("record after.csv --stream --seconds 0.1 --ids 1-2 --port {port}");
        assert_eq!(bench.run(&line).code, Some(0));
    }
    for id in 1..=2 {
        let line = format!("bus read {id} torque-enable --port {port} --baud {baud} --json");
        let read = bench.run(&line);
        assert_eq!(read.json()[0]["code"], 0, "{words:?}: {read:?}");
    }
    robot.kill().unwrap();
    robot.wait().unwrap();
    true
}

fn signal(name: &str, child: &Child) {
    let pid = child.id().to_string();
    let sent = Command::new("kill").args([name, &pid]).status().unwrap();
    assert!(sent.success());
}
