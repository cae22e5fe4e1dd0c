//! The path from a log to a better model, by the program's commands.

use super::rig::DrawnRig;
use super::simulation::record;
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// How a walk ended.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// The hidden effect is in the verdict's set, or one of those that it leaves open; or another
    /// value of it, where the first model holds it.
    Found,
    /// The first model holds it already, estimated from the log, and nothing else is missing.
    InFirstModel,
    /// The verdict is another; its summary.
    Other(String),
    /// A command refused the log, or asked for another unit; what it said.
    Refused(String),
}

/// A walk with what it took.
#[derive(Debug, Clone)]
pub struct Walk {
    /// How it ended.
    pub end: End,
    /// The diagnosis' verdict, where one was reached.
    pub verdict: String,
    /// Error of the first model on held-out motion, mrad, and what was left of it by `add`, where
    /// something was added.
    pub error_mrad: [Option<f64>; 2],
}

/// Walks from the rig's logs, written to `folder`, to a better model; `within` limits the
/// diagnosis.
pub fn walk(program: &Path, rig: &DrawnRig, folder: &Path, within: &str) -> Result<Walk, String> {
    let logs = ["a.csv", "b.csv", "c.csv"];
    for (index, name) in logs.iter().enumerate() {
        let text = rig.names.csv(&record(rig, index));
        std::fs::write(folder.join(name), text).map_err(|error| error.to_string())?;
    }
    let ended = |end: End| Walk {
        end,
        verdict: String::new(),
        error_mrad: [None; 2],
    };
    let run = |words: &[&str]| command(program, folder, words);
    let begun = run(&["init", "a.csv", "-o", "arm.toml"])?;
    if begun.code != 0 {
        return Ok(ended(End::Refused(begun.said)));
    }
    let checked = run(&["log", "check", "arm.toml", "a.csv", "b.csv", "c.csv"])?;
    if checked.code != 0 {
        return Ok(ended(End::Refused(checked.said)));
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
    let verdict = diagnosis["verdict"].as_str().unwrap_or("").to_string();
    let mut walk = Walk {
        end: end(rig, &diagnosis, &first_model(folder)),
        error_mrad: [
            diagnosis["error"]["before_rad"]
                .as_f64()
                .map(|rad| 1e3 * rad),
            None,
        ],
        verdict,
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

fn first_model(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("arm.toml")).unwrap_or_default()
}

fn end(rig: &DrawnRig, diagnosis: &Value, first_model: &str) -> End {
    let ids = rig.hidden.ids();
    let holds = |set: &Value| {
        let effects = set["effects"].as_array().into_iter().flatten();
        let mut kinds = effects.filter_map(|effect| effect["kind"].as_str());
        let values = set["wrong_values"].as_array().into_iter().flatten();
        let mut values = values.filter_map(|value| value["path"].as_str());
        let is_hidden = |path: &str| ids.iter().any(|id| path.starts_with(&format!("{id}@")));
        let names_none = set["effects"].as_array().is_none_or(Vec::is_empty);
        kinds.any(|kind| ids.contains(&kind)) || names_none && values.any(is_hidden)
    };
    let others = diagnosis["alternatives"].as_array().into_iter().flatten();
    let sets = || std::iter::once(diagnosis).chain(others.clone());
    let verdict = diagnosis["verdict"].as_str().unwrap_or("");
    let said = || diagnosis["summary"].to_string();
    let in_model = ids
        .iter()
        .any(|id| first_model.contains(&format!("kind = \"{id}\"")));
    match verdict {
        "unfit" => End::Refused(said()),
        "named" | "ambiguous" if sets().any(holds) => End::Found,
        "nominal" | "adequate" | "wrong_value" if in_model => End::InFirstModel,
        _ => End::Other(said()),
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
