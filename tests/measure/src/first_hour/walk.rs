//! The path from a log to a better model, by the program's commands.

use super::judge::{End, Explanation, Judged, Walk};
use super::rig::DrawnRig;
use super::simulation::record;
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Walks from the rig's logs, written to `folder`, to a better model; `within` limits the
/// diagnosis.
pub fn walk(program: &Path, rig: &DrawnRig, folder: &Path, within: &str) -> Result<Walk, String> {
    write_logs(rig, folder)?;
    let run = |words: &[&str]| command(program, folder, words);
    let begun = run(&["init", "a.csv", "-o", "arm.toml"])?;
    if begun.code != 0 {
        return Ok(Walk::ended(End::Refused(begun.said)));
    }
    let checked = run(&["log", "check", "arm.toml", "a.csv", "b.csv", "c.csv"])?;
    if checked.code != 0 {
        return Ok(Walk::ended(End::Refused(checked.said)));
    }
    let diagnose = [
        "diagnose",
        "arm.toml",
        "a.csv",
        "b.csv",
        "--holdout",
        "c.csv",
        "--json",
    ];
    let diagnosed = run(&[&diagnose[..], &["--within", within]].concat())?;
    let diagnosis: Value = serde_json::from_str(&diagnosed.data)
        .map_err(|_| format!("diagnose: exit {}: {}", diagnosed.code, diagnosed.said))?;
    let judged = judged(&diagnosis);
    let mrad = |key: &str| diagnosis["error"][key].as_f64().map(|rad| 1e3 * rad);
    let mut walk = Walk {
        end: judged.end(rig, &first_model(folder)),
        error_mrad: [mrad("before_rad"), None],
        floor_mrad: mrad("floor_rad"),
        verdict: judged.verdict,
    };
    let added = addresses(&diagnosis["effects"]);
    if walk.end == End::Found && !added.is_empty() {
        let mut words = vec!["add", "arm.toml"];
        words.extend(added.iter().map(String::as_str));
        words.extend([
            "--fit",
            "a.csv",
            "b.csv",
            "--holdout",
            "c.csv",
            "-o",
            "better.toml",
            "--json",
        ]);
        let added = run(&words)?;
        let fitted: Value = serde_json::from_str(&added.data).unwrap_or_default();
        walk.error_mrad[1] = fitted["error"]["after_rad"].as_f64().map(|rad| 1e3 * rad);
        if added.code != 0 {
            walk.end = End::Refused(added.said);
        }
    }
    Ok(walk)
}

/// The rig's logs, of which the last one is to judge.
pub(super) const LOGS: [&str; 3] = ["a.csv", "b.csv", "c.csv"];

/// Writes the rig's logs as its recorder names and writes them.
pub(super) fn write_logs(rig: &DrawnRig, folder: &Path) -> Result<(), String> {
    for (index, name) in LOGS.iter().enumerate() {
        let text = rig.names.csv(&record(rig, index));
        std::fs::write(folder.join(name), text).map_err(|error| error.to_string())?;
    }
    Ok(())
}

fn first_model(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("arm.toml")).unwrap_or_default()
}

/// What the command line's diagnosis says.
fn judged(diagnosis: &Value) -> Judged {
    let others = diagnosis["alternatives"].as_array().into_iter().flatten();
    let values = |set: &Value| {
        let values = set["wrong_values"].as_array().into_iter().flatten();
        let values = values.filter_map(|value| value["path"].as_str());
        values.map(String::from).collect()
    };
    let explanation = |set: &Value| Explanation {
        effects: addresses(&set["effects"]),
        values: values(set),
    };
    Judged {
        verdict: diagnosis["verdict"].as_str().unwrap_or("").to_string(),
        summary: diagnosis["summary"].to_string(),
        explanations: std::iter::once(diagnosis)
            .chain(others)
            .map(explanation)
            .collect(),
    }
}

/// Addresses of effects, as `add` takes them.
fn addresses(effects: &Value) -> Vec<String> {
    let effects = effects.as_array().into_iter().flatten();
    let address = |effect: &Value| {
        let kind = effect["kind"].as_str()?;
        Some(match effect["joint"].as_u64() {
            Some(joint) => format!("{kind}@{joint}"),
            None => kind.to_string(),
        })
    };
    effects.filter_map(address).collect()
}

struct Said {
    code: i32,
    data: String,
    said: String,
}

fn command(program: &Path, folder: &Path, words: &[&str]) -> Result<Said, String> {
    let output = Command::new(program)
        .current_dir(folder)
        .args(words)
        .output()
        .map_err(|error| format!("{}: {error}", program.display()))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Ok(Said {
        code: output.status.code().unwrap_or(-1),
        data: text(&output.stdout),
        said: format!(
            "{}: {}{}",
            words.join(" "),
            text(&output.stdout),
            text(&output.stderr)
        ),
    })
}
