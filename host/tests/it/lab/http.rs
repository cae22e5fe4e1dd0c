//! The loop over HTTP: the numbers are those of the command line, and nothing saved is lost.

use super::server::LabServer;
use crate::common::Bench;
use serde_json::json;

/// The error in force, as the page's data say it, rad.
fn error_now(server: &LabServer) -> f64 {
    let page = server.get("/s/1/learn").text();
    let (_, after) = page.split_once("id=\"error-now\" data-error=\"").unwrap();
    after.split('"').next().unwrap().parse().unwrap()
}

#[test]
fn the_numbers_are_those_of_the_command_line() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv b.csv");
    let held_out = json!({ "file": "b.csv", "action": "hold_out" });
    assert_eq!(server.post("/s/1/log", &held_out).status, 200);

    let told = bench.run("compare model.toml a.csv b.csv --json").json();
    let signal = &told["comparisons"][0]["signals"][0];
    let (meta, arrays) = server.get("/s/1/curves?motion=1").curves();
    assert_eq!(meta["rms"], signal["rms_rad"]);
    assert_eq!(meta["floor"][0], signal["floor_rad"]);
    assert_eq!(meta["motion"], "b.csv");
    assert_eq!(meta["held_out"], true);
    assert_eq!(error_now(&server), signal["rms_rad"].as_f64().unwrap());
    let trace = &told["comparisons"][0]["traces"][1];
    for (name, key) in [
        ("measured_0", "measured_rad"),
        ("predicted_0", "predicted_rad"),
    ] {
        let (_, values) = arrays.iter().find(|(array, _)| array == name).unwrap();
        let told: Vec<f32> = serde_json::from_value(trace[key].clone()).unwrap();
        assert_eq!(*values, told, "{name}");
    }
    let failure = &told["comparisons"][0]["failures"][0]["sentence"];
    assert!(
        server
            .get("/s/1/compare")
            .text()
            .contains(failure.as_str().unwrap())
    );

    // The diagnosis, and the effect added.
    assert_eq!(server.post("/s/1/diagnose", &json!({})).status, 200);
    assert_eq!(server.wait()["state"], "done");
    let saved = server.get("/s/1/download/session.json").json();
    let told = bench
        .run("diagnose model.toml a.csv --holdout b.csv --json")
        .json();
    let found = &saved["diagnosis"];
    assert_eq!(found["verdict"], told["verdict"]);
    assert_eq!(found["summary"], told["summary"]);
    for key in ["before_rad", "after_rad", "floor_rad"] {
        assert_eq!(found[key], told["error"][key], "{key}");
    }
    assert_eq!(found["cards"][0]["effects"], json!(["viscous@1"]));

    assert_eq!(
        server
            .post("/s/1/add", &json!({ "names": "viscous@1" }))
            .status,
        200
    );
    assert_eq!(server.wait()["state"], "done");
    let ran = bench.run("add model.toml viscous --fit a.csv --holdout b.csv -o better.toml");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(
        server.get("/s/1/download/model.toml").text(),
        bench.get("better.toml")
    );
    let told = bench.run("compare better.toml a.csv b.csv --json").json();
    let better = told["comparisons"][0]["signals"][0]["rms_rad"]
        .as_f64()
        .unwrap();
    assert_eq!(error_now(&server), better);
    let report = server.get("/s/1/download/report.html").text();
    assert!(report.contains("model-1.toml") && report.contains("How the error falls"));

    // The commands shown do the same, typed where the models and logs are.
    let session = bench.path("sessions/1");
    std::fs::remove_file(session.join("model-1.toml")).unwrap();
    let saved = server.get("/s/1/download/session.json").json();
    let command = saved["steps"][1]["command"].as_str().unwrap();
    let ran = std::process::Command::new(env!("CARGO_BIN_EXE_handstand"))
        .args(command.split_whitespace().skip(1))
        .current_dir(&session)
        .output()
        .unwrap();
    assert!(ran.status.success(), "{command}: {ran:?}");
    let typed = std::fs::read_to_string(session.join("model-1.toml")).unwrap();
    assert_eq!(typed, bench.get("better.toml"));
}

#[test]
fn steps_are_undone_and_survive_a_kill_in_the_middle_of_a_fit() {
    let bench = Bench::new();
    let mut server = bench.lab("model.toml a.csv b.csv");
    let before = error_now(&server);
    server.post("/s/1/add", &json!({ "names": "viscous" }));
    assert_eq!(server.wait()["state"], "done");
    let after = error_now(&server);
    assert!(after < 0.2 * before, "{before} -> {after}");
    assert_eq!(server.post("/s/1/step", &json!({ "step": 0 })).status, 200);
    assert_eq!(error_now(&server), before);
    assert_eq!(server.post("/s/1/step", &json!({ "step": 1 })).status, 200);
    assert_eq!(server.post("/s/1/step", &json!({ "step": 2 })).status, 422);
    let note = json!({ "step": 1, "note": "oil is <cold>" });
    assert_eq!(server.post("/s/1/note", &note).status, 200);
    assert_eq!(server.post("/s/1/diagnose", &json!({})).status, 200);
    assert_eq!(
        server
            .post("/s/1/add", &json!({ "names": "coulomb" }))
            .status,
        409
    );
    server.kill();

    let mut server = bench.lab_alone("");
    // Earlier sessions wait to be chosen from.
    assert_eq!(server.come_in(), "/sessions");
    assert_eq!(error_now(&server), after);
    let page = server.get("/s/1/learn").text();
    assert!(
        page.contains("oil is &lt;cold&gt;"),
        "the note is there, as text"
    );
    // It goes on, and another browser gets a session of its own.
    server.post("/s/1/step", &json!({ "step": 0 }));
    assert_eq!(error_now(&server), before);
    let second = {
        server.cookies.clear();
        server.come_in()
    };
    assert_eq!(second, "/s/2/data");
}

#[test]
fn a_diagnosis_is_stopped() {
    let bench = Bench::new();
    let server = bench.lab("");
    // Three motions of 20 s: long work.
    assert_eq!(
        server
            .post("/s/1/example", &json!({ "example": "backlash" }))
            .status,
        200
    );
    server.post("/s/1/diagnose", &json!({}));
    assert_eq!(server.state()["state"], "running");
    // Pages are answered meanwhile.
    assert_eq!(server.get("/s/1/compare").status, 200);
    server.post("/s/1/stop", &json!({}));
    let end = server.wait();
    assert!(end["state"] == "stopped", "{end}");
    let saved = server.get("/s/1/download/session.json").json();
    assert!(saved["diagnosis"].is_null());
    server.post("/s/1/add", &json!({ "names": "viscous@7" }));
    let end = server.wait();
    assert_eq!(end["state"], "failed");
    assert!(end["error"].as_str().unwrap().contains('7'), "{end}");
}

#[test]
fn what_if_and_kept_values() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv b.csv");
    let before = error_now(&server);
    let tried = json!({
        "motion": 0,
        "effects": ["viscous@1"],
        "values": [["viscous@1.coefficient_nm_s_rad", 0.001], ["link1.mass_kg", 0.2]],
    });
    let (meta, arrays) = server.post("/s/1/what-if", &tried).curves();
    assert!(meta["rms"].as_f64().unwrap() < 0.2 * before);
    assert_eq!(arrays[0].0, "other_0");
    assert_eq!(error_now(&server), before, "nothing is kept yet");
    assert_eq!(server.post("/s/1/keep", &tried).status, 200);
    assert!(error_now(&server) < 0.2 * before);
    let wrong = json!({ "effects": [], "values": [["link1.mass_kg", -1.0]] });
    let refused = server.post("/s/1/what-if", &wrong);
    assert_eq!(refused.status, 422);
    assert!(
        refused.json()["error"]
            .as_str()
            .unwrap()
            .contains("link1.mass_kg")
    );
}

#[test]
fn a_challenge_is_played_and_counted() {
    let bench = Bench::new();
    let server = bench.lab("");
    let begun = server.post("/s/1/round", &json!({ "seed": 7 })).json();
    assert_eq!(begun["go"], "/s/2/compare");
    bench.run("challenge new --seed 7 -o riddle");
    assert_eq!(
        server.get("/s/2/download/model.toml").text(),
        bench.get("riddle/nominal.toml")
    );
    assert_eq!(server.post("/s/2/hand-in", &json!({})).status, 200);
    let told = bench
        .run("challenge score riddle riddle/nominal.toml --json")
        .json();
    let result = &server.get("/s/2/download/session.json").json()["round"]["result"];
    for key in [
        "hidden",
        "solved",
        "error_rad",
        "true_error_rad",
        "nominal_error_rad",
    ] {
        assert_eq!(result[key], told[key], "{key}");
    }
    assert_eq!(
        server.post("/s/2/hand-in", &json!({})).status,
        422,
        "once only"
    );
    let page = server.get("/s/1/challenge").text();
    assert!(page.contains("of 1 solved"), "{page}");
}

#[test]
fn gains_are_those_of_the_command_line() {
    let bench = Bench::new();
    bench.put(
        "handstand.toml",
        include_str!("../../../models/handstand.toml"),
    );
    let server = bench.lab("handstand.toml");
    let asked = json!({ "states": 1.0, "speeds": 0.5, "ts_s": 0.01, "delay_s": null });
    let made = server.post("/s/1/gains", &asked).json();
    let command = made["command"].as_str().unwrap();
    let options = command.split_once("--q").expect("weights").1;
    let told = bench.run(&format!("gains handstand.toml --json --q{options}"));
    let told = told.json();
    assert_eq!(told["q"][4][4], 0.005);
    assert_eq!(made["k"], told["k"]);
    assert_eq!(made["poles"], told["loop_poles"]);
    assert_eq!(
        made["fixed"]["radius_fixed"],
        told["fixed"]["spectral_radius_fixed"]
    );
    let header = server
        .get("/s/1/gains-file/gains.h?states=1&speeds=1&ts_s=0.01")
        .text();
    assert!(
        header.contains("#define") || header.contains("int16_t"),
        "{header}"
    );
    let unsolvable = server.post(
        "/s/1/gains",
        &json!({ "states": -1.0, "speeds": 1.0, "ts_s": 0.01 }),
    );
    assert_eq!(unsolvable.status, 422);
}

#[test]
fn a_model_is_made_from_a_form_and_its_columns_picked() {
    let bench = Bench::new();
    let server = bench.lab("");
    let log = "zeit;winkel <b>\n".to_string()
        + &(0..50)
            .map(|k| format!("{};{}\n", 10 * k, k % 7))
            .collect::<String>();
    let sent = server.post_bytes("/s/1/upload?name=swing.csv", "text/csv", log.as_bytes());
    assert_eq!(sent.status, 200, "{}", sent.text());
    let (meta, _) = server.get("/s/1/raw?file=swing.csv").curves();
    assert_eq!(meta["names"], json!(["zeit", "winkel <b>"]));
    let plan = json!({
        "name": "rod", "angle_zero": "hanging", "angles": "relative",
        "links": [{ "length_m": 0.3, "com_m": 0.15, "mass_kg": 0.2, "inertia_kg_m2": null,
                    "drive": "passive", "gain": null, "stall_torque_nm": null,
                    "no_load_speed_rad_s": null }],
    });
    assert_eq!(server.post("/s/1/new-model", &plan).status, 200);
    assert!(
        server.get("/s/1/data").text().contains("no column"),
        "said where the log is"
    );
    assert_eq!(server.get("/s/1/curves?motion=0").status, 422);
    let columns = json!({ "columns": [
        { "quantity": "time", "column": "zeit", "unit": "ms" },
        { "quantity": "joint1.position", "column": "winkel <b>", "unit": "deg", "reversed": true },
    ] });
    assert_eq!(server.post("/s/1/columns", &columns).status, 200);
    let (_, arrays) = server.get("/s/1/curves?motion=0").curves();
    let (_, measured) = arrays
        .iter()
        .find(|(name, _)| name == "measured_0")
        .unwrap();
    assert_eq!(measured[1], -(1.0_f64.to_radians()) as f32);
    let toml = server.get("/s/1/download/model.toml").text();
    assert!(toml.starts_with("# Written from a form"), "{toml}");
}
