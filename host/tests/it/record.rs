//! `record` and `replay` over simulated servos; a recorder that is killed.

#[cfg(unix)]
mod killed;

use crate::common::Bench;

/// A motion of two servos: goals to and fro, 2 s at 50 Hz.
fn motion(largest_rad: f64) -> String {
    let names = |id: u8| {
        format!(
            "q{id}_rad,dq{id}_rad_s,load{id},goal{id}_rad,supply{id}_v,temperature{id}_celsius,error{id}"
        )
    };
    let mut text = format!("time_s,{},{}\n", names(1), names(2));
    for sample in 0..100 {
        let time_s = f64::from(sample) * 0.02;
        let goal = largest_rad * (2.0 * time_s).sin();
        text += &format!("{time_s:.6},{goal:.6},,,{goal:.6},,,,0,,,{:.6},,,\n", -goal);
    }
    text
}

#[test]
fn both_formats_hold_the_same_and_turn_into_each_other() {
    let bench = Bench::new();
    for line in [
        "record r1.mcap --seconds 1 --port sim:ids=1-2,delay=0 --ids 1-2",
        "record r2.csv --from r1.mcap",
        "record r3.mcap --from r2.csv",
        "record r4.csv --from r3.mcap",
    ] {
        let ran = bench.run(line);
        assert_eq!(ran.code, Some(0), "{line}: {ran:?}");
    }
    assert_eq!(bench.get("r2.csv").lines().count(), 102);
    assert_eq!(bench.get("r2.csv"), bench.get("r4.csv"));
    assert_eq!(
        bench.run("record r2.csv --port sim").code,
        Some(2),
        "it exists"
    );
    assert_eq!(
        bench.run("record b.txt --port sim").code,
        Some(2),
        "no such format"
    );
}

#[test]
fn a_recording_is_a_log_that_models_are_compared_with() {
    let bench = Bench::new();
    bench.run("record a.csv --seconds 2 --port sim:ids=1,delay=0 --ids 1 --force");
    bench.put(
        "model.toml",
        bench.get("model.toml").replace("angle_rad", "q1_rad"),
    );
    let check = bench.run("compare model.toml a.csv");
    assert_eq!(check.code, Some(0), "{check:?}");
}

/// A run through the firmware, read by `compare` with the model of a servo: what remains is little
/// more than the resolution, 1.5 mrad.
#[test]
fn a_run_through_the_firmware_is_what_its_model_says() {
    let bench = Bench::new();
    bench.put("motion.csv", motion(0.4));
    let line = "replay motion.csv --port sim-cm5:ids=1-2,delay=0 --stream --yes --record run.csv";
    let ran = bench.run(line);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/models/bus_servo.toml");
    let compared = bench.run(&format!("compare {model} run.csv --json"));
    assert_eq!(compared.code, Some(0), "{compared:?}");
    let signal = &compared.json()["comparisons"][0]["signals"][0];
    let rms_rad = signal["rms_rad"].as_f64().unwrap();
    assert!((0.0005..0.0025).contains(&rms_rad), "{signal}");
    assert!(signal["fit_percent"].as_f64().unwrap() > 99.0, "{signal}");
}

#[test]
fn a_motion_is_followed_by_adapter_and_by_stream() {
    let bench = Bench::new();
    bench.put("motion.csv", motion(0.4));
    for (port, way) in [
        ("--port sim:ids=1-2,delay=0", "adapter"),
        ("--port sim-cm5:ids=1-2,delay=0", "stream"),
        ("--port sim-cm5:ids=1-2,delay=0 --stream", "stream"),
    ] {
        let ran = bench.run(&format!(
            "replay motion.csv {port} --yes --record out.csv --force --json"
        ));
        assert_eq!(ran.code, Some(0), "{port}: {ran:?}");
        let data = ran.json();
        assert_eq!(data["way"], way, "{port}");
        assert_eq!(data["stopped"], serde_json::Value::Null);
        // A servo drags behind its goal by some 50 ms; the motion's fastest is 0.8 rad/s.
        let error = data["tracking_rms_rad"].as_f64().unwrap();
        assert!((0.001..0.08).contains(&error), "{port}: {error}");
        assert!(
            (1.9..2.1).contains(&data["seconds"].as_f64().unwrap()),
            "{port}: {data}"
        );
        assert!(bench.get("out.csv").lines().count() > 150, "{port}");
    }
    let unasked = bench.run("replay motion.csv --port sim");
    assert_eq!(unasked.code, Some(2), "{unasked:?}");
    assert!(unasked.stderr.contains("--yes"), "{unasked:?}");
}

#[test]
fn a_servo_in_danger_stops_the_robot_with_torque_off() {
    let bench = Bench::new();
    bench.put("motion.csv", motion(0.4));
    let ran = bench
        .run("replay motion.csv --port sim:ids=1-2,hot=2,delay=0 --yes --json --tap bytes.txt");
    assert_eq!(ran.code, Some(5), "{ran:?}");
    assert!(
        ran.json()["stopped"]
            .as_str()
            .unwrap()
            .contains("servo 2 reports: overheat"),
        "{ran:?}"
    );
    // The last words on the bus: WRITE torque enable 0, to all.
    let bytes = bench.get("bytes.txt");
    let last = bytes.lines().rfind(|line| line.contains('>')).unwrap();
    assert!(last.ends_with("> ff ff fe 04 03 18 00 e2"), "{last}");
}

#[test]
fn a_low_supply_is_refused_by_the_cm5() {
    let bench = Bench::new();
    bench.put("motion.csv", motion(0.2));
    let ran = bench.run("replay motion.csv --port sim-cm5:ids=1-2,delay=0,supply=8 --stream --yes");
    assert_eq!(ran.code, Some(4), "{ran:?}");
    assert!(ran.stderr.contains("the supply is too low"), "{ran:?}");
}

#[test]
fn servos_that_do_not_answer_are_named_whichever_way_they_are_reached() {
    let bench = Bench::new();
    bench.put(
        "goals.csv",
        "time_s,goal1_rad,goal2_rad,goal11_rad,goal12_rad\n0,0,0,0,0\n1,0.1,-0.1,0.1,-0.1\n",
    );
    for port in ["sim-cm5:ids=1-2,delay=0", "sim:ids=1-2,delay=0"] {
        let ran = bench.run(&format!("replay goals.csv --yes --port {port} --json"));
        assert_eq!(ran.code, Some(4), "{port}: {ran:?}");
        assert!(ran.stderr.contains("servo 11: no status packet"), "{ran:?}");
        assert!(ran.stderr.contains("bus doctor"), "{ran:?}");
    }
    // A line that loses most answers: the errors are of what is left.
    let ran = bench.run("replay goals.csv --yes --port sim-cm5:delay=0,drop=0.5 --json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let silent = &ran.json()["silent"][0];
    assert_eq!(silent["servo"], 1, "{silent}");
    assert!(silent["missed_share"].as_f64().unwrap() > 0.05, "{silent}");
    assert!(ran.stderr.contains("warning: servo 1 "), "{ran:?}");
}

/// The servos of the robot's shoulder and hip.
const ROBOT_SERVOS: &str = "1+2/11+12";

fn virtual_robot() -> String {
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/models/robot.toml");
    format!("sim-cm5:ids=1-2+11-12,delay=0,drop=0.1,robot={model}")
}

/// No encoder at the bar, two servos to a joint, answers that are lost now and then: what the robot
/// records of itself is a log of its model all the same.
#[test]
fn the_robot_s_own_recording_is_a_log_of_its_model() {
    let bench = Bench::new();
    let written = bench.run(&format!(
        "excite goals.csv --joints {ROBOT_SERVOS} --motions multisine --seconds 12 --json"
    ));
    assert_eq!(written.code, Some(0), "{written:?}");
    assert_eq!(written.json()["joints"][1]["servos"][1], 12);
    let port = virtual_robot();
    let ran = bench.run(&format!(
        "replay goals.csv --yes --record log.csv --port {port}"
    ));
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let log = bench.get("log.csv");
    // Angles of the four servos.
    let is_gap = |row: &&str| {
        [1, 8, 15, 22]
            .map(|at| row.split(',').nth(at))
            .contains(&Some(""))
    };
    let gaps = log.lines().skip(1).filter(is_gap).count();
    assert!(gaps > 0, "no answer was lost");
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/models/robot_recording.toml");
    let compared = bench.run(&format!("compare {model} log.csv --horizon 1 --json"));
    assert_eq!(compared.code, Some(0), "{compared:?}");
    let comparison = &compared.json()["comparisons"][0];
    let said = comparison["unobserved"][0].as_str().unwrap();
    assert!(said.contains("Joint 1 has no measured angle"), "{said}");
    let signals = &comparison["signals"];
    assert!(signals[0]["rms_rad"].is_null());
    let near = |value: &serde_json::Value, most: f64| value.as_f64().unwrap() < most;
    // The floors are 5 mrad/s and 1.5 mrad.
    assert!(near(&signals[0]["rms_rad_s"], 0.007), "{signals}");
    assert!(near(&signals[1]["rms_rad"], 0.0017), "{signals}");
    assert!(near(&signals[2]["rms_rad"], 0.0017), "{signals}");
    // Rows are ticks, whatever made their reports late.
    let times = log.lines().skip(1).map(|row| row.split(',').next());
    let times: Vec<f64> = times.map(|time| time.unwrap().parse().unwrap()).collect();
    let uneven = times
        .windows(2)
        .filter(|pair| (pair[1] - pair[0] - 0.01).abs() > 2e-4);
    assert!(uneven.count() < 8, "{times:?}");
}

#[test]
fn a_drop_lets_the_servos_go_and_any_goals_are_played() {
    let bench = Bench::new();
    let written = bench.run(&format!(
        "excite drop.csv --joints {ROBOT_SERVOS} --motions drop --seconds 4"
    ));
    assert_eq!(written.code, Some(0), "{written:?}");
    let port = virtual_robot();
    let ran = bench.run(&format!(
        "replay drop.csv --yes --record log.csv --port {port}"
    ));
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let log = bench.get("log.csv");
    let torque: Vec<bool> = log.lines().skip(1).map(|row| row.ends_with(",1")).collect();
    let off = torque.iter().position(|on| !on).unwrap();
    assert!(
        off > 100 && torque.len() - off > 150,
        "{off} of {}",
        torque.len()
    );
    assert!(torque[off..].iter().all(|on| !on));
    let angle = |row: usize| -> f64 {
        let row = log.lines().nth(1 + row).unwrap();
        row.split(',').nth(1).unwrap().parse().unwrap_or(f64::NAN)
    };
    let before = (off - 5..off).map(angle).find(|q| q.is_finite()).unwrap();
    let fell = (off..torque.len()).map(angle).filter(|q| q.is_finite());
    let lowest = fell.fold(before, f64::min);
    assert!(before > 0.3 && lowest < before - 0.3, "{before} {lowest}");

    // Another program's goals, in an order of its own, with columns that mean nothing here.
    bench.put(
        "own.csv",
        "note,goal2_rad,time_s,goal1_rad\n1,0,0,0\n2,0.1,0.5,-0.1\n3,0.1,1,-0.1\n",
    );
    let ran = bench.run("replay own.csv --yes --port sim-cm5:ids=1-2,delay=0 --json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(ran.json()["seconds"].as_f64().unwrap() > 0.9);
    let refused = bench.run("excite x.csv --joints 1+2/2 --json");
    assert_eq!(refused.code, Some(2), "{refused:?}");
    assert!(
        refused.stderr.contains("servo 2 is named twice"),
        "{refused:?}"
    );
}

/// Without `--ids` absent servos cost no time and no columns.
#[test]
fn those_that_answer_are_recorded_without_ids() {
    let bench = Bench::new();
    for (port, kind) in [
        ("sim:ids=1-3,delay=0", ""),
        ("sim:model=XL330-M288,ids=1-3,delay=0", ""),
        ("sim-cm5:ids=1-3,delay=0", " --stream"),
    ] {
        let line = format!("record a.csv --force --seconds 1 --json --port {port}{kind}");
        let ran = bench.run(&line);
        assert_eq!(ran.code, Some(0), "{line}: {ran:?}");
        assert!(
            ran.json()["rate_hz"].as_f64().unwrap() > 95.0,
            "{line}: {ran:?}"
        );
        assert!(
            ran.json()["missing"].as_u64().unwrap() < 10,
            "{line}: {ran:?}"
        );
        let said = "servos 1-3 answer, of ids 1-18; --ids names others";
        assert!(ran.stderr.contains(said), "{line}: {ran:?}");
        let header = bench.get("a.csv").lines().next().unwrap().to_string();
        assert!(
            header.contains("q3_rad") && !header.contains("q4_rad"),
            "{line}: {header}"
        );
    }
    let nobody = bench.run("record nobody.csv --seconds 1 --port sim:ids=30");
    assert_eq!(nobody.code, Some(4), "{nobody:?}");
    // Servos beyond the ids that are asked are looked for by another command.
    for words in ["no servo of ids 1-18 answers", "bus scan", "--ids"] {
        assert!(nobody.stderr.contains(words), "{nobody:?}");
    }
    let monitor = bench.run("bus monitor --rounds 1 --port sim:ids=2+5 --json");
    assert_eq!(monitor.json()[0]["servos"].as_array().unwrap().len(), 2);
}

/// A servo that stands still does not make a good replay; `--ids` chooses among a motion's servos.
#[test]
fn a_replay_whose_servo_stands_still_says_no() {
    let bench = Bench::new();
    let row = |k: i32| {
        let t = f64::from(k) * 0.02;
        let goal = 0.3 * (4.0 * t).sin();
        format!("{t:.2},{goal:.4},{goal:.4}\n")
    };
    let rows: String = (0..30).map(row).collect();
    bench.put("m.csv", format!("time_s,goal1_rad,goal2_rad\n{rows}"));
    let port = "sim:ids=1-2,delay=0,jam=2";
    let stuck = bench.run(&format!(
        "replay m.csv --yes --json --adapter --port {port}"
    ));
    assert_eq!(stuck.code, Some(1), "{stuck:?}");
    assert_eq!(stuck.json()["not_followed"][0]["servo"], 2, "{stuck:?}");
    assert!(stuck.stderr.contains("servo 2 did not follow"), "{stuck:?}");
    let well = bench.run(&format!(
        "replay m.csv --yes --adapter --ids 1 --port {port}"
    ));
    assert_eq!(well.code, Some(0), "{well:?}");
    let absent = bench.run("replay m.csv --yes --ids 3 --port sim");
    assert_eq!(absent.code, Some(2), "{absent:?}");
    assert!(absent.stderr.contains("it has 1-2"), "{absent:?}");
}
