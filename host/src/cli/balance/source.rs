//! Where the plan and the first link's attitude come from.

use super::{AttitudeKind, BalanceArgs};
use crate::cli::deploy::{uses_table, verdict};
use crate::cli::{Console, ExitStatus};
use handstand::deploy::balance::{AttitudeLines, AttitudeSource};
use handstand::deploy::plan_of_file;
use handstand::{Error, Model, Result};
use handstand_shared::plan::Plan;
use serde_json::json;
use std::path::Path;

/// The plan of a file: read, or designed for a model.
///
/// # Errors
/// A file that cannot be read, or values that cannot be designed for.
pub fn plan(args: &BalanceArgs, file: &Path, console: &Console) -> Result<Plan> {
    if file.extension().is_some_and(|ending| ending == "rs") {
        let text = std::fs::read_to_string(file);
        let text = text.map_err(|error| Error::file(file, "read", error))?;
        return plan_of_file(&text, file);
    }
    let model = Model::load(file)?;
    let basis = args.board.basis(&model)?;
    console.say(&uses_table(&basis.uses));
    basis.plan(&model)
}

/// Designs the plan of a model and tries it out.
///
/// # Errors
/// No model is given, or one that cannot be designed for.
pub fn dry_run(args: &BalanceArgs, console: &Console) -> Result<ExitStatus> {
    let is_model = |file: &&Path| file.extension().is_none_or(|ending| ending != "rs");
    let Some(file) = args.plan.as_deref().filter(is_model) else {
        return Err(Error::usage(
            "--dry-run tries a plan out on the robot of a model, and none is given",
            "give MODEL.toml",
        ));
    };
    let model = Model::load(file)?;
    let basis = args.board.basis(&model)?;
    let plan = basis.plan(&model)?;
    let verdict = verdict::of(&model, &plan, &basis, console)?;
    let data = json!({
        "fingerprint": format!("{:08X}", plan.fingerprint()),
        "effects": basis.uses,
        "verdict": verdict.as_ref(),
    });
    console.result(&data, || {
        let words = verdict::words(verdict.as_ref(), &plan);
        format!("{}\n{words}", uses_table(&basis.uses))
    })?;
    Ok(ExitStatus::answer(verdict::holds(verdict.as_ref())))
}

/// Where the attitude comes from.
///
/// # Errors
/// A simulated robot is wanted, and there is none.
pub fn attitude(
    args: &BalanceArgs,
    plan: Option<&Plan>,
    robot: Option<AttitudeSource>,
) -> Result<AttitudeSource> {
    let source = match args.attitude {
        None => AttitudeSource::of_plan(plan, robot),
        Some(AttitudeKind::Gyro) => AttitudeSource::Gyro,
        Some(AttitudeKind::Lines) => {
            let lines = std::io::BufReader::new(std::io::stdin());
            AttitudeSource::Lines(AttitudeLines::read(lines, "stdin"))
        }
        Some(AttitudeKind::Robot) => robot.ok_or_else(|| {
            Error::usage(
                "there is no simulated robot behind this port",
                "--port sim-cm5:robot=MODEL.toml,start=held has one; else --attitude lines",
            )
        })?,
    };
    Ok(source)
}
