//! Logs of every format that the library reads.

use crate::common::Bench;
use serde_json::{Value, json};
use std::path::Path;

fn kept(name: &str) -> Vec<u8> {
    let logs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/logs");
    std::fs::read(logs.join(name)).unwrap()
}

#[test]
fn the_lab_takes_whatever_the_reader_reads() {
    let bench = Bench::new();
    let server = bench.lab("");
    for name in [
        "states_zstd.mcap",
        "states_lz4.mcap",
        "states.db3",
        "v7.mat",
        "v6.mat",
    ] {
        let path = format!("/s/1/upload?name={name}");
        let sent = server.post_bytes(&path, "", &kept(name));
        assert_eq!(sent.status, 200, "{name}: {}", sent.text());
        let (meta, arrays) = server.get(&format!("/s/1/raw?file={name}")).curves();
        let rows = arrays[0].1.len();
        assert!(rows > 1 && arrays.len() > 2, "{name}: {meta}, {rows} rows");
    }
    // A recording of this program, and the model that the command line proposes for it.
    let record = "record run.mcap --seconds 1 --port sim:ids=1-2,delay=0 --ids 1-2";
    assert_eq!(bench.run(record).code, Some(0));
    let recording = std::fs::read(bench.path("run.mcap")).unwrap();
    let sent = server.post_bytes("/s/1/upload?name=run.mcap", "", &recording);
    assert_eq!(sent.status, 200, "{}", sent.text());
    let (meta, _) = server.get("/s/1/raw?file=run.mcap").curves();
    assert!(meta["names"].to_string().contains("q1_rad"), "{meta}");
    let page = server.get("/s/1/data").text();
    assert!(
        page.contains(".mcap") && page.contains(".db3"),
        "the chooser offers them"
    );
}

#[test]
fn a_log_of_a_robot_is_compared_as_on_the_command_line() {
    let bench = Bench::new();
    std::fs::write(bench.path("states.mcap"), kept("states_zstd.mcap")).unwrap();
    assert_eq!(bench.run("init states.mcap -o robot.toml").code, Some(0));
    let told = bench.run("compare robot.toml states.mcap --json").json();
    let server = bench.lab("robot.toml states.mcap");
    let (meta, _) = server.get("/s/1/curves?motion=0").curves();
    let signals = told["comparisons"][0]["signals"].as_array().unwrap();
    let rms: Vec<_> = signals
        .iter()
        .map(|signal| signal["rms_rad"].clone())
        .collect();
    assert_eq!(meta["joint_rms"].as_array().unwrap(), &rms);
}

#[test]
fn a_table_that_cannot_be_read_is_refused_with_the_remedy() {
    let bench = Bench::new();
    let server = bench.lab("");
    for (name, remedy) in [
        ("a.parquet", "to_csv"),
        ("a.mcap", ""),
        ("a.mat", ""),
        ("a.db3", ""),
    ] {
        let path = format!("/s/1/upload?name={name}");
        let refused = server.post_bytes(&path, "", b"PAR1 and nothing more");
        assert_eq!(refused.status, 422, "{name}");
        let said = refused.text();
        assert!(said.contains(remedy), "{said}");
        assert!(
            !said.contains("sessions/1"),
            "no path of this machine: {said}"
        );
        assert!(
            !bench.path(&format!("sessions/1/logs/{name}")).exists(),
            "{name}"
        );
    }
    let saved = server.get("/s/1/download/session.json").json();
    assert_eq!(saved["logs"].as_array().unwrap().len(), 0);
}

#[test]
fn a_model_from_the_form_takes_the_columns_of_the_log() {
    let bench = Bench::new();
    let server = bench.lab("");
    // Two swings one after the other, each with a clock that begins at 0.
    let row = |segment: u32, k: u32| {
        let t = 0.01 * f64::from(k);
        let (angle, speed) = (3.1 + 0.4 * (6.0 * t).cos(), -2.4 * (6.0 * t).sin());
        format!("{segment},{t:.2},{angle:.5},{speed:.5}\n")
    };
    let swings = (0..2).flat_map(|segment| (0..200).map(move |k| row(segment, k)));
    let log = "segment,t,theta1,dtheta1\n".to_string() + &swings.collect::<String>();
    let sent = server.post_bytes("/s/1/upload?name=odd.csv", "", log.as_bytes());
    assert_eq!(sent.status, 200, "{}", sent.text());
    let link = json!({ "length_m": 0.3, "com_m": 0.15, "mass_kg": 0.15, "drive": "passive" });
    let plan = |links: Vec<Value>| {
        let zero = "upright";
        json!({ "name": "arm", "angle_zero": zero, "angles": "relative", "links": links })
    };
    let made = server.post("/s/1/new-model", &plan(vec![link.clone()]));
    assert_eq!(made.status, 200, "{}", made.text());
    let toml = server.get("/s/1/download/model.toml").text();
    for part in [
        "column = \"t\"",
        "segment = \"segment\"",
        "position = { column = \"theta1\", unit = \"rad\"",
        "velocity = { column = \"dtheta1\"",
        "mass_kg = 0.15",
    ] {
        assert!(toml.contains(part), "{part}:\n{toml}");
    }
    assert_eq!(server.get("/s/1/error").status, 200);
    // The log tells no columns of a second joint: names to pick stand there.
    let made = server.post("/s/1/new-model", &plan(vec![link.clone(), link]));
    assert_eq!(made.status, 200, "{}", made.text());
    let toml = server.get("/s/1/download/model.toml").text();
    assert!(toml.contains("column = \"q2_rad\""), "{toml}");
}

/// What `init` makes of a log in the shell, the lab makes of it by one button.
#[test]
fn a_model_is_estimated_from_a_log_as_init_does() {
    let bench = Bench::new();
    let server = bench.lab("");
    server.post("/s/1/model-from-log", &json!({}));
    let end = server.wait();
    assert_eq!(end["state"], "failed");
    assert_eq!(end["error"], "no log tells of joints", "{end}");
    let log = bench.get("a.csv");
    let sent = server.post_bytes("/s/1/upload?name=a.csv", "", log.as_bytes());
    assert_eq!(sent.status, 200, "{}", sent.text());
    let page = server.get("/s/1/data").text();
    assert!(page.contains("id=\"from-log\""), "{page}");
    let made = server.post("/s/1/model-from-log", &json!({}));
    assert_eq!(made.status, 200, "{}", made.text());
    let end = server.wait();
    assert_eq!(end, json!({ "state": "done", "page": "compare" }));
    let toml = server.get("/s/1/download/model.toml").text();
    bench.run("init a.csv -o by_init.toml");
    assert_eq!(toml, bench.get("by_init.toml"));
}
