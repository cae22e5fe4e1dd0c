//! A law that the library lacks, found by a button.

use crate::common::Bench;
use handstand::challenge::unknown_law_arm;
use serde_json::json;

#[test]
fn a_law_is_found_added_and_drawn() {
    let bench = Bench::new();
    let (arm, _) = unknown_law_arm(1, "cubic_spring").unwrap();
    bench.put("arm.toml", arm.model_toml);
    for log in arm.logs {
        bench.put(&log.name, log.csv);
    }
    let server = bench.lab("arm.toml a.csv b.csv c.csv");
    let held_out = json!({ "file": "c.csv", "action": "hold_out" });
    assert_eq!(server.post("/s/1/log", &held_out).status, 200);
    assert_eq!(server.post("/s/1/discover", &json!({})).status, 200);
    let end = server.wait();
    assert_eq!(end["state"], "done", "{end:#}");

    let page = server.get("/s/1/learn").text();
    assert!(page.contains("law added: torque = -"), "{page}");
    assert!(page.contains("figure class=\"law\""), "{page}");
    assert!(page.contains("handstand discover model-0.toml"), "{page}");
    let saved = server.get("/s/1/download/session.json").json();
    let law = saved["steps"][1]["toml"].as_str().unwrap();
    assert!(law.contains("[[expression]]"), "{law}");

    // What is explained lacks no law: nothing is added, and the page says why.
    assert_eq!(server.post("/s/1/discover", &json!({})).status, 200);
    let end = server.wait();
    assert_eq!(end["state"], "failed", "{end:#}");
    let said = end["error"].as_str().unwrap();
    assert!(said.starts_with("nothing is missing"), "{said}");
}
