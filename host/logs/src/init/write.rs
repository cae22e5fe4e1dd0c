//! A guessed model as a file that says what was guessed.

use super::log_guess::{JointGuess, LogGuess, PayloadGuess};
use super::{ColumnGuess, Draft};
use crate::error::Result;
use crate::model::RateSensor;
use crate::model::new_model::model_toml;
use std::fmt::Write as _;

pub(super) fn toml(draft: &Draft) -> Result<String> {
    let mut head = String::from("# Guessed from a log; go through it line by line:\n");
    for guess in &draft.guesses {
        let line = format!("{}: {} ({})", guess.what, guess.guess, guess.why);
        let _ = writeln!(head, "# - {}", line.replace(char::is_control, " "));
    }
    head.push_str(
        "# `handstand log check` tells which signs, zeros, units and angles do not agree with a \
         log,\n# `handstand fit` estimates what [fit] lists, `handstand diagnose` finds what is \
         missing.\n\n",
    );
    model_toml(&draft.plan, &head, &tail(draft))
}

fn tail(draft: &Draft) -> String {
    let drives: Vec<&str> = draft.plan.links.iter().map(|l| l.drive.as_str()).collect();
    let free = draft.free.clone().unwrap_or_else(|| free(draft));
    let free: Vec<String> = free.iter().map(|path| format!("    {path:?},\n")).collect();
    let mut text = friction(draft);
    text += &format!(
        "\n# Guesses that a fit may change. What the logs do not determine, it says: take that off.\n\
         [fit]\nfree = [\n{}]\n",
        free.concat()
    );
    text += &log_table(draft, &drives);
    text
}

/// The friction that the log tells of, an `[[effect]]` each.
fn friction(draft: &Draft) -> String {
    let mut text = String::new();
    for effect in &draft.friction {
        let info = effect.effect.info();
        let joint = effect.joint.map_or(1, |joint| joint + 1);
        let _ = write!(
            text,
            "\n[[effect]]\nkind = \"{}\"\njoint = {joint}\n",
            info.id
        );
        for (parameter, value) in info.parameters.iter().zip(&effect.values) {
            let _ = writeln!(text, "{} = {value:?}", parameter.key);
        }
    }
    text
}

/// The `[log]` of joints that are driven so.
pub(super) fn log_table(draft: &Draft, drives: &[&str]) -> String {
    let columns = &draft.columns;
    let mut text = String::from("\n[log]\n") + &log_head(columns, draft.split_at_gap_s);
    for (index, (joint, drive)) in columns.joints.iter().zip(drives).enumerate() {
        let _ = writeln!(
            text,
            "\n[[log.joint]] # {}",
            joint.name.replace(char::is_control, " ")
        );
        let input = joint.input.as_ref().filter(|_| *drive != "passive");
        let own: [(&str, Option<&ColumnGuess>); 3] = [
            ("position", joint.position.as_ref()),
            (speed_key(index, joint), joint.velocity.as_ref()),
            ("input", input),
        ];
        for (key, column) in own {
            if let Some(column) = column {
                let _ = writeln!(text, "{key} = {}", column.toml());
            }
        }
    }
    text.replace("[[log.joint]] # \n", "[[log.joint]]\n")
}

/// The lines of `[log]` above those of the joints.
pub(super) fn log_head(columns: &LogGuess, split_at_gap_s: Option<f64>) -> String {
    let mut text = String::new();
    let quoted = |text: &str| toml_edit::Value::from(text).to_string();
    let _ = writeln!(text, "time = {}", columns.time.toml());
    if let Some(gap_s) = split_at_gap_s {
        let _ = writeln!(text, "split_at_gap_s = {gap_s:?}");
    }
    if let Some(segment) = &columns.segment {
        let _ = writeln!(
            text,
            "segment = {} # each run of equal values is a motion",
            quoted(segment)
        );
    }
    if let Some(supply) = &columns.supply {
        let _ = writeln!(text, "supply = {}", supply.toml());
    }
    if let Some(torque_on) = &columns.torque_on {
        let _ = writeln!(text, "torque_on = {}", quoted(torque_on));
    }
    if let Some(PayloadGuess { key, at_m }) = columns.payload {
        let _ = writeln!(
            text,
            "payload = {{ column = \"{key}\", unit = \"kg\", at_m = {at_m:?} }} # of each log"
        );
    }
    text
}

/// What a joint's speed is called: evidence only where its name says that it is no derivative of
/// the angle. A gyro of a link farther out reads another rate than its joint's.
fn speed_key(index: usize, joint: &JointGuess) -> &'static str {
    let is_gyro = |column: &ColumnGuess| column.name.to_lowercase().contains("gyro");
    if joint.velocity.as_ref().is_some_and(is_gyro) && index == 0 && joint.position.is_some() {
        RateSensor::Gyro.key()
    } else {
        "velocity"
    }
}

/// What logs of such a rig determine: a free chain's masses only in proportion to each other.
fn free(draft: &Draft) -> Vec<String> {
    let links = &draft.plan.links;
    let mut free = Vec::new();
    for (index, link) in links.iter().enumerate() {
        let number = index + 1;
        if !draft.columns.knows_links {
            free.push(format!("link{number}.com_m"));
        }
        if !draft.columns.knows_links && (link.drive == "torque" || index > 0) {
            free.push(format!("link{number}.inertia_kg_m2"));
        }
        if index > 0 {
            free.push(format!("link{number}.mass_kg"));
        }
        match link.drive.as_str() {
            "position" => free.push(format!("joint{number}.gain_per_rad")),
            "speed" => free.push(format!("joint{number}.gain_s_per_rad")),
            _ => {}
        }
    }
    free
}
