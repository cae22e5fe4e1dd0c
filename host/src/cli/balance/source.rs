//! Where the plan and the first link's attitude come from.

use super::{AttitudeKind, BalanceArgs};
use crate::cli::Talk;
use crate::cli::deploy::uses_table;
use handstand::deploy::balance::{AttitudeLines, AttitudeSource};
use handstand::deploy::plan_of_file;
use handstand::{Error, Model, Result};
use handstand_shared::plan::Plan;
use std::path::Path;

/// The plan of a file: read, or designed for a model.
///
/// # Errors
/// A file that cannot be read, or values that cannot be designed for.
pub fn plan(args: &BalanceArgs, file: &Path, talk: &Talk) -> Result<Plan> {
    if file.extension().is_some_and(|ending| ending == "rs") {
        let text = std::fs::read_to_string(file);
        let text = text.map_err(|error| Error::file(file, "read", error))?;
        return plan_of_file(&text, file);
    }
    let model = Model::load(file)?;
    let basis = args.board.basis(&model)?;
    talk.say(&uses_table(&basis.uses));
    basis.plan(&model)
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
