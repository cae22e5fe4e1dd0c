//! A law that the library lacks, from logs to a model that holds it.

use super::program;
use assert_cmd::Command;
use handstand::challenge::unknown_law_arm;
use handstand_measure::discover::{DiscoverCase, try_discover};
use serde_json::Value;
use std::path::Path;

/// A user's folder with an arm and its three logs.
fn arm(law: &str, seed: u64, dir: &Path) {
    let (bench, _) = unknown_law_arm(seed, law).unwrap();
    std::fs::write(dir.join("arm.toml"), bench.model_toml).unwrap();
    for log in bench.logs {
        std::fs::write(dir.join(log.name), log.csv).unwrap();
    }
}

/// The program's answer in a folder.
fn handstand(dir: &Path, words: &str, code: i32) -> Value {
    let mut command = Command::new(program());
    let run = command
        .current_dir(dir)
        .args(words.split(' '))
        .arg("--json");
    let output = run.assert().code(code).get_output().stdout.clone();
    serde_json::from_slice(&output).unwrap()
}

#[test]
fn a_law_becomes_a_model_that_other_commands_take() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path();
    arm("friction_over_angle", 1, dir);
    let logs = "a.csv b.csv --holdout c.csv";
    let found = handstand(dir, &format!("discover arm.toml {logs} -o better.toml"), 0);
    let term = &found["terms"][0];
    assert_eq!(term["site"], "friction", "{found:#}");
    let exponent = &term["parameters"]["exponent"];
    let [low, high] = ["low", "high"].map(|end| exponent[end].as_f64().unwrap());
    assert!(low < 1.02 && high > 0.98, "{exponent}");
    assert_eq!(found["model"], "better.toml");

    let text = std::fs::read_to_string(dir.join("better.toml")).unwrap();
    assert!(
        text.contains("[[expression]]") && text.contains("friction = "),
        "{text}"
    );
    let error = |model: &str| {
        let compared = handstand(dir, &format!("compare {model} c.csv"), 0);
        compared["comparisons"][0]["signals"][0]["rms_rad"]
            .as_f64()
            .unwrap()
    };
    let (before, after) = (error("arm.toml"), error("better.toml"));
    assert!(after < 0.01 * before, "{before} -> {after}");
    // A second discovery finds nothing more, and does not trip over the first one's names.
    let again = handstand(dir, &format!("discover better.toml {logs}"), 0);
    assert_eq!(again["verdict"], "nothing_missing", "{again:#}");
}

#[test]
fn two_terms_are_found_together() {
    let case = DiscoverCase {
        law: Some("two_harmonics"),
        seed: 1,
    };
    let outcome = try_discover(case, None).unwrap();
    assert!(outcome.is_right(), "{outcome:#?}");
    assert_eq!(outcome.found.len(), 2, "{outcome:#?}");
}

#[test]
fn where_nothing_is_missing_no_law_is_invented() {
    let outcome = try_discover(DiscoverCase { law: None, seed: 1 }, None).unwrap();
    assert!(outcome.found.is_empty(), "{outcome:#?}");
}
