//! `bus`, `latency`, `virtual` over simulated servos.

use crate::common::Bench;

#[test]
fn a_scan_finds_who_is_there() {
    let bench = Bench::new();
    let found = bench.run("bus scan --port sim:ids=1-3+200,dead=2 --json");
    assert_eq!(found.code, Some(0), "{found:?}");
    let ids: Vec<u64> = found
        .json()
        .as_array()
        .unwrap()
        .iter()
        .map(|servo| servo["id"].as_u64().unwrap())
        .collect();
    assert_eq!(ids, [1, 3, 200]);
    let through = bench.run("bus scan --port sim-cm5:ids=1-3 --ids 1-5 --json");
    assert_eq!(through.json().as_array().unwrap().len(), 3, "{through:?}");
    let silent = bench.run("bus scan --port sim:dead=1-18 --ids 1-18");
    assert_eq!(silent.code, Some(4), "{silent:?}");
    assert!(silent.stderr.contains("bus doctor"), "{silent:?}");
}

/// One that answers a ping and no reading ends no scan, and the remedy that the doctor gives helps.
#[test]
fn a_scan_lists_what_answers_a_ping_only_with_the_reason() {
    let bench = Bench::new();
    let mute = bench.run("bus scan --port sim:ids=1-3,level=0 --ids 1-5 --json");
    assert_eq!(mute.code, Some(0), "{mute:?}");
    let servos = mute.json();
    assert_eq!(servos.as_array().unwrap().len(), 3, "{mute:?}");
    for servo in servos.as_array().unwrap() {
        assert!(servo["position_rad"].is_null(), "{mute:?}");
        let fault = servo["fault"].as_str().unwrap();
        assert!(fault.contains("status level"), "{mute:?}");
    }
    let shown = bench.run("bus scan --port sim:ids=1-3,level=0 --ids 1-5");
    assert!(
        shown
            .stderr
            .contains("id 2: it answers PING, but no reading"),
        "{shown:?}"
    );
    let mended = bench.run("bus write 1 status-return-level 1 --port sim:ids=1,level=0");
    assert_eq!(
        mended.stdout, "servo 1: status return level ? -> 1\n",
        "{mended:?}"
    );
    let setup = bench.run("bus setup --port sim:ids=1-3,level=0 --ids 1-3");
    assert_eq!(setup.code, Some(4), "{setup:?}");
}

#[test]
fn two_servos_of_one_id_are_told_and_not_renamed() {
    let bench = Bench::new();
    for model in ["", "model=XL330-M288,"] {
        let port = format!("sim:{model}ids=1-4+3,delay=0");
        let scan = bench.run(&format!("bus scan --port {port} --json"));
        let servos = scan.json();
        let sound = servos.as_array().unwrap().iter();
        let sound = sound.filter(|servo| servo["fault"].is_null());
        assert_eq!(sound.count(), 3, "{scan:?}");
        let lines: Vec<&str> = (scan.stderr.lines())
            .filter(|line| line.contains("id 3:"))
            .collect();
        assert_eq!(lines.len(), 1, "{scan:?}");
        assert!(lines[0].contains("two servos of"), "{scan:?}");
        let doctor = bench.run(&format!("bus doctor --port {port}"));
        assert_eq!(doctor.code, Some(1), "{doctor:?}");
        assert!(
            doctor.stdout.starts_with("1. two servos have the id 3"),
            "{doctor:?}"
        );
        let alone = format!("sim:{model}ids=3+3,delay=0");
        for port in [&port, &alone] {
            let renamed = bench.run(&format!("bus setup --port {port} --new-id 7"));
            assert_eq!(renamed.code, Some(4), "{renamed:?}");
            assert!(!renamed.stderr.contains("ready"), "{renamed:?}");
        }
    }
}

/// At a wrong speed each ping makes noise: it is told in a line, not in one of each id.
#[test]
fn noise_is_told_in_one_line() {
    let bench = Bench::new();
    let noise = bench.run("bus scan --port sim:ids=1-9,flip=1 --ids 1-9");
    assert_eq!(noise.code, Some(4), "{noise:?}");
    let told = noise
        .stderr
        .lines()
        .filter(|line| line.contains("no sound answer"));
    assert_eq!(told.count(), 1, "{noise:?}");
    assert!(noise.stderr.contains("ids 1-9: bytes came"), "{noise:?}");
}

#[test]
fn registers_are_read_and_written_by_name() {
    let bench = Bench::new();
    let all = bench.run("bus read 3 --port sim --json").json();
    assert_eq!(all.as_array().unwrap().len(), 32);
    assert_eq!(all[0]["code"], 12);
    let write = bench.run("bus write 3 moving_speed 100 --port sim");
    assert_eq!(write.code, Some(0), "{write:?}");
    assert_eq!(write.stdout, "servo 3: moving speed 0 -> 100\n");
    for (line, code, said) in [
        (
            "bus write 3 moving_speeed 100 --port sim",
            2,
            "did you mean `moving speed`",
        ),
        (
            "bus write 3 present-position 100 --port sim",
            2,
            "can only be read",
        ),
        ("bus write 3 led 2 --port sim", 2, "give 0 to 1"),
        ("bus read 99 --port sim", 4, "servo 99: no status packet"),
        ("bus read 3 --port sim:idz=3", 2, "`idz` is no key"),
        ("bus read 3 --port /dev/absent", 4, "there is no such port"),
        ("bus read 3 --port sim --baud 57600", 4, "no status packet"),
    ] {
        let ran = bench.run(line);
        assert_eq!(ran.code, Some(code), "{line}: {ran:?}");
        assert!(
            ran.stderr.contains(said) && !ran.stderr.contains("bug"),
            "{line}: {ran:?}"
        );
    }
}

#[test]
fn setup_makes_100_hz_possible_and_gives_ids_one_by_one() {
    let bench = Bench::new();
    let ran = bench.run("bus setup --port sim:ids=1-3 --ids 1-5 --json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(
        ran.json()["changes"].as_array().unwrap().len(),
        6,
        "{ran:?}"
    );
    let named = bench.run("bus setup --port sim:ids=1 --new-id 7 --json");
    assert_eq!(named.json()["ids"], serde_json::json!([7]), "{named:?}");
    let two = bench.run("bus setup --port sim:ids=1-2 --new-id 7");
    assert_eq!(two.code, Some(2), "{two:?}");
    assert!(two.stderr.contains("2 servos answer"), "{two:?}");
}

#[test]
fn settings_are_saved_and_only_what_differs_is_restored() {
    let bench = Bench::new();
    let saved = bench.run("bus backup all.toml --port sim:ids=1-2 --ids 1-3");
    assert_eq!(saved.code, Some(0), "{saved:?}");
    let same = bench.run("bus restore all.toml --port sim:ids=1-2 --json");
    assert_eq!(same.json()["changes"], serde_json::json!([]), "{same:?}");
    let line = "bus restore all.toml --port sim:ids=1-2,delay=0 --json";
    let would = bench.run(&format!("{line} --dry-run")).json();
    let did = bench.run(line).json();
    assert_eq!(
        (&would["written"], &did["written"]),
        (&false.into(), &true.into())
    );
    assert_eq!(
        did["changes"][1],
        serde_json::json!({ "id": 2, "register": "return delay time", "before": 0, "code": 250 })
    );
    assert_eq!(would["changes"], did["changes"]);
    let absent = bench.run("bus restore all.toml --port sim:ids=1");
    assert_eq!(absent.code, Some(4), "{absent:?}");
    bench.put(
        "all.toml",
        bench.get("all.toml").replacen("= 250", "= 900", 1),
    );
    let bad = bench.run("bus restore all.toml --port sim:ids=1-2");
    assert_eq!(bad.code, Some(3), "{bad:?}");
    assert!(
        bad.stderr
            .contains("all.toml:8:1: `return_delay_time` cannot be 900"),
        "{bad:?}"
    );
    assert_eq!(
        bench.run("bus backup all.toml --port sim --ids 1").code,
        Some(2),
        "it exists"
    );
}

#[test]
fn the_doctor_names_the_cause_and_says_no() {
    let bench = Bench::new();
    let well = bench.run("bus doctor --port sim:ids=1-3,delay=0 --ids 1-3");
    assert_eq!(well.code, Some(0), "{well:?}");
    let sick = bench.run("bus doctor --port sim:ids=1-3,delay=0,dead=2 --ids 1-3 --json");
    assert_eq!(sick.code, Some(1), "{sick:?}");
    assert!(
        sick.json()["causes"][0]["cause"]
            .as_str()
            .unwrap()
            .starts_with("servo 2 is not there")
    );
    let some = bench.run("bus doctor --port sim:ids=1-3,delay=0");
    assert_eq!(some.code, Some(0), "{some:?}");
    assert!(
        some.stderr.contains("servos 1-3 answer, of ids 1-18"),
        "{some:?}"
    );
    let unpowered = bench.run("bus doctor --port sim-cm5:ids=1-3,dead=1-3 --ids 1-3");
    assert!(
        unpowered
            .stdout
            .contains("1. the CM-5 is well, the servos behind it are silent"),
        "{unpowered:?}"
    );
}

#[test]
fn a_monitor_shows_rounds_and_marks_the_silent() {
    let bench = Bench::new();
    let rounds = bench
        .run("bus monitor --port sim:ids=1-2,dead=2,supply=9.6 --ids 1-2 --rounds 3 --json")
        .json();
    assert_eq!(rounds.as_array().unwrap().len(), 3);
    let servos = &rounds[2]["servos"];
    assert_eq!(
        (servos[0]["supply_v"].as_f64().unwrap() * 10.0).round(),
        96.0
    );
    assert_eq!(servos[1]["error_flags"], serde_json::json!(["silent"]));
}

#[test]
fn latency_judges_against_the_sampling_time() {
    let bench = Bench::new();
    let quick = bench.run("latency --port sim:delay=0 --json");
    assert_eq!(quick.code, Some(0), "{quick:?}");
    let round_us = quick.json()["round_us"]["median"].as_f64().unwrap();
    assert!((3_000.0..9_000.0).contains(&round_us), "{round_us}");
    let slow = bench.run("latency --port sim --json");
    assert_eq!(slow.code, Some(1), "the factory's return delay: {slow:?}");
    let line = bench.run("latency --port sim-cm5:delay=0 --json");
    assert_eq!(
        line.code,
        Some(1),
        "18 servos one by one over 57600 baud: {line:?}"
    );
    let stream = bench.run("latency --port sim-cm5:delay=0 --stream --json");
    assert_eq!(stream.code, Some(0), "{stream:?}");
    let round_us = stream.json()["round_us"]["median"].as_f64().unwrap();
    assert!((9_500.0..10_500.0).contains(&round_us), "{round_us}");
}

#[test]
fn a_tap_writes_what_passed() {
    let bench = Bench::new();
    bench.run("bus read 1 id --port sim:ids=1 --tap bytes.txt");
    assert!(
        bench
            .get("bytes.txt")
            .contains(" > ff ff 01 04 02 03 01 f4\n"),
        "{}",
        bench.get("bytes.txt")
    );
}

/// Two programs and a pseudo terminal between them.
#[cfg(unix)]
mod over_a_terminal {
    use crate::common::Bench;
    use std::io::{BufRead as _, BufReader};
    use std::process::{Child, Command, Stdio};

    pub struct Virtual(Child, pub String);

    impl Virtual {
        pub fn start(words: &[&str]) -> Self {
            let mut child = Command::new(env!("CARGO_BIN_EXE_handstand"))
                .args(["virtual", "--pty", "--seconds", "60", "--quiet"])
                .args(words)
                .stdout(Stdio::piped())
                .spawn()
                .unwrap();
            let mut port = String::new();
            BufReader::new(child.stdout.take().unwrap())
                .read_line(&mut port)
                .unwrap();
            Virtual(child, port.trim().to_string())
        }
    }

    impl Drop for Virtual {
        fn drop(&mut self) {
            let _ = self.0.kill();
            let _ = self.0.wait();
        }
    }

    #[test]
    fn a_virtual_adapter_serves_another_program() {
        let robot = Virtual::start(&["ids=1-3,delay=0"]);
        let bench = Bench::new();
        let port = &robot.1;
        let found = bench.run(&format!(
            "bus scan --port {port} --baud 1000000 --ids 1-4 --json"
        ));
        assert_eq!(found.json().as_array().unwrap().len(), 3, "{found:?}");
        let wrong = bench.run(&format!(
            "bus doctor --port {port} --baud 57600 --ids 1 --json"
        ));
        assert_eq!(wrong.code, Some(1), "{wrong:?}");
        let cause = wrong.json()["causes"][0]["cause"]
            .as_str()
            .unwrap()
            .to_string();
        assert!(cause.contains("answer at 1000000 baud"), "{cause}");
    }

    #[test]
    fn a_virtual_cm5_is_an_adapter_and_a_stream() {
        let robot = Virtual::start(&["--cm5", "ids=1-3,delay=0"]);
        let bench = Bench::new();
        let port = &robot.1;
        let read = bench.run(&format!("bus read 2 model-number --port {port} --json"));
        assert_eq!(read.json()[0]["code"], 12, "{read:?}");
        let ran = bench.run(&format!(
            "record r.csv --stream --seconds 1 --ids 1-3 --port {port} --json"
        ));
        assert_eq!(ran.code, Some(0), "{ran:?}");
        let rate = ran.json()["rate_hz"].as_f64().unwrap();
        assert!((80.0..110.0).contains(&rate), "{rate}");
        let after = bench.run(&format!("bus read 2 id --port {port} --json"));
        assert_eq!(
            after.json()[0]["code"],
            2,
            "it is an adapter again: {after:?}"
        );
    }
}
