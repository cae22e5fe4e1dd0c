//! What is said of the logs, and what that is worth.

use super::case::{Convention, ConventionCase, Read};
use crate::hidden::said as said_by;
use crate::spoiled::{Answer, said};
use handstand::diagnose::conventions::{Correction, leave_out, search, unexplained_refitted};
use handstand::diagnose::{DiagnoseOptions, diagnose};
use handstand::report::diagnosis_json;
use serde::Serialize;
use std::path::Path;
use std::time::Instant;

/// A convention that raises what the model leaves unexplained by less, friction fitted either way,
/// cannot be seen by any simulation: the zero of a joint about a vertical axis.
const SEEN: f64 = 1.25;
/// How far the zero that is told may lie from the true one, deg.
const NEAR_DEG: f64 = 1.0;
/// Units that differ by a smaller share are the same.
const SAME_UNIT: f64 = 1e-6;

/// One arm judged.
#[derive(Debug, Clone, Serialize)]
pub struct ConventionOutcome {
    /// Its seed.
    pub seed: u64,
    /// How one joint is written; none where all follow the file.
    pub convention: Option<Convention>,
    /// What the answer is worth.
    pub answer: Answer,
    /// How far the zero that is told lies from the true one, deg.
    pub off_deg: Option<f64>,
    /// Whether the check said nothing and the diagnosis was asked.
    pub by_diagnosis: bool,
    /// What is proposed, for people.
    pub said: Vec<String>,
    /// How long the check took, s.
    pub seconds: f64,
}

/// Simulates the arm that this URDF describes and judges what is said of its logs.
///
/// # Errors
/// Files that cannot be made, or are refused.
pub fn try_convention(case: ConventionCase, urdf: &Path) -> Result<ConventionOutcome, String> {
    let passing = tempfile::tempdir().map_err(|error| error.to_string())?;
    let read = case.read(urdf, passing.path())?;
    let [training, held_out] = &read.motions;
    let motions = [training.as_slice(), held_out.as_slice()].concat();
    let begun = Instant::now();
    let found = search(&read.model, &motions);
    let left_out = leave_out(&read.model, &motions);
    let mut outcome = ConventionOutcome {
        seed: case.seed,
        convention: read.convention.clone(),
        answer: Answer::Right,
        off_deg: None,
        by_diagnosis: false,
        said: said(&found, &left_out),
        seconds: begun.elapsed().as_secs_f64(),
    };
    let is_silent = found.is_empty() && left_out.is_empty();
    let Some(convention) = &read.convention else {
        if !is_silent {
            outcome.answer = Answer::Other;
        }
        return Ok(outcome);
    };
    if is_silent {
        without_remedy(&mut outcome, convention, &read);
        return Ok(outcome);
    }
    let trials = found
        .iter()
        .flat_map(|f| [&f.trial].into_iter().chain(&f.rivals));
    let corrections: Vec<&Correction> = trials.map(|trial| &trial.correction).collect();
    let mut off = corrections.iter().filter_map(|c| off_deg(c, convention));
    outcome.off_deg = off.next();
    if !corrections
        .iter()
        .any(|correction| mends(correction, convention))
    {
        outcome.answer = Answer::Other;
    }
    Ok(outcome)
}

/// Where the check is silent: a zero that may be a bent link is for the diagnosis to find.
fn without_remedy(outcome: &mut ConventionOutcome, convention: &Convention, read: &Read) {
    let all = read.motions.concat();
    let left = |motions| unexplained_refitted(&read.model, motions);
    outcome.answer = match (left(&convention.undone(&all)), left(&all)) {
        (Some(before), Some(after)) if after >= SEEN * before => Answer::Missed,
        _ => Answer::Unseen,
    };
    if outcome.answer == Answer::Unseen || convention.kind != "zero" {
        return;
    }
    outcome.by_diagnosis = true;
    let [training, held_out] = read.motions.clone();
    let options = DiagnoseOptions::default();
    let diagnosis = diagnose(&read.model, training, held_out, &options, &|_| {});
    let name = format!("encoder_zero@{}", convention.joint);
    let told = said_by(&diagnosis_json(&diagnosis));
    outcome.said = vec![format!("{}: {:?}", told.verdict, told.sets)];
    let mut zeros = told
        .effects
        .iter()
        .filter(|effect| effect.address() == name);
    let value = zeros.next().and_then(|zero| zero.value("offset_rad"));
    outcome.off_deg = value.map(|value| (value - convention.offset).to_degrees());
    let is_near = outcome.off_deg.is_some_and(|off| off.abs() <= NEAR_DEG);
    outcome.answer = if is_near && told.sets.contains(&vec![name]) {
        Answer::Right
    } else if told.verdict == "nominal" {
        Answer::Missed
    } else {
        Answer::Other
    };
}

/// How far the zero of a correction lies from that of the joint, deg.
fn off_deg(correction: &Correction, convention: &Convention) -> Option<f64> {
    match correction {
        Correction::Offset(_, added)
            if convention.kind == "zero" && of_joint(correction, convention) =>
        {
            let off = (added + convention.offset).to_degrees();
            Some((off + 180.0).rem_euclid(360.0) - 180.0)
        }
        _ => None,
    }
}

fn of_joint(correction: &Correction, convention: &Convention) -> bool {
    correction.calibrates() == Some(convention.joint - 1)
}

fn mends(correction: &Correction, convention: &Convention) -> bool {
    of_joint(correction, convention)
        && match correction {
            Correction::Reverse(_) => convention.kind == "sign",
            Correction::Offset(..) => {
                off_deg(correction, convention).is_some_and(|off| off.abs() <= NEAR_DEG)
            }
            Correction::Unit(columns) => {
                let is_same = |si: f64| (si * convention.factor - 1.0).abs() < SAME_UNIT;
                convention.kind == "unit" && columns.iter().all(|(_, unit)| is_same(unit.si))
            }
            _ => false,
        }
}
