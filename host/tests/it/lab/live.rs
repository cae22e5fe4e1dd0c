//! The robot at a port, watched from a page while it is recorded or balanced.

use super::events::Watcher;
use super::server::LabServer;
use crate::common::Bench;
use serde_json::{Value, json};
use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/models/handstand.toml");

/// A lab with the robot with ideal servos, held upright until torque comes on.
fn lab(bench: &Bench) -> LabServer {
    let robot = format!("--robot sim-cm5:robot={MODEL},start=held,lean=1/-1/1");
    bench.lab(&format!("{MODEL} {robot}"))
}

fn balance(seconds: impl Into<Value>) -> Value {
    json!({ "what": "balance", "seconds": seconds.into(), "countdown_s": 0.1, "torque": 1.0 })
}

fn logs(server: &LabServer) -> Vec<String> {
    let saved = server.get("/s/1/download/session.json").json();
    let logs = saved["logs"].as_array().unwrap().iter();
    logs.map(|log| log["file"].as_str().unwrap().to_string())
        .collect()
}

#[test]
fn what_is_recorded_is_seen_live_and_becomes_a_log() {
    let bench = Bench::new();
    let server = bench.lab("--robot sim:ids=1-2,delay=0 --ids 1-2");
    let page = Watcher::new(&server);
    let begun = Instant::now();
    assert_eq!(
        page.begin(&json!({ "what": "record", "seconds": 1.0 })),
        200
    );
    let running = page.runs("recording");
    assert_eq!(running["charts"][1]["title"], "servo 2");
    let ended = page.phase("ended");
    let took = begun.elapsed();
    assert!(
        took > Duration::from_millis(900),
        "simulated time is shown as it passes: {took:?}"
    );
    assert_eq!(ended["log"], "robot.csv");
    let samples = page.all("samples");
    assert!(samples.len() > 10, "{} messages", samples.len());
    let last = samples.last().unwrap();
    assert_eq!(last["values"].as_array().unwrap().len(), 2);
    assert!(last["supply_v"].is_f64(), "{last}");
    assert_eq!(logs(&server), ["robot.csv"]);
    let (meta, arrays) = server.get("/s/1/raw?file=robot.csv").curves();
    assert!(meta["names"].to_string().contains("q1_rad"), "{meta}");
    let sent: usize = samples
        .iter()
        .map(|s| s["time_s"].as_array().unwrap().len())
        .sum();
    assert!(
        sent <= arrays[0].1.len() && sent > 80,
        "{sent} of {}",
        arrays[0].1.len()
    );
}

#[test]
fn a_robot_balances_after_the_questions_and_is_let_down() {
    let bench = Bench::new();
    let server = lab(&bench);
    let page = Watcher::new(&server);
    assert_eq!(page.begin(&balance(1.0)), 200);
    let first = page.phase("asking")["question"].to_string();
    assert!(first.contains("without power"), "{first}");
    assert!(
        page.all("samples").is_empty(),
        "nothing moves before the answer"
    );
    page.agrees_to_all();
    let questions: Vec<String> = page
        .all("phase")
        .iter()
        .filter_map(|phase| phase["question"].as_str().map(String::from))
        .collect();
    assert!(
        questions.iter().any(|q| q.contains("upright and straight")),
        "{questions:?}"
    );
    let ended = page.phase("ended");
    assert!(
        ended["said"]
            .as_str()
            .unwrap()
            .starts_with("balanced for 1."),
        "{ended}"
    );
    let links = page.until("samples", |samples| samples["link_rad"][2].is_f64());
    let first = links["link_rad"][0].as_f64().unwrap();
    assert!(
        (first - std::f64::consts::PI).abs() < 0.1,
        "upright: {first}"
    );
    assert_eq!(logs(&server), ["robot.csv"]);
    // The same seconds as the command line balances.
    let line = format!(
        "balance {MODEL} --port sim-cm5:robot={MODEL},start=held,lean=1/-1/1 \
         --yes --countdown 0.1 --seconds 1 --record line.csv"
    );
    assert_eq!(bench.run(&line).code, Some(0));
    let recorded = std::fs::read_to_string(bench.path("sessions/1/logs/robot.csv")).unwrap();
    assert_eq!(recorded, bench.get("line.csv"), "byte for byte");
}

#[test]
fn nothing_moves_without_an_agreement_of_the_page_that_asked() {
    let bench = Bench::new();
    let server = lab(&bench);
    let page = Watcher::new(&server);
    let other = Watcher::new(&server);
    let stranger = json!({ "viewer": 99, "task": balance(1.0) });
    assert_eq!(server.post("/s/1/live/begin", &stranger).status, 409);
    for wrong in [
        json!({ "what": "balance", "seconds": 1, "countdown_s": 1, "torque": 7 }),
        json!({ "what": "record", "seconds": -1 }),
    ] {
        assert_eq!(page.begin(&wrong), 422, "{wrong}");
    }
    assert_eq!(page.begin(&balance(1.0)), 200);
    page.phase("asking");
    assert_eq!(other.begin(&balance(1.0)), 409, "one run at a time");
    assert_eq!(other.answer(true), 409, "it is not its question");
    assert_eq!(page.answer(false), 200);
    let ended = page.phase("ended");
    assert!(
        ended["said"].as_str().unwrap().contains("not agreed to"),
        "{ended}"
    );
    assert!(ended["log"].is_null() && logs(&server).is_empty());
    assert!(page.all("samples").is_empty());
}

#[test]
fn stop_lets_the_robot_down() {
    let bench = Bench::new();
    let server = lab(&bench);
    let page = Watcher::new(&server);
    assert_eq!(page.begin(&balance(Value::Null)), 200);
    page.agrees_to_all();
    assert_eq!(server.post("/s/1/live/stop", &json!({})).status, 200);
    let ended = page.phase("ended");
    assert!(
        ended["said"].as_str().unwrap().contains("balanced for"),
        "{ended}"
    );
}

/// A page that is closed, and one that hangs, leave a robot without torque.
#[test]
fn a_page_that_goes_away_lets_the_robot_down() {
    let bench = Bench::new();
    let server = lab(&bench);
    let other = Watcher::new(&server);
    for closes in [true, false] {
        let page = Watcher::new(&server);
        let before = other.all("phase").len();
        assert_eq!(page.begin(&balance(Value::Null)), 200);
        page.agrees_to_all();
        if closes {
            page.goes()
        } else {
            page.hangs();
            page.phase("ended");
        }
        let begun = Instant::now();
        while !other.all("phase")[before..]
            .iter()
            .any(|phase| phase["phase"] == "ended")
        {
            assert!(
                begun.elapsed() < Duration::from_secs(60),
                "closed: {closes}"
            );
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

#[test]
fn a_lab_without_a_robot_says_how_to_name_one() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv");
    assert!(
        server
            .get("/s/1/robot")
            .text()
            .contains("--robot /dev/ttyUSB0")
    );
    assert_eq!(server.get("/s/1/live").status, 404);
    assert_eq!(server.post("/s/1/live/stop", &json!({})).status, 404);
}

/// Over a pseudo terminal in real time: a lab that is ended, or dies, leaves a robot without
/// torque.
#[cfg(unix)]
#[test]
fn a_lab_that_ends_leaves_torque_off() {
    for end in ["-TERM", "-KILL"] {
        // A robot that is simulated as time passes falls where the machine has too little of it.
        assert!((0..4).any(|_| is_let_down_after(end)), "torque never came");
    }
}

/// Ends a lab while torque is on, and waits for torque to go; false where the run was over before.
#[cfg(unix)]
fn is_let_down_after(end: &str) -> bool {
    let bench = Bench::new();
    let words = format!(
        "virtual --pty --cm5 ids=1-18,delay=0,start=held --robot {MODEL} --log truth.csv \
         --seconds 60"
    );
    let mut robot = Owned(
        Command::new(env!("CARGO_BIN_EXE_handstand"))
            .args(words.split_whitespace())
            .current_dir(bench.path("."))
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap(),
    );
    let mut port = String::new();
    let out = robot.0.stdout.take().unwrap();
    BufReader::new(out).read_line(&mut port).unwrap();
    let words = format!("{MODEL} --robot {} --gyro-per-code 0.0174533", port.trim());
    let server = bench.lab(&words);
    let page = Watcher::new(&server);
    assert_eq!(page.begin(&balance(Value::Null)), 200);
    page.agrees_to_all();
    let is_over = || {
        let phases = page.all("phase");
        phases
            .iter()
            .any(|phase| phase["phase"] == "ended" || phase["phase"] == "failed")
    };
    until("torque", || torque(&bench) || is_over());
    if !torque(&bench) {
        return false;
    }
    let signalled = Command::new("kill")
        .args([end, &server.id().to_string()])
        .status();
    assert!(signalled.unwrap().success());
    until("the let-down", || !torque(&bench));
    true
}

/// A child that does not outlive the test.
struct Owned(Child);

impl Drop for Owned {
    fn drop(&mut self) {
        // It may be over before it is ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Whether torque is on in the hip: the last column of the true states but the supply.
fn torque(bench: &Bench) -> bool {
    let log = std::fs::read_to_string(bench.path("truth.csv")).unwrap_or_default();
    let whole = log.rfind('\n').map_or("", |end| &log[..end]);
    let last = whole.lines().last();
    last.and_then(|row| row.split(',').nth_back(1)) == Some("1")
}

fn until(what: &str, mut done: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !done() {
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "{what} does not come"
        );
        std::thread::sleep(Duration::from_millis(10));
    }
}
