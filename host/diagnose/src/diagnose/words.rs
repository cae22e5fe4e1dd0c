//! A diagnosis in sentences that a student understands.
//!
//! What to do next comes as command lines in which [`MODEL`], [`LOGS`] and [`HELD_OUT`] stand for
//! the files.

mod partial;
mod values;

pub use values::change;

use super::findings::{Diagnosis, FittedEffect, Verdict, WrongValue};
use super::inseparable::{inseparable, same_in_other_words};
use super::names::{effect_name, joined, listed, value_name};
use super::one_sided;
use super::warnings::{on_bound, pairs, shorter_steps, unidentified};
use values::{size, wrong_values};

use crate::output::number::{measured, percent, short};

/// Stands in [`Diagnosis::next`] for the model file; who knows its name puts it there.
pub const MODEL: &str = "MODEL";
/// Stands for the logs that were learned from.
pub const LOGS: &str = "LOG...";
/// Stands for the logs that were held out.
pub const HELD_OUT: &str = "HELD_OUT...";

/// Explanations named in a sentence; the rest are counted.
pub const SHOWN: usize = 4;

/// Adds summary, next steps and warnings.
pub(super) fn complete(diagnosis: &mut Diagnosis) {
    diagnosis.summary = summary(diagnosis);
    diagnosis.next = next(diagnosis);
    let warnings: Vec<String> = on_bound(diagnosis)
        .chain(unidentified(diagnosis))
        .chain(pairs(diagnosis))
        .chain(shorter_steps(diagnosis))
        .collect();
    if !diagnosis.error.held_out && diagnosis.shows_alone.is_empty() {
        diagnosis.warnings.push(
            "no motion was held out: the figures are of the motions that were fitted".to_string(),
        );
    }
    diagnosis
        .warnings
        .splice(0..0, one_sided::unproved(diagnosis));
    diagnosis.warnings.extend(warnings);
}

/// The verdict as a sentence.
pub fn headline(diagnosis: &Diagnosis) -> String {
    let names = joined(&diagnosis.effects);
    match diagnosis.verdict {
        Verdict::Nominal => "The model already explains the measurement.".into(),
        Verdict::Adequate => {
            "The model is as good as was asked, though not as good as the sensors.".into()
        }
        Verdict::WrongValue => wrong_values(&diagnosis.wrong_values),
        Verdict::Named => format!("The model lacks {names}."),
        Verdict::Ambiguous if !diagnosis.shows_alone.is_empty() => {
            one_sided::shown_alone(diagnosis)
        }
        Verdict::Ambiguous if diagnosis.alternatives.is_empty() => unrivalled(diagnosis),
        Verdict::Ambiguous => rivals(diagnosis),
        Verdict::Unexplained if diagnosis.effects.is_empty() => {
            // What moves within its uncertainty is no finding.
            match diagnosis.wrong_values.as_slice() {
                wrong if !wrong.is_empty() && wrong.iter().all(|w| w.within_uncertainty) => {
                    "Something is missing: other values within their uncertainty do not explain it."
                        .into()
                }
                [] if !diagnosis.left_out.is_empty() => {
                    "Something is missing, and what was tried so far does not explain it.".into()
                }
                [] => one_sided::headline(diagnosis).unwrap_or_else(|| {
                    "Something is missing, and no known effect explains it.".into()
                }),
                wrong => {
                    let share = share(diagnosis);
                    let share =
                        share.map_or(String::new(), |share| format!("; it removes {share}"));
                    format!("{} That is not all{share}.", wrong_values(wrong))
                }
            }
        }
        Verdict::Unexplained => {
            let share = share(diagnosis);
            let share = share.map_or(String::new(), |share| format!(" and removes {share}"));
            format!("No known effect explains all of it; {names} comes closest{share}.")
        }
        Verdict::Unfit => "These data can't answer the question.".into(),
    }
}

/// An explanation without a rival among all that was tried, of a diagnosis that was ended before
/// all was.
fn unrivalled(diagnosis: &Diagnosis) -> String {
    let first = explained_by(&diagnosis.effects, &diagnosis.wrong_values);
    format!("Explained by {first}; what was not tried may explain it as well.")
}

/// "96 % of the squared error" that what was found removes; nothing where it removes none. Of
/// effects what refitted values alone remove is not their own: "of what refitted values leave of
/// it".
fn share(diagnosis: &Diagnosis) -> Option<String> {
    let error = &diagnosis.error;
    let gains = |rad: &f64| !diagnosis.effects.is_empty() && *rad < 0.999 * error.before_rad;
    let refitted = error.refitted_rad.filter(gains);
    let removed = 1.0 - (error.after_rad / refitted.unwrap_or(error.before_rad)).powi(2);
    let of = match refitted {
        Some(_) => "of the squared error that refitted values leave",
        None => "of the squared error",
    };
    (removed > 0.0).then(|| format!("{} {of}", percent(removed)))
}

/// What an explanation changes: "A at joint 1 and B", "another value of the mass of link 1".
pub fn explained_by(effects: &[FittedEffect], wrong: &[WrongValue]) -> String {
    match effects {
        [] => {
            let paths = wrong
                .iter()
                .map(|w| format!("another value of {}", value_name(&w.fitted.path)));
            listed(paths.collect())
        }
        effects => joined(effects),
    }
}

/// What a model has more or otherwise than the one as given: "A at joint 1, and other values of the
/// mass of link 1 and the torque of B"; none where nothing was found.
pub(super) fn what_was_found(effects: &[FittedEffect], wrong: &[WrongValue]) -> Option<String> {
    let values: Vec<String> = wrong.iter().map(|w| value_name(&w.fitted.path)).collect();
    let other = match values.len() {
        0 => None,
        1 => Some(format!("another value of {}", listed(values))),
        _ => Some(format!("other values of {}", listed(values))),
    };
    match (effects, other) {
        ([], other) => other,
        (effects, None) => Some(joined(effects)),
        (effects, Some(other)) => Some(format!("{}, and {other}", joined(effects))),
    }
}

/// What an explanation says of the model, as a clause: "A at joint 1 and B are missing", "the mass
/// of link 1 is twice what the file says". Of values that the file frees, whose owner claims
/// nothing of them, only where there are no others.
fn claim(effects: &[FittedEffect], wrong: &[WrongValue]) -> String {
    let claimed: Vec<&WrongValue> = wrong
        .iter()
        .filter(|w| !w.free && !w.within_uncertainty)
        .collect();
    let wrong = if claimed.is_empty() {
        wrong.iter().collect()
    } else {
        claimed
    };
    match (effects, wrong.as_slice()) {
        ([], []) => "the model needs no more than its free values refitted".to_string(),
        ([], [first, rest @ ..]) => {
            let clauses = rest
                .iter()
                .map(|w| format!("{} {}", value_name(&w.fitted.path), size(w)));
            let first = format!("{} is {}", value_name(&first.fitted.path), size(first));
            let all = std::iter::once(first).chain(clauses).collect();
            format!("{} what the file says", listed(all))
        }
        ([one], _) => format!("{} is missing", effect_name(one)),
        (several, _) => format!("{} are missing", joined(several)),
    }
}

/// "Either A is missing, or the mass of link 1 is twice what the file says."
fn rivals(diagnosis: &Diagnosis) -> String {
    let either = either(diagnosis);
    format!("E{}.", &either[1..])
}

/// The same within a sentence.
pub(super) fn either(diagnosis: &Diagnosis) -> String {
    let others = diagnosis
        .alternatives
        .iter()
        .filter(|rival| !rival.same_law);
    let others = others.map(|rival| claim(&rival.effects, &rival.wrong_values));
    let first = claim(&diagnosis.effects, &diagnosis.wrong_values);
    let mut claims: Vec<String> = std::iter::once(first).chain(others).collect();
    let more = claims.len().saturating_sub(SHOWN);
    claims.truncate(SHOWN);
    match more {
        0 => format!("either {}", claims.join(", or ")),
        more => format!("either {}, or one of {more} more", claims.join(", or ")),
    }
}

fn summary(diagnosis: &Diagnosis) -> Vec<String> {
    let mut lines = vec![headline(diagnosis)];
    lines.extend(same_in_other_words(diagnosis));
    lines.extend(inseparable(diagnosis));
    if diagnosis.verdict == Verdict::Unexplained && !diagnosis.effects.is_empty() {
        lines.push(partial::worth(diagnosis));
    }
    // The values of one of several explanations would be taken for an answer.
    let told = match diagnosis.verdict {
        Verdict::Ambiguous if !one_sided::wants_proof_alone(diagnosis) => &[],
        _ => diagnosis.effects.as_slice(),
    };
    for effect in told {
        let values = effect.parameters.iter().map(|value| {
            format!(
                "{} = {}",
                value.key,
                measured(value.value, value.low, value.high, &value.unit)
            )
        });
        lines.push(format!(
            "{}: {}.",
            effect_name(effect),
            values.collect::<Vec<_>>().join(", ")
        ));
    }
    lines.push(error_line(
        diagnosis,
        (diagnosis.error.quantity.milli(), 1e3),
    ));
    lines
}

/// What becomes of the error, in a unit of which one SI unit has so many.
pub fn error_line(diagnosis: &Diagnosis, (unit, per_si): (&str, f64)) -> String {
    let error = &diagnosis.error;
    let motions = if error.held_out { "held-out" } else { "fitted" };
    let [before, after, floor] =
        [error.before_rad, error.after_rad, error.floor_rad].map(|rad| short(per_si * rad));
    if diagnosis.effects.is_empty() && diagnosis.wrong_values.is_empty() {
        return format!(
            "The error on {motions} motions is {before} {unit}; the floor is {floor} {unit}."
        );
    }
    let with = match diagnosis.verdict {
        Verdict::Ambiguous if !diagnosis.alternatives.is_empty() => "With the first of them the",
        _ => "The",
    };
    let changes = if error.after_rad < error.before_rad {
        "falls"
    } else {
        "goes"
    };
    format!(
        "{with} error on {motions} motions {changes} from {before} to {after} {unit}; the floor is \
         {floor} {unit}."
    )
}

fn next(diagnosis: &Diagnosis) -> Vec<String> {
    let holdout = held_out(diagnosis).0;
    let search_on = (!diagnosis.left_out.is_empty())
        .then(|| format!("Search to the end: handstand diagnose {MODEL} {LOGS}{holdout}"));
    search_on
        .into_iter()
        .chain(one_sided::prove(diagnosis))
        .chain(after_verdict(diagnosis))
        .collect()
}

fn after_verdict(diagnosis: &Diagnosis) -> Vec<String> {
    match diagnosis.verdict {
        Verdict::Named => commands(diagnosis),
        Verdict::Ambiguous if diagnosis.effects.is_empty() => {
            let mut next = experiments(diagnosis);
            next.extend(refit(diagnosis));
            next
        }
        Verdict::Ambiguous => experiments(diagnosis),
        Verdict::Unexplained => {
            let isolate = "Record a motion that isolates those conditions.";
            let holdout = held_out(diagnosis).0;
            vec![
                format!("See where it fails: handstand compare {MODEL} {LOGS}"),
                format!(
                    "Look for a law that the library lacks: handstand discover {MODEL} \
                     {LOGS}{holdout}"
                ),
                one_sided::next(diagnosis).unwrap_or_else(|| isolate.to_string()),
            ]
        }
        Verdict::WrongValue => refit(diagnosis),
        Verdict::Nominal | Verdict::Adequate => vec![
            "To look closer, record with finer resolution or with motions that reach further."
                .to_string(),
        ],
        Verdict::Unfit => vec!["Mend the logs as said, and try again.".to_string()],
    }
}

/// The wrong values fitted, then both models side by side. Where none is beyond its uncertainty, as
/// the file has them: with what is known of them.
fn refit(diagnosis: &Diagnosis) -> Vec<String> {
    let (holdout, judged) = held_out(diagnosis);
    let wrong = &diagnosis.wrong_values;
    let free: Vec<String> = if wrong.iter().all(|w| w.within_uncertainty) {
        Vec::new()
    } else {
        let option = |wrong: &WrongValue| format!(" --free {}", wrong.fitted.path);
        wrong.iter().map(option).collect()
    };
    let (free, horizon) = (free.concat(), horizon(diagnosis));
    vec![
        format!("Mend it: handstand fit {MODEL} {LOGS}{free}{holdout}{horizon} -o better.toml"),
        format!(
            "See what it gains: handstand compare {MODEL} {judged} --model better.toml{horizon}"
        ),
    ]
}

/// The option that holds motions out, and the motions that are judged.
fn held_out(diagnosis: &Diagnosis) -> (String, &'static str) {
    if diagnosis.error.held_out {
        (format!(" --holdout {HELD_OUT}"), HELD_OUT)
    } else {
        (String::new(), LOGS)
    }
}

/// The option that asks for the horizon the verdict rests on.
fn horizon(diagnosis: &Diagnosis) -> String {
    diagnosis
        .horizon_s
        .map_or(String::new(), |seconds| format!(" --horizon {seconds}"))
}

/// The effects added to the model, then both models side by side.
fn commands(diagnosis: &Diagnosis) -> Vec<String> {
    let ((holdout, judged), horizon) = (held_out(diagnosis), horizon(diagnosis));
    let effects: Vec<String> = diagnosis
        .effects
        .iter()
        .map(FittedEffect::address)
        .collect();
    let effects = effects.join(" ");
    vec![
        format!(
            "Add it: handstand add {MODEL} {effects} --fit {LOGS}{holdout}{horizon} -o better.toml"
        ),
        format!(
            "See what it gains: handstand compare {MODEL} {judged} --model better.toml{horizon}"
        ),
    ]
}

/// One experiment for each effect that some of the first explanations have and others do not.
fn experiments(diagnosis: &Diagnosis) -> Vec<String> {
    let others = diagnosis.alternatives.iter().map(|rival| &rival.effects);
    let sets: Vec<_> = std::iter::once(&diagnosis.effects)
        .chain(others)
        .take(SHOWN)
        .collect();
    let mut kinds: Vec<&FittedEffect> = Vec::new();
    for effect in sets.iter().copied().flatten() {
        let common = sets.iter().all(|set| {
            set.iter()
                .any(|e| e.kind == effect.kind && e.joint == effect.joint)
        });
        if !common && !kinds.iter().any(|e| e.kind == effect.kind) {
            kinds.push(effect);
        }
    }
    kinds
        .into_iter()
        .filter_map(|effect| {
            let experiment = crate::effects::named(&effect.kind)?.info().experiment;
            Some(format!("To tell {} apart: {experiment}.", effect.title))
        })
        .collect()
}

#[cfg(test)]
pub(super) mod tests;
