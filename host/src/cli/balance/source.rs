//! Where the plan and the first link's attitude come from.

use super::{AttitudeKind, BalanceArgs};
use handstand::deploy::balance::{AttitudeLines, AttitudeSource};
use handstand::deploy::{self, BoardLaw, plan_of_file};
use handstand::{Error, Model, Result};
use handstand_shared::plan::Plan;
use std::path::Path;

/// The plan of a file: read, or designed for a model.
///
/// # Errors
/// A file that cannot be read, or values that cannot be designed for.
pub fn plan(args: &BalanceArgs, file: &Path) -> Result<Plan> {
    if file.extension().is_some_and(|ending| ending == "rs") {
        let text = std::fs::read_to_string(file);
        let text = text.map_err(|error| Error::file(file, "read", error))?;
        return plan_of_file(&text, file);
    }
    let (model, board) = (Model::load(file)?, args.board.board()?);
    let machine = deploy::observer_design(&model, &board, &args.board.timing()?)?;
    deploy::plan(&model, BoardLaw::Observer(&machine), &board)
}

/// Where the attitude comes from, and whether that is the gyro.
///
/// # Errors
/// A simulated robot is wanted, and there is none.
pub fn attitude(
    args: &BalanceArgs,
    plan: Option<&Plan>,
    robot: Option<AttitudeSource>,
) -> Result<(AttitudeSource, bool)> {
    let wants_gyro = plan.is_some_and(|plan| !plan.gyro.from_host);
    let kind = match args.attitude {
        Some(kind) => kind,
        None if wants_gyro || robot.is_none() => AttitudeKind::Gyro,
        None => AttitudeKind::Robot,
    };
    let source = match kind {
        AttitudeKind::Gyro => AttitudeSource::Gyro,
        AttitudeKind::Lines => {
            let lines = std::io::BufReader::new(std::io::stdin());
            AttitudeSource::Lines(AttitudeLines::read(lines, "stdin"))
        }
        AttitudeKind::Robot => robot.ok_or_else(|| {
            Error::usage(
                "there is no simulated robot behind this port",
                "--port sim-cm5:robot=MODEL.toml,start=held has one; else --attitude lines",
            )
        })?,
    };
    Ok((source, kind == AttitudeKind::Gyro))
}

/// The plan wants another attitude than there is.
pub fn wrong_attitude(plan_wants_host: bool) -> Error {
    match plan_wants_host {
        true => Error::usage(
            "the plan wants the first link's attitude from the PC, and none is given",
            "--attitude lines takes it from standard input; or deploy with --gyro-per-code",
        ),
        false => Error::usage(
            "the plan takes the first link's rate from the CM-5's gyro",
            "leave --attitude out, or deploy without --gyro-per-code",
        ),
    }
}
