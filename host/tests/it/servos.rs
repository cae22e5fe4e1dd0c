//! Servos of Protocol 2.0 by the program itself.

use crate::common::Bench;
use serde_json::json;

const SIM: &str = "sim:model=XL330-M288,ids=1-3,delay=0";

#[test]
fn a_scan_says_which_protocol_each_servo_speaks() {
    let bench = Bench::new();
    let found = bench.run(&format!("bus scan --port {SIM} --json")).json();
    let of = |key: &str| {
        found
            .as_array()
            .unwrap()
            .iter()
            .map(|s| s[key].clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(of("id"), [1, 2, 3]);
    assert_eq!(of("protocol"), ["2.0", "2.0", "2.0"]);
    assert_eq!(of("model"), [1200, 1200, 1200]);
    let one = bench
        .run("bus scan --port sim:ids=1-2 --ids 1-3 --json")
        .json();
    assert_eq!(one[0]["protocol"], "1.0");
    let none = bench.run(&format!("bus scan --protocol 1 --ids 1-3 --port {SIM}"));
    assert_eq!(none.code, Some(4), "{none:?}");
}

#[test]
fn registers_have_names_units_and_refusals() {
    let bench = Bench::new();
    let all = bench.run(&format!("bus read 2 --port {SIM} --json")).json();
    let named = |name: &str| {
        let mut rows = all.as_array().unwrap().iter();
        rows.find(|row| row["register"] == name).unwrap().clone()
    };
    assert_eq!(named("present position")["code"], 2048);
    assert_eq!(named("present position")["unit"], "rad");
    assert_eq!(named("current limit")["value"], 1.75);
    let wrote = bench.run(&format!("bus write 2 homing-offset -5 --port {SIM}"));
    assert_eq!(
        wrote.stdout, "servo 2: homing offset 0 -> -5\n",
        "{wrote:?}"
    );
    for (line, code, said) in [
        ("bus write 2 goal-position 5000", 4, "data limit"),
        ("bus write 2 led 2", 2, "give 0 to 1"),
        ("bus write 2 moving 1", 2, "can only be read"),
        ("bus read 2 goal_positon", 2, "did you mean `goal position`"),
        ("bus read 9 --protocol 2", 4, "servo 9: no status packet"),
        ("bus read 2 --protocol 3", 2, "give 1 or 2"),
        ("bus reboot 1 --protocol 1", 2, "cannot restart it"),
    ] {
        let ran = bench.run(&format!("{line} --port {SIM}"));
        assert_eq!(ran.code, Some(code), "{line}: {ran:?}");
        assert!(ran.stderr.contains(said), "{line}: {ran:?}");
    }
    let ax = bench.run("bus reboot 1 --port sim:ids=1");
    assert_eq!(ax.code, Some(2), "{ax:?}");
}

#[test]
fn settings_are_saved_restored_and_a_shutdown_rebooted() {
    let bench = Bench::new();
    let saved = bench.run(&format!("bus backup all.toml --port {SIM} --ids 1-3"));
    assert_eq!(saved.code, Some(0), "{saved:?}");
    let other = "sim:model=XL330-M288,ids=1-3,delay=100,mode=4";
    let did = bench
        .run(&format!("bus restore all.toml --port {other} --json"))
        .json();
    let expected = json!({ "id": 1, "register": "return delay time", "before": 100, "code": 0 });
    assert_eq!(did["changes"][0], expected);
    assert_eq!(did["changes"].as_array().unwrap().len(), 6, "{did}");
    let model = bench.run("bus restore all.toml --port sim:model=xl430,ids=1-3");
    assert!(model.stderr.contains("another model"), "{model:?}");
    let sick = "--port sim:model=XL330-M288,ids=1-2,delay=0,overload=2";
    let doctor = bench.run(&format!("bus doctor --ids 1-2 {sick}"));
    assert_eq!(doctor.code, Some(1));
    assert!(doctor.stdout.contains("bus reboot 2"), "{doctor:?}");
    let rebooted = bench.run(&format!("bus reboot 2 {sick} --json")).json();
    assert_eq!(rebooted, json!([{ "id": 2, "error_flags": [] }]));
}

#[test]
fn a_motion_is_repeated_under_the_bus_watchdog_and_recorded_with_currents() {
    let bench = Bench::new();
    let mut motion = String::from("time_s,goal1_rad,goal2_rad\n");
    for step in 0..50 {
        let time_s = 0.01 * f64::from(step);
        motion += &format!("{time_s},{},{}\n", 0.2 * time_s, -0.2 * time_s);
    }
    bench.put("motion.csv", motion);
    let line = format!("replay motion.csv --yes --record run.csv --port {SIM} --json");
    let ran = bench.run(&line);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let said = ran.json();
    assert_eq!(
        (&said["way"], &said["watchdog"]),
        (&json!("adapter"), &json!(true))
    );
    assert!(said["tracking_rms_rad"].as_f64().unwrap() < 0.05, "{said}");
    let run = bench.get("run.csv");
    assert!(
        run.lines().next().unwrap().contains(",current1_a,"),
        "{run}"
    );
    assert!(ran.stderr.contains("bus watchdog stops them"), "{ran:?}");
    let without = bench.run(&format!("{line} --force --no-watchdog"));
    assert_eq!(without.json()["watchdog"], false, "{without:?}");
    let wrong = bench.run("replay motion.csv --yes --port sim:model=xl430,ids=1-2,mode=16");
    assert_eq!(wrong.code, Some(4), "{wrong:?}");
    assert!(wrong.stderr.contains("operating mode 16"), "{wrong:?}");
    let recorded = bench.run(&format!(
        "record a.mcap --ids 1-3 --seconds 0.2 --port {SIM} --json"
    ));
    assert_eq!(recorded.json()["missing"], 0, "{recorded:?}");
}

#[test]
fn rounds_are_judged_against_the_lines_limit() {
    let bench = Bench::new();
    for (baud, code) in [(1_000_000, 3), (4_000_000, 6)] {
        let port = format!("sim:model=XL330-M288,delay=0,turnaround=0,baud={code}");
        let ran = bench.run(&format!("latency --port {port} --baud {baud} --json"));
        let said = ran.json();
        let (round, limit) = (&said["round_us"]["median"], &said["limit_us"]);
        let share = round.as_f64().unwrap() / limit.as_f64().unwrap();
        // Times are sums of many bytes': equal but for their rounding.
        assert!((0.9999..1.05).contains(&share), "{ran:?}");
    }
}

#[test]
fn a_monitor_shows_currents() {
    let bench = Bench::new();
    let line = format!("bus monitor --ids 1-2 --rounds 2 --port {SIM} --json");
    let rounds = bench.run(&line).json();
    assert_eq!(rounds[1]["servos"][0]["current_a"], 0.0);
    assert_eq!(rounds[1]["servos"][1]["temperature_celsius"], 30);
}
