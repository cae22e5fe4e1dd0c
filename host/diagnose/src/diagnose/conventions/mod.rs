//! Do signs, zeros, units, angles, drives and times of a model file agree with its logs?
//!
//! Each doubt is a [`Correction`], a change of the model file. The given model is simulated along the
//! logs as it reads them, and as it would read them corrected; a correction counts only if it
//! lowers the error clearly, and the errors are its proof. Samples that no correction mends, of a
//! joint that stands still or an input cut off at a limit, are named as rows to leave out.

mod by_hand;
mod continuous;
mod correction;
mod drives;
mod findings;
mod joint_corrections;
mod leave_out;
mod plain_friction;
mod rating;
mod reread;
mod search;
#[cfg(test)]
mod tests;
mod threshold;
mod travel;
mod trial;
mod zero;

pub use correction::{Correction, LogColumn};
pub use findings::ModelFile;
pub use leave_out::{LeaveOut, Unusable, leave_out};
pub use search::{LogFault, search};
pub use trial::{Trial, scales_torque_by};
pub use zero::FittedZero;

use crate::error::Result;
use crate::log::{LogFinding, LogRequest, expanded, read};
use crate::model::{Model, Unit};
use crate::motion::Motion;
use findings::Origin;
use reread::reread;

/// Everything found in logs: what a simulation of the model shows first ([`check`]), then what the
/// logs show by themselves ([`crate::log::check()`]).
///
/// # Errors
/// What the system refuses.
pub fn findings(
    requests: &[LogRequest],
    model: &Model,
    file: ModelFile,
) -> Result<Vec<LogFinding>> {
    let (mut findings, mended) = disagreements(requests, model, file)?;
    findings.extend(crate::log::check(requests, &mended)?);
    Ok(findings)
}

/// What of the model file and its logs does not agree, with corrections and their proofs: lines of
/// the file to change, rows to leave out. JSON logs state their own units and are not judged.
///
/// # Errors
/// Only what the system refuses; logs that cannot be read are for [`crate::log::check()`] to judge.
pub fn check(requests: &[LogRequest], model: &Model, file: ModelFile) -> Result<Vec<LogFinding>> {
    disagreements(requests, model, file).map(|(findings, _)| findings)
}

/// What does not agree, and the model with angles in the units that do: in a wrong one they seem to
/// wrap, to lie apart from their goals and to move in large steps.
fn disagreements(
    requests: &[LogRequest],
    model: &Model,
    file: ModelFile,
) -> Result<(Vec<LogFinding>, Model)> {
    let (mut motions, mut origins) = (Vec::new(), Vec::new());
    let requests = expanded(requests)?;
    for request in requests.iter().filter(|request| !request.is_json()) {
        let mut first_row = request.rows.map_or(0, |(first, _)| first);
        for motion in readable(request, model) {
            origins.push(Origin {
                log: request.path.display().to_string(),
                first_row,
            });
            first_row += motion.len();
            motions.push(motion);
        }
    }
    let (mut all, mut mended, mut in_right_units) = (Vec::new(), model.clone(), model.clone());
    if motions.is_empty() {
        return Ok((all, in_right_units));
    }
    for found in search(model, &motions) {
        all.push(findings::finding(&found, &mended, file)?);
        let correction = &found.trial.correction;
        mended = correction.applied(&mended);
        if correction.reads_an_angle_in_another_unit() {
            in_right_units = correction.applied(&in_right_units);
        }
    }
    let read: Vec<Motion> = motions
        .iter()
        .map(|motion| reread(motion, &model.log, &mended.log))
        .collect();
    let left_out = leave_out(&mended, &read);
    all.extend(
        left_out
            .iter()
            .map(|l| findings::unusable(l, &mended, &motions, &origins)),
    );
    Ok((all, in_right_units))
}

/// The motions of a log, also where times far apart, of milliseconds declared as seconds, would
/// have it refused; none where nothing helps.
fn readable(request: &LogRequest, model: &Model) -> Vec<Motion> {
    let requests = std::slice::from_ref(request);
    if let Ok(motions) = read(requests, &model.log) {
        return motions;
    }
    let Some(milliseconds) = Unit::named("ms", None).filter(|_| model.log.time.unit.name == "s")
    else {
        return Vec::new();
    };
    let mended = Correction::Unit(vec![(LogColumn::Time, milliseconds)]).applied(model);
    let motions = read(requests, &mended.log).unwrap_or_default();
    let back = motions
        .iter()
        .map(|motion| reread(motion, &mended.log, &model.log));
    back.collect()
}

/// Share of the motion that the model leaves unexplained, from fitted start states: 0 nothing, 1 as
/// much as going on at constant speed does; none where no joint moves.
pub fn unexplained(model: &Model, motions: &[Motion]) -> Option<f64> {
    reading(model, motions).rated(trial::Effort::Starts).share()
}

/// The same with the model's free values fitted.
pub fn unexplained_refitted(model: &Model, motions: &[Motion]) -> Option<f64> {
    reading(model, motions)
        .rated(trial::Effort::ValuesToTheEnd)
        .share()
}

fn reading(model: &Model, motions: &[Motion]) -> rating::ModelReading {
    let few = crate::motion::excerpts(motions, search::affordable(search::SAMPLES, model));
    rating::ModelReading::new(model.clone(), few)
}
