//! Robots in space and data sets of LeRobot, in the lab.

use super::server::LabServer;
use crate::common::Bench;
use crate::lerobot::{EPISODES, ROBOT, Written, bench, names};
use serde_json::{Value, json};

fn steps(server: &LabServer, number: u32) -> Vec<Value> {
    let saved = server.get(&format!("/s/{number}/download/session.json"));
    saved.json()["steps"].as_array().unwrap().clone()
}

fn rms(server: &LabServer, number: u32) -> f64 {
    let (meta, _) = server.get(&format!("/s/{number}/curves?motion=0")).curves();
    meta["rms"].as_f64().unwrap()
}

/// A data set and the model that `init` makes of it and the robot's file.
fn begun() -> Bench {
    let bench = bench("v3.0", names(), Written::Degrees);
    let init = "init d --robot robot.urdf --calibration calibration.json --unit deg -o m.toml";
    assert_eq!(bench.run(init).code, Some(0));
    bench
}

#[test]
fn a_session_keeps_the_robots_file_and_the_data_set() {
    let bench = begun();
    let told = bench.run("compare m.toml d --json").json();
    let signals = told["comparisons"][0]["signals"].as_array().unwrap();
    let squares = signals
        .iter()
        .map(|s| s["rms_rad"].as_f64().unwrap().powi(2));
    let told_rms = (squares.sum::<f64>() / signals.len() as f64).sqrt();

    let server = bench.lab("m.toml d");
    // What was brought is moved away, as it is when a session is taken to another machine.
    for gone in ["robot.urdf", "m.toml"] {
        std::fs::remove_file(bench.path(gone)).unwrap();
    }
    std::fs::remove_dir_all(bench.path("d")).unwrap();
    let first = rms(&server, 1);
    assert!((first / told_rms - 1.0).abs() < 0.01, "{first} {told_rms}");
    let last = server.get(&format!("/s/1/curves?motion={}", EPISODES - 1));
    assert_eq!(last.status, 200, "each episode is a motion");

    // A value is changed, and fitted back.
    let tried = json!({ "effects": [], "values": [["joint1.gain_per_rad", 4.0]] });
    assert_eq!(server.post("/s/1/keep", &tried).status, 200);
    assert!(rms(&server, 1) > 2.0 * first);
    server.post("/s/1/fit", &json!({ "names": "joint1.gain_per_rad" }));
    assert_eq!(server.wait()["state"], "done");
    assert!(rms(&server, 1) < 1.5 * first, "{}", rms(&server, 1));

    // The session is taken along.
    let file = server.get("/s/1/download/session.json");
    let path = "/s/1/upload?name=session.json";
    let brought = server.post_bytes(path, "", file.text().as_bytes());
    assert_eq!(brought.status, 200, "{}", brought.text());
    let number = brought.json()["session"].as_u64().unwrap() as u32;
    assert_eq!(steps(&server, number), steps(&server, 1));
    assert_eq!(rms(&server, number), rms(&server, 1));
}

/// A table with the joints' names in it.
fn table() -> String {
    let joints = ["shoulder_pan", "shoulder_lift", "gripper"];
    let mut text = String::from("time_s");
    for joint in joints {
        text += &format!(",{joint}.position,{joint}.goal_rad");
    }
    text.push('\n');
    for k in 0..400 {
        let t = 0.02 * f64::from(k);
        text += &format!("{t:.2}");
        for joint in 0..joints.len() {
            let goal = 0.3 * (1.3 * t + joint as f64).sin();
            text += &format!(",{:.5},{goal:.5}", 0.98 * goal);
        }
        text.push('\n');
    }
    text
}

#[test]
fn a_robots_file_that_is_dropped_takes_the_columns_of_the_log() {
    let bench = Bench::new();
    let server = bench.lab("");
    let drop = |name: &str, text: &str| {
        server.post_bytes(&format!("/s/1/upload?name={name}"), "", text.as_bytes())
    };
    let model = "[rig]\nname = \"so\"\nrobot = \"../elsewhere/robot.urdf\"\n";
    let refused = drop("so.toml", model);
    let pasted = server.post("/s/1/model", &json!({ "toml": model }));
    for refused in [refused, pasted] {
        assert_eq!(refused.status, 422);
        assert!(
            refused
                .text()
                .contains("bring the robot's file robot.urdf first"),
            "{}",
            refused.text()
        );
    }
    assert_eq!(drop("a.csv", &table()).status, 200);
    let taken = drop("robot.urdf", ROBOT);
    assert_eq!(taken.status, 200, "{}", taken.text());
    let step = &steps(&server, 1)[0];
    assert!(
        step["title"].as_str().unwrap().contains("in space"),
        "{step}"
    );
    let toml = step["toml"].as_str().unwrap();
    assert!(toml.contains("robot = \"robot.urdf\""), "{toml}");
    assert!(toml.contains("column = \"gripper.position\""), "{toml}");
    assert!(rms(&server, 1).is_finite());
    // With the robot here, a model that names it is taken.
    let taken = drop(
        "so.toml",
        &toml.replace("robot.urdf", "../robots/robot.urdf"),
    );
    assert_eq!(taken.status, 200, "{}", taken.text());
    assert_eq!(steps(&server, 1)[1]["toml"], toml);
    let pasted = json!({ "toml": toml.replace("robot.urdf", "a/robot.urdf") });
    assert_eq!(server.post("/s/1/model", &pasted).status, 200);
    assert_eq!(steps(&server, 1)[2]["toml"], toml);
}
