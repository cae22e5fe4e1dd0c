//! The gains page answers for every model that has a drive, and says what the others lack.

use super::server::{LabServer, Response};
use crate::common::Bench;
use serde_json::{Value, json};
use std::path::Path;

fn models() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let files = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = files
        .map(|file| file.unwrap().path().display().to_string())
        .filter(|name| name.ends_with(".toml"))
        .collect();
    names.sort();
    names
}

fn design(server: &LabServer) -> Response {
    let asked = json!({ "states": 1.0, "speeds": 1.0, "ts_s": 0.01, "delay_s": Value::Null });
    server.post("/s/1/gains", &asked)
}

#[test]
fn every_driven_model_gets_gains_and_the_others_are_told_what_they_lack() {
    let (mut designed, mut refused) = (0, 0);
    for model in models() {
        let bench = Bench::new();
        let server = bench.lab(&model);
        let page = server.get("/s/1/gains").text();
        let answer = design(&server);
        if page.contains("No joint of this model is driven") {
            assert_eq!(answer.status, 422, "{model}");
            assert!(answer.text().contains("driven"), "{}", answer.text());
            refused += 1;
            continue;
        }
        assert_eq!(answer.status, 200, "{model}: {}", answer.text());
        let told = bench.run(&format!("gains {model} --ts 0.01 --json"));
        assert_eq!(answer.json()["k"], told.json()["k"], "{model}");
        designed += 1;
    }
    assert!(designed >= 10 && refused >= 5, "{designed} and {refused}");
}

/// An effect without a derivative is left out of the design, and kept in the response.
#[test]
fn what_a_model_has_learned_shows_in_the_response() {
    let model = models().into_iter().find(|m| m.ends_with("bench_arm.toml"));
    let text = std::fs::read_to_string(model.unwrap()).unwrap();
    let [without, with] = ["0.0", "0.03"].map(|torque_nm| {
        let bench = Bench::new();
        let given = "torque_nm = 0.03";
        assert!(text.contains(given));
        bench.put(
            "arm.toml",
            text.replace(given, &format!("torque_nm = {torque_nm}")),
        );
        let answer = design(&bench.lab("arm.toml"));
        assert_eq!(answer.status, 200, "{}", answer.text());
        answer.json()
    });
    assert_eq!(without["k"], with["k"]);
    assert_eq!(
        with["omitted"].as_array().unwrap().len(),
        1,
        "{}",
        with["omitted"]
    );
    assert_ne!(
        without["response"]["angle_rad"],
        with["response"]["angle_rad"]
    );
}

#[test]
fn the_page_says_what_the_command_says() {
    let bench = Bench::new();
    let model = models()
        .into_iter()
        .find(|m| m.ends_with("bench_arm.toml"))
        .unwrap();
    // Friction that holds the arm in any pose.
    let text = std::fs::read_to_string(&model).unwrap();
    bench.put(
        "arm.toml",
        text.replace("torque_nm = 0.03", "torque_nm = 0.9"),
    );
    let server = bench.lab("arm.toml");
    let asked = json!({ "states": 1.0, "speeds": 1.0, "ts_s": 0.01, "delay_s": Value::Null });
    let said = server.post("/s/1/verified", &asked).json();
    let told = bench.run("gains arm.toml --ts 0.01").stdout;
    let lines = said["lines"].as_array().unwrap();
    for line in lines {
        assert!(told.contains(line.as_str().unwrap()), "{line}:\n{told}");
    }
    assert!(said["stays_uncontrolled"] == true, "{said}");
    assert!(lines.iter().any(|line| {
        line.as_str()
            .unwrap()
            .contains("prove nothing of the gains")
    }));
}

/// A robot in space is held at a pose that the page asks for.
#[test]
fn a_robot_in_space_has_a_pose_to_fill_in() {
    let bench = Bench::new();
    bench.put("pendulum.urdf", include_str!("../../data/pendulum.urdf"));
    bench.put("pendulum.toml", include_str!("../../data/pendulum.toml"));
    let server = bench.lab("pendulum.toml");
    let page = server.get("/s/1/gains").text();
    assert!(page.contains("value=\"turn=0, swing=0\""), "{page}");
    let ask = |pose: &str| {
        let asked = json!({ "states": 1.0, "speeds": 1.0, "ts_s": 0.01, "pose": pose });
        server.post("/s/1/gains", &asked)
    };
    let up = std::f64::consts::PI;
    let answer = ask(&format!("swing = {up}"));
    assert_eq!(answer.status, 200, "{}", answer.text());
    let answer = answer.json();
    assert_eq!(answer["joints"], json!(["joint turn", "joint swing"]));
    let told = bench.run(&format!("gains pendulum.toml --pose swing={up} --json"));
    assert_eq!(answer["k"], told.json()["k"]);
    let command = answer["command"].as_str().unwrap();
    assert!(
        command.ends_with(&format!(" --pose swing={up}")),
        "{command}"
    );
    for (pose, said) in [
        ("sing=1", "swing"),
        ("swing", "by name"),
        ("turn=3", "range"),
    ] {
        let answer = ask(pose);
        assert_eq!(answer.status, 422, "{pose}: {}", answer.text());
        assert!(answer.text().contains(said), "{pose}: {}", answer.text());
    }
}

/// The page that `gains --report` writes, for the sliders as they stand.
#[test]
fn a_page_with_pictures_is_there_to_take_along() {
    let bench = Bench::new();
    let model = models().into_iter().find(|m| m.ends_with("handstand.toml"));
    let server = bench.lab(&model.unwrap());
    let page = server.get("/s/1/gains-file/gains.html?states=1&speeds=10&ts_s=0.01");
    assert_eq!(page.status, 200, "{}", page.text());
    let page = page.text();
    for said in ["0.645", "<svg", "--q 4,4,4,0.1,0.1,0.1", "stabilised"] {
        assert!(page.contains(said), "{said}");
    }
}
