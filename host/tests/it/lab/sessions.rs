//! Sessions are named and deleted; a diagnosis is ended by who has seen enough; values are kept
//! within bounds.

use crate::common::Bench;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

#[test]
fn sessions_are_named_and_deleted() {
    let bench = Bench::new();
    let mut server = bench.lab("model.toml a.csv");
    let second = server.post("/sessions", &json!({})).json();
    assert_eq!(second["go"], "/s/2/data");
    let name = json!({ "name": " elbow <left> " });
    assert_eq!(server.post("/s/2/name", &name).json()["go"], "/sessions");
    for page in ["/sessions", "/s/2/data", "/s/2/compare"] {
        let text = server.get(page).text();
        assert!(text.contains("Session 2: elbow &lt;left&gt;"), "{page}");
    }
    // The name is kept, and goes with the session.
    server.kill();
    let mut server = bench.lab_alone("");
    assert_eq!(server.come_in(), "/sessions");
    assert!(
        server
            .get("/sessions")
            .text()
            .contains("elbow &lt;left&gt;")
    );
    let folder = bench.path("sessions/2");
    assert!(folder.join("logs/a.csv").exists());
    let deleted = server.post("/sessions/delete", &json!({ "number": 2 }));
    assert_eq!(deleted.json()["go"], "/sessions");
    assert!(!folder.exists());
    assert!(
        bench.path("sessions/1/logs/a.csv").exists(),
        "the other one stays"
    );
    assert!(!server.get("/sessions").text().contains("elbow"));
    assert_eq!(server.get("/s/2/data").status, 404);
    let again = server.post("/sessions/delete", &json!({ "number": 2 }));
    assert_eq!(again.status, 422, "{}", again.text());
}

/// An example whose diagnosis takes long.
#[test]
fn the_best_so_far_is_shown_and_taken() {
    let bench = Bench::new();
    let server = bench.lab("");
    server.post("/s/1/example", &json!({ "example": "backlash" }));
    server.post("/s/1/diagnose", &json!({}));
    let begun = Instant::now();
    let best = loop {
        let state = server.state();
        assert_eq!(state["state"], "running", "{state}");
        if !state["best"].is_null() {
            break state["best"].clone();
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "{state}");
        std::thread::sleep(Duration::from_millis(20));
    };
    let error = |key: &str| best[key].as_f64().unwrap();
    assert!(
        error("floor_rad") > 0.0 && error("error_rad") <= error("before_rad"),
        "{best}"
    );
    assert!(
        !best["name"].as_str().unwrap().contains('@'),
        "in words: {best}"
    );
    assert_eq!(server.post("/s/1/accept", &json!({})).status, 200);
    let told: Value = server.state();
    assert!(
        told["state"] == "done" || told["ending"] == "accepted",
        "{told}"
    );
    assert_eq!(server.wait()["state"], "done");
    let said = server.get("/s/1/download/session.json").json()["diagnosis"].clone();
    assert!(said["after_rad"].as_f64().unwrap() <= error("before_rad"));
    let warned = said["warnings"].to_string() + &said["summary"].to_string();
    assert!(
        warned.contains("You ended the search early"),
        "what was not tried is said: {said}"
    );
}

#[test]
fn values_are_fitted_within_bounds_as_on_the_command_line() {
    let bench = Bench::new();
    // The truth, 0.1 m, lies beyond the bounds.
    let wrong = bench
        .get("model.toml")
        .replace("com_m = 0.1\n", "com_m = 0.08\n");
    bench.put("wrong.toml", wrong);
    let server = bench.lab("wrong.toml a.csv");
    let fit = |bounds: Value| {
        let asked = json!({ "names": "link1.com_m", "bounds": bounds });
        server.post("/s/1/fit", &asked)
    };
    let refused = fit(json!([{ "path": "link1.com_m", "low": 0.2, "high": 0.3 }]));
    assert_eq!(refused.status, 422);
    assert!(
        refused.text().contains("lies outside its bounds"),
        "{}",
        refused.text()
    );
    let begun = fit(json!([{ "path": "link1.com_m", "low": 0.05, "high": 0.09 }]));
    assert_eq!(begun.status, 200, "{}", begun.text());
    assert_eq!(server.wait()["state"], "done");
    let saved = server.get("/s/1/download/session.json").json();
    let step = &saved["steps"][1];
    assert_eq!(step["values"][0]["value"], 0.09);
    assert_eq!(step["values"][0]["on_bound"], true);
    let ran = bench.run(
        "fit wrong.toml a.csv --free link1.com_m --bounds link1.com_m=0.05..0.09 --horizon whole \
         -o bounded.toml",
    );
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(step["toml"], bench.get("bounded.toml"));
    assert!(
        bench
            .get("bounded.toml")
            .contains("\"link1.com_m\" = [0.05, 0.09]")
    );
    let command = step["command"].as_str().unwrap();
    assert!(
        command.contains("--bounds link1.com_m=0.05..0.09"),
        "{command}"
    );
    let page = server.get("/s/1/learn").text();
    assert!(
        page.contains("data-was=\"0.09\""),
        "the page shows what is in force"
    );

    // Lifted, the value goes on towards where it belongs; friction, which the model lacks, keeps
    // it.
    let begun = fit(json!([{ "path": "link1.com_m", "low": null, "high": null }]));
    assert_eq!(begun.status, 200, "{}", begun.text());
    assert_eq!(server.wait()["state"], "done");
    let step = &server.get("/s/1/download/session.json").json()["steps"][2];
    assert!(!step["toml"].as_str().unwrap().contains("[fit.bounds]"));
    let value = step["values"][0]["value"].as_f64().unwrap();
    assert!((0.0902..0.105).contains(&value), "{value}");
}
