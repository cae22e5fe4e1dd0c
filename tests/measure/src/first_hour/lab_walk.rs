//! The same path through the lab, as its pages ask for it: logs are dropped, the model is estimated
//! from the first of them by a button, diagnosed, and what was found is added by another.

use super::judge::{End, Explanation, Judged, Walk, texts};
use super::rig::DrawnRig;
use super::walk::{LOGS, write_logs};
use handstand_browser::LabServer;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Duration;

/// Walks from the rig's logs, written to `folder`, to a better model. A diagnosis that takes longer
/// than `patience` is told that its best so far is enough.
///
/// # Errors
/// The system's refusal; work that came to no end.
pub fn walk_in_lab(
    program: &Path,
    rig: &DrawnRig,
    folder: &Path,
    patience: Duration,
) -> Result<Walk, String> {
    write_logs(rig, folder)?;
    let lab = LabServer::start(program, folder, [""; 0]);
    for name in LOGS {
        let text = std::fs::read(folder.join(name)).map_err(|error| error.to_string())?;
        let sent = lab.post_bytes(&format!("/s/1/upload?name={name}"), "text/csv", &text);
        if sent.status != 200 {
            return Ok(Walk::ended(End::Refused(sent.text())));
        }
    }
    let judge = json!({ "file": LOGS[2], "action": "hold_out" });
    lab.post("/s/1/log", &judge);
    let end = works(&lab, "model-from-log", &json!({}), patience)?;
    // A model that does not read its log leads back to the page where columns are picked.
    if end["page"] != "compare" {
        return Ok(Walk::ended(End::Refused(end.to_string())));
    }
    let found = lab.get("/s/1/findings").text();
    if found.contains("severity error") {
        return Ok(Walk::ended(End::Refused(found)));
    }
    let end = works(&lab, "diagnose", &json!({}), patience)?;
    if end["state"] != "done" {
        return Err(format!("diagnose: {end}"));
    }
    let saved = lab.get("/s/1/download/session.json").json();
    let (said, first) = (&saved["diagnosis"], &saved["steps"][0]["toml"]);
    let mrad = |key: &str| said[key].as_f64().map(|rad| 1e3 * rad);
    let judged = judged(said);
    let mut walk = Walk {
        end: judged.end(rig, first.as_str().unwrap_or_default()),
        error_mrad: [mrad("before_rad"), None],
        floor_mrad: mrad("floor_rad"),
        verdict: judged.verdict,
    };
    let names = judged.explanations.first().map(|found| &found.effects);
    if walk.end == End::Found
        && let Some(names) = names.filter(|names| !names.is_empty())
    {
        let names = json!({ "names": names.join("+") });
        let end = works(&lab, "add", &names, patience)?;
        if end["state"] != "done" {
            walk.end = End::Refused(end.to_string());
        }
        walk.error_mrad[1] = error_in_force_mrad(&lab);
    }
    Ok(walk)
}

/// Begins work and waits for its end; what takes too long is ended with its best so far.
fn works(lab: &LabServer, path: &str, data: &Value, patience: Duration) -> Result<Value, String> {
    let begun = lab.post(&format!("/s/1/{path}"), data);
    if begun.status != 200 {
        return Err(format!("{path}: {}", begun.text()));
    }
    let ended = lab.ends_within(patience).or_else(|_| {
        lab.post("/s/1/accept", &json!({}));
        lab.ends_within(patience)
    });
    ended.map_err(|state| format!("{path} comes to no end: {state}"))
}

/// What the saved diagnosis of a session says.
fn judged(said: &Value) -> Judged {
    let cards = said["cards"].as_array().into_iter().flatten();
    // Those that are ruled out, or not needed, are no part of the verdict.
    let open =
        cards.filter(|card| ["found", "rival"].contains(&card["role"].as_str().unwrap_or("")));
    let explanation = |card: &Value| Explanation {
        effects: texts(&card["effects"]),
        values: texts(&card["values"]),
    };
    Judged {
        verdict: said["verdict"].as_str().unwrap_or("").to_string(),
        summary: said["summary"].to_string(),
        explanations: open.map(explanation).collect(),
    }
}

/// The error that the status bar shows, mrad.
fn error_in_force_mrad(lab: &LabServer) -> Option<f64> {
    let shown = lab.get("/s/1/error").text();
    let (_, error) = shown.split_once("data-error=\"")?;
    let rad: f64 = error.split('"').next()?.parse().ok()?;
    Some(1e3 * rad)
}
