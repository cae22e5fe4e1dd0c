//! `handstand drift MODEL LOG... [--free PATH]...`: do a model's values differ from log to log?
//!
//! Each log is one session, or one servo on the same bench. The values that the model frees, or
//! those that `--free` names, are fitted to each log by itself; a test of homogeneity says which
//! differ by more than chance, and which log stands out from those that agree, where these are more
//! than half. Values of one effect at several joints are compared with each other too: which servo
//! is worn?
//!
//! ```console
//! $ handstand drift arm.toml monday.csv friday.csv --free coulomb@1.torque_nm
//! ```
//!
//! Exit code 1 when fewer than two logs determine the values. `--json` prints `sessions` and
//! `joints` (`path`, `unit`, `values`: `of`, `path`, `key`, `unit`, `value`, `low`, `high`,
//! `on_bound`, `stands_out`; `mean`, `probability`, `differ`), `refused` (name and reason) and
//! `held` (name, and which value shows nothing there beside others of its effect, so that it is
//! held).

use super::{Console, ExitStatus, input, show};
use handstand::Result;
use handstand::fitting::{Drift, DriftReport, DriftSession, OneValue, drift, freed};
use handstand::log::{LogRequest, expanded};
use handstand::model::JointNames;
use handstand::output::number::exact;
use handstand::report::table::columns_of;
use std::path::PathBuf;

/// Test whether a model's values differ between sessions or servos.
#[derive(Debug, clap::Args)]
pub struct DriftArgs {
    /// Model file
    model: PathBuf,
    /// Logs, each a session or a servo
    #[arg(required = true, num_args = 2.., value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    /// Value to compare instead of those the model frees: `link1.com_m`, `coulomb@1.torque_nm`
    #[arg(long, value_name = "PATH")]
    free: Vec<String>,
    #[command(flatten)]
    run: input::RunLength,
}

/// Fits each log, compares, prints.
pub fn run(args: &DriftArgs, console: &Console) -> Result<ExitStatus> {
    let mut model = input::model(&args.model)?;
    input::tell_joints(&model, console);
    let free = freed(&mut model, &args.free)?;
    // A session is read by itself; that none shares rows with another, or is a copy, shows in all.
    expanded(&args.logs)?;
    let sessions = args.logs.iter().map(|log| {
        Ok(DriftSession {
            name: log.to_string(),
            motions: input::motions(std::slice::from_ref(log), &model.log, console)?,
        })
    });
    let sessions: Vec<DriftSession> = sessions.collect::<Result<_>>()?;
    let motions = sessions.iter().flat_map(|session| &session.motions);
    let horizon = args.run.of(&model, motions)?;
    let found = drift(&model, &free, &sessions, horizon);
    console.result(&serde_json::to_value(&found).unwrap_or_default(), || {
        said(&found, &JointNames::of(&model))
    })?;
    Ok(ExitStatus::answer(sessions.len() - found.refused.len() > 1))
}

fn said(found: &DriftReport, names: &JointNames) -> String {
    let mut parts: Vec<String> = found
        .sessions
        .iter()
        .map(|drift| of(drift, "Log", names))
        .collect();
    parts.extend(found.joints.iter().map(|drift| of(drift, "Joint", names)));
    let refused = found.refused.iter();
    parts.extend(refused.map(|(name, why)| format!("refused: {name}: {why}")));
    let held = found.held.iter();
    parts.extend(held.map(|(name, sentence)| format!("{name}: {sentence}")));
    names.in_text(&parts.join("\n\n"))
}

/// A value's table, and what its test says.
fn of(drift: &Drift, heading: &str, names: &JointNames) -> String {
    let path = names.in_text(&drift.path);
    // A log may be called `joint2`, too.
    let is_joint =
        |own: &str| (heading == "Joint").then(|| own.strip_prefix("joint")?.parse().ok());
    let name = |own: &str| {
        let name = is_joint(own).flatten().and_then(|joint| names.joint(joint));
        name.unwrap_or(own).to_string()
    };
    let note = |out: bool| if out { "stands out" } else { "" };
    let columns = columns_of::<OneValue>()
        .text(heading, |value| name(&value.of))
        .text(path, |value| exact(value.fitted.value))
        .text("95 % interval", |value| {
            format!(
                "{} to {}",
                exact(value.fitted.low),
                exact(value.fitted.high)
            )
        })
        .text("Unit", |value| value.fitted.unit.clone())
        .text("", |value| note(value.stands_out).to_string());
    let table = show::table_of(&drift.values, &columns);
    let verdict = match (drift.differ, drift.probability) {
        (true, Some(p)) => format!(
            "They differ: chance alone scatters as much in {}.{}",
            cases(p),
            if drift.values.iter().any(|value| value.stands_out) {
                ""
            } else {
                " None stands out by itself."
            }
        ),
        (false, Some(p)) => format!("They agree: chance scatters as much in {}.", cases(p)),
        (_, None) => "There is nothing to compare it with.".to_string(),
    };
    format!("{table}\n{verdict}")
}

/// "3.4 % of cases".
fn cases(probability: f64) -> String {
    if probability < 1e-6 {
        "less than one of a million cases".to_string()
    } else {
        format!("{} % of cases", exact(100.0 * probability))
    }
}
