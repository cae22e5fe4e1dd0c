//! Models that are brought, made, changed and judged in the lab.

use super::server::LabServer;
use crate::common::Bench;
use serde_json::{Value, json};

const URDF: &str = r#"<robot name="arm"><link name="base"/><link name="rod"><inertial>
<origin xyz="0 0 -0.1"/><mass value="0.2"/><inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0"
izz="1e-3"/></inertial></link><joint name="shoulder" type="continuous"><parent link="base"/>
<child link="rod"/><axis xyz="0 1 0"/></joint></robot>"#;

fn steps(server: &LabServer) -> Vec<Value> {
    let saved = server.get("/s/1/download/session.json").json();
    saved["steps"].as_array().unwrap().clone()
}

/// A log of an arm with a duty, in degrees and per cent.
pub fn duty_log() -> String {
    let row = |k: u32| {
        let t = 0.01 * f64::from(k);
        let (angle, duty) = (30.0 * (2.0 * t).sin(), 20.0 * (2.0 * t).cos());
        format!("{t:.2},{angle:.3},{duty:.2}\n")
    };
    "time_s,angle_deg,duty_pct\n".to_string() + &(0..300).map(row).collect::<String>()
}

#[test]
fn model_files_are_taken_by_drop() {
    let bench = Bench::new();
    let server = bench.lab("");
    let drop = |name: &str, text: &str| {
        server.post_bytes(&format!("/s/1/upload?name={name}"), "", text.as_bytes())
    };
    assert_eq!(drop("arm.toml", &bench.get("model.toml")).status, 200);
    assert_eq!(steps(&server)[0]["title"], "from arm.toml");
    assert_eq!(steps(&server)[0]["toml"], bench.get("model.toml"));
    assert_eq!(drop("arm.urdf", URDF).status, 200);
    bench.put("arm.urdf", URDF);
    assert_eq!(bench.run("import arm.urdf -o arm.toml").code, Some(0));
    assert_eq!(steps(&server)[1]["toml"], bench.get("arm.toml"));
    assert_eq!(
        steps(&server)[1]["title"],
        "imported from arm.urdf, joints shoulder"
    );
    for (name, text) in [
        ("a.toml", "[rig"),
        ("a.urdf", "<html/>"),
        ("a.xml", "<mujoco>"),
    ] {
        let refused = drop(name, text);
        assert_eq!(refused.status, 422, "{name}");
        assert!(
            refused.json()["error"].as_str().unwrap().contains(name),
            "{}",
            refused.text()
        );
    }
    assert_eq!(steps(&server).len(), 2);
}

#[test]
fn the_command_line_takes_logs_alone_and_foreign_models() {
    let bench = Bench::new();
    let server = bench.lab("a.csv b.csv --no-browser");
    let page = server.get("/s/1/data").text();
    let [make, text] = ["id=\"make\"", "id=\"toml\""].map(|id| page.find(id).unwrap());
    assert!(make < text, "the form stands above the text");
    assert!(page.contains("a.csv") && page.contains("href=\"#make\""));
    assert!(
        server
            .get("/s/1/learn")
            .text()
            .contains("Make a model for your log")
    );
    drop(server);
    let bench = Bench::new();
    bench.put("arm.urdf", URDF);
    let server = bench.lab("a.csv arm.urdf");
    assert!(
        steps(&server)[0]["toml"]
            .as_str()
            .unwrap()
            .contains("shoulder")
    );
    let twice = bench.run("lab model.toml arm.urdf a.csv");
    assert_eq!(twice.code, Some(2), "{twice:?}");
}

#[test]
fn the_form_is_filled_from_the_log_and_leads_to_compare() {
    let bench = Bench::new();
    let server = bench.lab("");
    server.post_bytes("/s/1/upload?name=arm.csv", "", duty_log().as_bytes());
    let page = server.get("/s/1/data").text();
    let (_, draft) = page.split_once("id=\"draft\"").unwrap();
    let draft = draft
        .split_once('>')
        .unwrap()
        .1
        .split("</script>")
        .next()
        .unwrap();
    let draft: Value = serde_json::from_str(draft).unwrap();
    let link = &draft["links"][0];
    assert_eq!(link["drive"], "duty");
    assert!(
        link["no_load_speed_rad_s"].as_f64().unwrap() > 0.0,
        "a limit of speed is proposed"
    );
    let mut plan = draft.clone();
    plan["friction"] = json!([{ "viscous_nm_s_rad": 0.01, "coulomb_nm": 0.05 }]);
    let made = server.post("/s/1/new-model", &plan);
    assert_eq!(made.json()["go"], "/s/1/compare", "{}", made.text());
    let toml = server.get("/s/1/download/model.toml").text();
    for part in [
        "drive = \"duty\"",
        "column = \"duty_pct\", unit = \"%\"",
        "kind = \"viscous\"\njoint = 1\ncoefficient_nm_s_rad = 0.01",
        "kind = \"coulomb\"\njoint = 1\ntorque_nm = 0.05",
    ] {
        assert!(toml.contains(part), "{part}:\n{toml}");
    }
    // What is impossible names its key, which the page marks.
    plan["links"][0]["mass_kg"] = json!(-1);
    let refused = server.post("/s/1/new-model", &plan);
    assert_eq!(refused.status, 422);
    assert!(refused.text().contains("mass_kg") && refused.text().contains("-1"));
}

#[test]
fn a_log_in_degrees_is_shown_in_degrees() {
    let bench = Bench::new();
    bench.put("arm.csv", duty_log());
    assert_eq!(bench.run("init arm.csv -o arm.toml").code, Some(0));
    let told = bench.run("compare arm.toml arm.csv --json").json();
    let rms = told["comparisons"][0]["signals"][0]["rms_rad"]
        .as_f64()
        .unwrap();
    let server = bench.lab("arm.toml arm.csv");
    let (meta, _) = server.get("/s/1/curves?motion=0").curves();
    assert_eq!(meta["shown"][0]["unit"], "deg");
    assert_eq!(meta["rms"].as_f64().unwrap(), rms);
    let per_si = meta["error"]["error_per_si"].as_f64().unwrap();
    assert!((per_si - 180.0 / std::f64::consts::PI).abs() < 1e-9);
    for page in ["compare", "learn", "what-if"] {
        let text = server.get(&format!("/s/1/{page}")).text();
        let (_, error) = text.split_once("id=\"error-now\"").unwrap();
        let error = error.split(['>', '<']).nth(1).unwrap();
        let number = error
            .strip_suffix(" deg")
            .unwrap_or_else(|| panic!("{page}: {error}"));
        let number: f64 = number.parse().unwrap();
        assert!(
            (number / (per_si * rms) - 1.0).abs() < 0.01,
            "{page}: {error}"
        );
    }
    let (dots, _) = server.get("/s/1/scatter?joint=0").curves();
    assert!(dots["variables"].to_string().contains("\"deg\""), "{dots}");
}

#[test]
fn what_was_fitted_stands_there_with_its_interval_and_unit() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv b.csv");
    server.post("/s/1/add", &json!({ "names": "viscous@1" }));
    assert_eq!(server.wait()["state"], "done");
    let step = &steps(&server)[1];
    assert_eq!(step["title"], "viscous friction at joint 1 added");
    let values = step["values"].as_array().unwrap();
    let fitted = values
        .iter()
        .find(|v| v["path"] == "viscous@1.coefficient_nm_s_rad")
        .unwrap();
    let [low, value, high] = ["low", "value", "high"].map(|key| fitted[key].as_f64().unwrap());
    assert!(
        low < value && value < high && fitted["unit"] == "N m s/rad",
        "{fitted}"
    );
    let page = server.get("/s/1/learn").text();
    assert!(page.contains("95 % interval") && page.contains("N m s/rad"));
    assert!(
        page.contains("Undo: viscous friction at joint 1 added"),
        "a sentence, no address"
    );
    let report = server.get("/s/1/download/report.html").text();
    assert!(report.contains("Fitted values") && report.contains("N m s/rad"));
    // Chosen by hand: what is ticked, and nothing else.
    server.post("/s/1/fit", &json!({ "names": "link1.com_m" }));
    assert_eq!(server.wait()["state"], "done");
    let values = steps(&server)[2]["values"].clone();
    assert_eq!(values.as_array().unwrap().len(), 1, "{values}");
    assert_eq!(values[0]["path"], "link1.com_m");
}

#[test]
fn a_report_is_titled_by_the_verdict() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv b.csv");
    server.post("/s/1/diagnose", &json!({}));
    assert_eq!(server.wait()["state"], "done");
    let said = server.get("/s/1/download/session.json").json()["diagnosis"].clone();
    let headline = said["summary"][0].as_str().unwrap();
    let report = server.get("/s/1/download/report.html").text();
    assert!(
        report.contains(&format!("<title>{headline}</title>")),
        "{headline}"
    );
    assert!(report.contains("Diagnosis of model 0: named"));
}

/// Two tabs: what was meant for one model is not done to another.
#[test]
fn what_was_meant_for_another_model_is_refused() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv b.csv");
    let shown = |server: &LabServer| {
        let page = server.get("/s/1/what-if").text();
        let (_, hash) = page.split_once("data-model=\"").unwrap();
        hash.split('"').next().unwrap().to_string()
    };
    let first = shown(&server);
    let tried = json!({ "effects": [], "values": [["link1.mass_kg", 0.25]] });
    let keep = |model: &str| {
        let origin = format!("http://127.0.0.1:{}", server.port);
        let headers = [
            ("Cookie", server.cookies.as_str()),
            ("Origin", origin.as_str()),
            ("Content-Type", "application/json"),
            ("Handstand-Model", model),
        ];
        server.ask("POST", "/s/1/keep", &headers, tried.to_string().as_bytes())
    };
    assert_eq!(keep(&first).status, 200);
    assert_eq!(
        steps(&server)[1]["title"],
        "set by hand: mass of link 1 to 0.2500 kg"
    );
    let refused = keep(&first);
    assert_eq!(refused.status, 409);
    assert!(
        refused.text().contains("model 1: set by hand"),
        "{}",
        refused.text()
    );
    assert_eq!(steps(&server).len(), 2, "nothing was done");
    assert_eq!(keep(&shown(&server)).status, 200);
}

#[test]
fn an_unreadable_log_is_left_out_with_a_word() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv");
    let before = server.get("/s/1/curves?motion=0").curves().0["rms"].clone();
    for (name, text) in [
        ("empty.csv", ""),
        ("head.csv", "time_s,angle_rad\n"),
        ("x.csv", "t,q\n0,1\n"),
    ] {
        server.post_bytes(&format!("/s/1/upload?name={name}"), "", text.as_bytes());
    }
    for page in ["compare", "learn", "what-if", "robot"] {
        let text = server.get(&format!("/s/1/{page}")).text();
        assert!(
            text.contains("Without empty.csv, head.csv and x.csv"),
            "{page}"
        );
        assert!(text.contains("id=\"error-now\""), "{page}");
    }
    assert_eq!(server.get("/s/1/curves?motion=0").curves().0["rms"], before);
    let commands = server.get("/s/1/compare").text();
    assert!(
        !commands.contains("logs/x.csv"),
        "a command that would be refused"
    );
    server.post("/s/1/diagnose", &json!({}));
    assert_eq!(server.wait()["state"], "done");
    // Before any model reads them, what is no log is said to be none.
    let server = {
        drop(server);
        let bench = Bench::new();
        let server = bench.lab("");
        server.post_bytes(
            "/s/1/upload?name=binary.csv",
            "",
            &[0, 159, 146, 150, 10, 0],
        );
        server
    };
    assert!(server.get("/s/1/data").text().contains("It is left out"));
}

#[test]
fn the_next_experiment_is_proposed_as_on_the_command_line() {
    let bench = Bench::new();
    let server = bench.lab("");
    server.post("/s/1/example", &json!({ "example": "coulomb" }));
    server.post("/s/1/next", &json!({}));
    let end = server.wait();
    assert_eq!(end["state"], "done", "{end}");
    let page = server.get("/s/1/learn").text();
    assert!(
        page.contains("The next experiment") && page.contains("download/next.csv"),
        "{page}"
    );
    let motion = server.get("/s/1/download/next.csv");
    assert_eq!(motion.status, 200);
    let folder = bench.path("sessions/1");
    let saved = server.get("/s/1/download/session.json").json();
    let logs = saved["logs"].as_array().unwrap();
    let mut words = vec!["next".to_string(), "model-0.toml".into()];
    let name = |log: &Value| format!("logs/{}", log["file"].as_str().unwrap());
    words.extend(logs.iter().filter(|log| log["held_out"] == false).map(name));
    words.push("--holdout".into());
    words.extend(logs.iter().filter(|log| log["held_out"] == true).map(name));
    words.extend(["-o".into(), "told.csv".into()]);
    let ran = std::process::Command::new(env!("CARGO_BIN_EXE_handstand"))
        .args(&words)
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(ran.status.success(), "{ran:?}");
    assert_eq!(
        motion.text(),
        std::fs::read_to_string(folder.join("told.csv")).unwrap()
    );

    // A rig that swings freely is told at once.
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv");
    server.post("/s/1/next", &json!({}));
    let end = server.wait();
    assert_eq!(end["state"], "failed");
    assert!(
        end["error"]
            .as_str()
            .unwrap()
            .contains("no joint is driven"),
        "{end}"
    );
}
