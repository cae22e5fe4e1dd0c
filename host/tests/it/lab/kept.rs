//! What a session keeps: diagnoses by what they are of, sessions as files, logs in parts.

use super::server::LabServer;
use crate::common::Bench;
use serde_json::{Value, json};

fn saved(server: &LabServer, number: u32) -> Value {
    server
        .get(&format!("/s/{number}/download/session.json"))
        .json()
}

fn diagnosed(bench: &Bench) -> LabServer {
    let server = bench.lab("model.toml a.csv b.csv");
    let held_out = json!({ "file": "b.csv", "action": "hold_out" });
    assert_eq!(server.post("/s/1/log", &held_out).status, 200);
    assert_eq!(server.post("/s/1/diagnose", &json!({})).status, 200);
    assert_eq!(server.wait()["state"], "done");
    server
}

#[test]
fn a_diagnosis_comes_back_with_its_logs_and_its_model() {
    let bench = Bench::new();
    let mut server = diagnosed(&bench);
    let said = saved(&server, 1)["diagnosis"].clone();
    assert_eq!(said["verdict"], "named");
    let verdict = |server: &LabServer| server.get("/s/1/learn").text().contains("data-verdict");

    // A file that is no log of this rig is left out, and the diagnosis stays.
    let wrong = b"time_s,other\n0,1\n0.01,2\n";
    let sent = server.post_bytes("/s/1/upload?name=wrong.csv", "", wrong);
    assert_eq!(sent.status, 200, "{}", sent.text());
    assert!(verdict(&server), "it is of the logs that can be read");
    let remove = |name: &str| json!({ "file": name, "action": "remove" });
    assert_eq!(server.post("/s/1/log", &remove("wrong.csv")).status, 200);
    assert!(verdict(&server));

    // A log that can be read makes it another question; without it the answer is there again.
    let another = std::fs::read(bench.path("a.csv")).unwrap();
    let another = [another, b"\n".to_vec()].concat();
    server.post_bytes("/s/1/upload?name=c.csv", "", &another);
    assert!(!verdict(&server), "nothing is known of these logs");
    assert_eq!(server.post("/s/1/log", &remove("c.csv")).status, 200);
    assert!(verdict(&server));
    assert_eq!(saved(&server, 1)["diagnosis"], said);
    // The same of a model that is given up and brought again.
    let other = bench
        .get("model.toml")
        .replace("mass_kg = 0.2", "mass_kg = 0.3");
    server.post("/s/1/model", &json!({ "toml": other }));
    assert!(
        server
            .get("/s/1/learn")
            .text()
            .contains("is another one by now")
    );
    let model = json!({ "toml": bench.get("model.toml") });
    server.post("/s/1/model", &model);
    assert!(
        !server
            .get("/s/1/learn")
            .text()
            .contains("is another one by now")
    );
    // And after the lab was ended.
    server.kill();
    let mut server = bench.lab_alone("");
    server.come_in();
    assert!(verdict(&server));
}

#[test]
fn every_error_is_said_with_how_long_models_run() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv b.csv");
    for page in ["compare", "learn", "what-if"] {
        let text = server.get(&format!("/s/1/{page}")).text();
        assert!(text.contains("over whole motions"), "{page}");
    }
    server.post("/s/1/horizon", &json!({ "window": { "seconds": 0.25 } }));
    for page in ["compare", "learn", "what-if"] {
        let text = server.get(&format!("/s/1/{page}")).text();
        assert!(text.contains("over 0.25 s"), "{page}");
    }
    let learn = server.get("/s/1/learn").text();
    assert!(
        learn.contains("as you chose on the Compare page"),
        "{learn}"
    );
    let whole = server.get("/s/1/whole").text();
    let told = bench.run("compare model.toml a.csv b.csv --json").json();
    let rms = told["comparisons"][0]["signals"][0]["rms_rad"]
        .as_f64()
        .unwrap();
    let text = format!("model 0 <b>{:.0} mrad</b>", 1e3 * rms);
    let digits = whole.replace(".0 mrad", " mrad");
    assert!(rms > 0.1 && digits.contains(&text), "{text}: {whole}");
    let back = json!({ "window": "whole", "page": "learn" });
    assert_eq!(
        server.post("/s/1/horizon", &back).json()["go"],
        "/s/1/learn"
    );
    // Nothing is taken back to a diagnosis that there is not.
    assert!(
        !server
            .get("/s/1/compare")
            .text()
            .contains("As the diagnosis has it")
    );
}

#[test]
fn a_saved_session_opens_again_with_its_logs() {
    let bench = Bench::new();
    let server = diagnosed(&bench);
    server.post("/s/1/note", &json!({ "step": 0, "note": "cold oil" }));
    server.post_bytes("/s/1/upload?name=bytes.csv", "", b"time_s,\xff\n0,1\n");
    let file = server.get("/s/1/download/session.json");
    let sent = server.post_bytes("/s/1/upload?name=session.json", "", &file.body);
    assert_eq!(sent.status, 200, "{}", sent.text());
    assert_eq!(sent.json()["go"], "/s/2/data");
    let (old, new) = (saved(&server, 1), saved(&server, 2));
    for key in ["logs", "steps", "diagnosis", "window", "files"] {
        assert_eq!(old[key], new[key], "{key}");
    }
    assert!(server.get("/s/2/learn").text().contains("cold oil"));
    let rms = |number: u32| {
        server
            .get(&format!("/s/{number}/curves?motion=0"))
            .curves()
            .0["rms"]
            .clone()
    };
    assert_eq!(rms(1), rms(2));
    assert!(bench.path("sessions/2/logs/bytes.csv").exists());

    // A log that is named alone is lacking until it is brought, and then takes its place.
    let mut named = file.json();
    named["files"].as_object_mut().unwrap().remove("b.csv");
    let named = named.to_string();
    server.post_bytes("/s/1/upload?name=session.json", "", named.as_bytes());
    assert!(server.get("/s/3/data").text().contains("drop b.csv here"));
    assert_eq!(server.get("/s/3/compare").status, 200);
    let lacked = std::fs::read(bench.path("b.csv")).unwrap();
    server.post_bytes("/s/3/upload?name=b.csv", "", &lacked);
    assert_eq!(saved(&server, 3)["logs"], old["logs"]);

    // What is none is refused, and nothing is begun.
    for (text, found) in [
        (
            r#"{"version":99,"logs":[],"steps":[],"current":0,"window":"whole"}"#,
            "version",
        ),
        (r#"{"logs":[],"steps":[3]}"#, "no session"),
        (
            r#"{"version":1,"logs":[{"file":"../x","rows":null,"held_out":false}],"steps":[],
               "current":0,"window":"whole","diagnosis":null,"round":null}"#,
            "no log",
        ),
    ] {
        let refused = server.post_bytes("/s/1/upload?name=session.json", "", text.as_bytes());
        assert_eq!(refused.status, 422, "{text}");
        assert!(refused.text().contains(found), "{}", refused.text());
    }
    assert_eq!(server.get("/s/4/data").status, 404);
}

#[test]
fn rows_of_a_log_are_used_or_judge() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv b.csv");
    let divide = |parts: Value| {
        let asked = json!({ "file": "a.csv", "parts": parts });
        server.post("/s/1/divide", &asked).status
    };
    let parts = json!([
        { "rows": [0, 99], "held_out": false },
        { "rows": [100, 149], "held_out": true },
    ]);
    assert_eq!(divide(parts), 200);
    let page = server.get("/s/1/compare").text();
    assert!(
        page.contains("logs/a.csv:0-99"),
        "the command names the rows"
    );
    let told = bench.run("compare model.toml a.csv:0-99 b.csv a.csv:100-149 --json");
    let told = told.json();
    let (meta, _) = server.get("/s/1/curves?motion=0").curves();
    assert_eq!(
        meta["joint_rms"][0],
        told["comparisons"][0]["signals"][0]["rms_rad"]
    );
    let (raw, _) = server.get("/s/1/raw?file=a.csv").curves();
    assert_eq!(
        raw["parts"][1],
        json!({ "rows": [100, 149], "held_out": true })
    );
    // A part has a role by itself.
    let fit = json!({ "file": "a.csv:100-149", "action": "fit" });
    assert_eq!(server.post("/s/1/log", &fit).status, 200);
    assert_eq!(saved(&server, 1)["logs"][1]["held_out"], false);
    for refused in [
        json!([]),
        json!([{ "rows": [5, 3], "held_out": false }]),
        json!([{ "rows": [0, 1000000], "held_out": false }]),
    ] {
        assert_eq!(divide(refused), 422);
    }
    assert_eq!(divide(json!([{ "rows": null, "held_out": false }])), 200);
    assert_eq!(saved(&server, 1)["logs"].as_array().unwrap().len(), 2);
    let other = json!({ "file": "c.csv", "parts": [{ "rows": null, "held_out": false }] });
    assert_eq!(server.post("/s/1/divide", &other).status, 404);
}
