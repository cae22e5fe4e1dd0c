//! Two browsers at one lab do not disturb each other.

use crate::common::Bench;
use serde_json::json;

#[test]
fn each_browser_works_in_a_session_of_its_own() {
    let bench = Bench::new();
    let mut server = bench.lab("model.toml a.csv b.csv");
    let first = server.cookies.clone();
    assert_eq!(server.come_in(), "/s/2/data", "a second browser");
    let second = std::mem::replace(&mut server.cookies, first);
    assert_ne!(server.cookies, second);
    let before = server.get("/s/1/curves?motion=0").curves().0["rms"].clone();

    // The first one diagnoses; meanwhile the second one takes another model, and diagnoses too.
    assert_eq!(server.post("/s/1/diagnose", &json!({})).status, 200);
    let heavier = bench
        .get("model.toml")
        .replace("mass_kg = 0.2", "mass_kg = 0.4");
    let heavier = heavier.replace("com_m = 0.1", "com_m = 0.05");
    let path = "/s/2/model";
    assert_eq!(server.post(path, &json!({ "toml": heavier })).status, 200);
    assert_eq!(server.post("/s/2/diagnose", &json!({})).status, 200);
    assert_eq!(
        server.post("/s/1/diagnose", &json!({})).status,
        409,
        "one at a time in a session"
    );
    let other = server.get("/s/2/curves?motion=0").curves().0["rms"].clone();
    assert_ne!(before, other);
    assert_eq!(server.get("/s/1/curves?motion=0").curves().0["rms"], before);

    assert_eq!(server.post("/s/2/stop", &json!({})).status, 200);
    assert_eq!(
        server.wait()["state"],
        "done",
        "stopping the second one does not stop the first"
    );
    let saved = |number: u32| {
        let path = format!("/s/{number}/download/session.json");
        server.get(&path).json()
    };
    assert_eq!(saved(1)["steps"].as_array().unwrap().len(), 1);
    assert_eq!(saved(1)["diagnosis"]["verdict"], "named");
    assert_eq!(saved(2)["steps"].as_array().unwrap().len(), 2);
}
