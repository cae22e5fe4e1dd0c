//! What only motions of one side show, those that were fitted or those held out: no effect can be
//! learned from the one and proved by the other.

use super::findings::{Diagnosis, MotionError};
use super::names::listed;
use super::verdict::MOST_NOMINAL;
use super::words::{LOGS, MODEL, either, explained_by};
use crate::output::number::{short, with_unit};

/// What leaves more than this share of the held-out error does not show in it.
const LEAST_GAIN: f64 = 0.97;

/// What is missing where nothing was found, if motions of one side alone show it.
pub(super) fn headline(diagnosis: &Diagnosis) -> Option<String> {
    let (held_out, names) = one_sided(diagnosis)?;
    Some(if held_out {
        format!(
            "Something is missing that only motions held out show ({names}): the others do not \
         tell what."
        )
    } else {
        format!(
            "Something is missing that only fitted motions show ({names}): those held out prove \
         nothing of it."
        )
    })
}

/// What is said where the motions that alone show something were learned from, and nothing proves
/// it: "Shows in c.csv alone: saturation at joint 1 (limit_nm = 0.27 N m); record another motion
/// like it to prove it."
pub(super) fn shown_alone(diagnosis: &Diagnosis) -> String {
    let names = diagnosis.shows_alone.as_slice();
    let them = if names.len() > 1 { "them" } else { "it" };
    let claim = if wants_proof_alone(diagnosis) {
        explained_by(&diagnosis.effects, &diagnosis.wrong_values) + &sizes(diagnosis)
    } else {
        either(diagnosis)
    };
    format!(
        "Shows in {} alone: {claim}; record another motion like {them} to prove it.",
        listed(names.to_vec())
    )
}

/// Whether nothing but a proof is wanting: no other explanation does as well.
pub(super) fn wants_proof_alone(diagnosis: &Diagnosis) -> bool {
    let open = diagnosis.alternatives.iter().any(|rival| !rival.same_law);
    !diagnosis.shows_alone.is_empty() && !open
}

/// Values of the effects in brackets: " (limit_nm = 0.27 N m)".
fn sizes(diagnosis: &Diagnosis) -> String {
    let values = diagnosis
        .effects
        .iter()
        .flat_map(|effect| &effect.parameters);
    let values = values.map(|value| {
        format!(
            "{} = {}",
            value.key,
            with_unit(&short(value.value), &value.unit)
        )
    });
    let values: Vec<String> = values.collect();
    if values.is_empty() {
        return String::new();
    }
    format!(" ({})", values.join(", "))
}

/// How it is proved.
pub(super) fn prove(diagnosis: &Diagnosis) -> Option<String> {
    let names = diagnosis.shows_alone.as_slice();
    (!names.is_empty()).then(|| {
        format!(
            "Record another motion like {}, and hold it out: handstand diagnose {MODEL} {LOGS} \
             --holdout NEW.csv",
            listed(names.to_vec())
        )
    })
}

/// What to do about it.
pub(super) fn next(diagnosis: &Diagnosis) -> Option<String> {
    let (held_out, names) = one_sided(diagnosis)?;
    Some(if held_out {
        format!(
            "Learn from a motion like {names}: record another, or fit it and hold out a different \
         one."
        )
    } else {
        format!("Hold out a motion like {names}: record another, or take it out of the fit.")
    })
}

/// Whether more than noise is left of a motion.
pub(super) fn shows(diagnosis: &Diagnosis, motion: &MotionError) -> bool {
    motion.after_rad > MOST_NOMINAL * diagnosis.error.floor_rad
}

/// That what was found is not proved: the motions held out were predicted as well without it.
pub(super) fn unproved(diagnosis: &Diagnosis) -> Option<String> {
    let error = &diagnosis.error;
    let found = !diagnosis.effects.is_empty() || !diagnosis.wrong_values.is_empty();
    let gains = error.after_rad < LEAST_GAIN * error.before_rad;
    let shown = |m: &&MotionError| !m.held_out && m.before_rad > MOST_NOMINAL * error.floor_rad;
    let fitted: Vec<String> = diagnosis
        .motions
        .iter()
        .filter(shown)
        .map(|m| m.motion.clone())
        .collect();
    (found && error.held_out && !gains && !fitted.is_empty()).then(|| {
        format!(
            "only fitted motions show this ({}): those held out prove nothing of it",
            listed(fitted)
        )
    })
}

/// The side whose motions alone are left above what is nominal, and their names.
fn one_sided(diagnosis: &Diagnosis) -> Option<(bool, String)> {
    let showing = diagnosis.motions.iter().filter(|m| shows(diagnosis, m));
    let (held_out, fitted): (Vec<_>, Vec<_>) = showing.partition(|motion| motion.held_out);
    let names = |motions: Vec<&MotionError>| {
        let names = motions.iter().map(|motion| motion.motion.clone());
        listed(names.collect())
    };
    match (
        diagnosis.error.held_out,
        held_out.as_slice(),
        fitted.as_slice(),
    ) {
        (true, [_, ..], []) => Some((true, names(held_out))),
        (true, [], [_, ..]) => Some((false, names(fitted))),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
