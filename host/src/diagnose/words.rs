//! A diagnosis in sentences that a student understands.
//!
//! What to do next comes as command lines in which [`MODEL`], [`LOGS`] and [`HELD_OUT`] stand for
//! the files.

use super::findings::{Diagnosis, FittedEffect, Verdict};

use crate::output::number::{measured, percent, short, with_unit};

/// Stands in [`Diagnosis::next`] for the model file; who knows its name puts it there.
pub const MODEL: &str = "MODEL";
/// Stands for the logs that were learned from.
pub const LOGS: &str = "LOG...";
/// Stands for the logs that were held out.
pub const HELD_OUT: &str = "HELD_OUT...";

/// Explanations named in a sentence; the rest are counted.
pub(crate) const SHOWN: usize = 4;
/// Pairs of values warned of; the rest are counted.
const PAIRS: usize = 3;
/// Errors below so many floors are no proof that something is missing.
const NEAR: f64 = 2.0;

/// Adds summary, next steps and warnings.
pub(super) fn complete(diagnosis: &mut Diagnosis) {
    diagnosis.summary = summary(diagnosis);
    diagnosis.next = next(diagnosis);
    let warnings: Vec<String> = on_bound(diagnosis).chain(pairs(diagnosis)).collect();
    if !diagnosis.error.held_out {
        diagnosis.warnings.push(
            "no motion was held out: the figures are of the motions that were fitted".to_string(),
        );
    }
    diagnosis.warnings.extend(warnings);
}

/// The verdict as a sentence.
pub(crate) fn headline(diagnosis: &Diagnosis) -> String {
    let names = joined(&diagnosis.effects);
    let error = &diagnosis.error;
    match diagnosis.verdict {
        Verdict::Nominal if error.before_rad > NEAR * error.floor_rad => {
            "No known effect brings the model closer to the measurement.".into()
        }
        Verdict::Nominal => "The model already explains the measurement.".into(),
        Verdict::Named => format!("The model lacks {names}."),
        Verdict::Ambiguous => format!("Equally good explanations: {}.", rivals(diagnosis)),
        Verdict::Unexplained if diagnosis.effects.is_empty() => {
            "Something is missing, and no known effect explains it.".into()
        }
        Verdict::Unexplained => format!("The model lacks more than {names}."),
        Verdict::Unfit => "These data can't answer the question.".into(),
    }
}

/// "A at joint 1, or B and C, or 3 more".
fn rivals(diagnosis: &Diagnosis) -> String {
    let others = diagnosis.alternatives.iter().map(|rival| &rival.effects);
    let mut sets: Vec<String> = std::iter::once(&diagnosis.effects)
        .chain(others)
        .map(|set| joined(set))
        .collect();
    let more = sets.len().saturating_sub(SHOWN);
    sets.truncate(SHOWN);
    match more {
        0 => sets.join(", or "),
        more => format!("{}, and {more} more", sets.join(", or ")),
    }
}

fn summary(diagnosis: &Diagnosis) -> Vec<String> {
    let mut lines = vec![headline(diagnosis)];
    if diagnosis.verdict == Verdict::Nominal
        && diagnosis.error.before_rad > NEAR * diagnosis.error.floor_rad
    {
        lines.push("What is left is far above the noise: the model fails in a way the library does not know, or the \
                    motions to judge by differ from those learned from.".into());
    }
    if diagnosis.verdict == Verdict::Unexplained && !diagnosis.effects.is_empty() {
        lines.push(
            "It comes closest and is not the whole of it: do not take it for the cause.".into(),
        );
    }
    // The values of one of several explanations would be taken for an answer.
    let told = match diagnosis.verdict {
        Verdict::Ambiguous => &[],
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
    lines.push(error_line(diagnosis));
    lines
}

fn error_line(diagnosis: &Diagnosis) -> String {
    let error = &diagnosis.error;
    let motions = if error.held_out { "held-out" } else { "fitted" };
    let [before, after, floor] =
        [error.before_rad, error.after_rad, error.floor_rad].map(|rad| short(1e3 * rad));
    if diagnosis.effects.is_empty() {
        return format!(
            "The error on {motions} motions is {before} mrad; the floor is {floor} mrad."
        );
    }
    let with = match diagnosis.verdict {
        Verdict::Ambiguous => "With the first of them the",
        _ => "The",
    };
    format!(
        "{with} error on {motions} motions falls from {before} to {after} mrad; the floor is {floor} mrad."
    )
}

fn next(diagnosis: &Diagnosis) -> Vec<String> {
    match diagnosis.verdict {
        Verdict::Named => commands(diagnosis),
        Verdict::Ambiguous => experiments(diagnosis),
        Verdict::Unexplained => vec![
            format!("See where it fails: handstand compare {MODEL} {LOGS}"),
            "Record a motion that isolates those conditions, or write the missing effect as a file of its own."
                .to_string(),
        ],
        Verdict::Nominal => vec![
            "To look closer, record with finer resolution or with motions that reach further.".to_string(),
        ],
        Verdict::Unfit => vec!["Mend the logs as said, and try again.".to_string()],
    }
}

/// Each effect added to the model before, then the first and the last side by side.
fn commands(diagnosis: &Diagnosis) -> Vec<String> {
    let (holdout, judged) = match diagnosis.error.held_out {
        true => (format!(" --holdout {HELD_OUT}"), HELD_OUT),
        false => (String::new(), LOGS),
    };
    let mut from = MODEL.to_string();
    let mut lines = Vec::new();
    for (index, effect) in diagnosis.effects.iter().enumerate() {
        let to = match index {
            0 => "better.toml".to_string(),
            index => format!("better{}.toml", index + 1),
        };
        let address = effect.address();
        lines.push(format!(
            "Add it: handstand add {from} {address} --fit {LOGS}{holdout} -o {to}"
        ));
        from = to;
    }
    lines.push(format!(
        "See what it gains: handstand compare {MODEL} {judged} --model {from}"
    ));
    lines
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

fn on_bound(diagnosis: &Diagnosis) -> impl Iterator<Item = String> {
    let added = diagnosis
        .effects
        .iter()
        .flat_map(|effect| &effect.parameters);
    let values = diagnosis
        .base
        .iter()
        .chain(added)
        .filter(|value| value.on_bound);
    values.map(|value| {
        format!(
            "{} = {} lies on its bound: the data push it further than is physical, or it is not needed",
            value.path,
            with_unit(&short(value.value), &value.unit)
        )
    })
}

/// The pairs told apart worst, worst first.
fn pairs(diagnosis: &Diagnosis) -> Vec<String> {
    let mut pairs: Vec<_> = diagnosis.collinear.iter().collect();
    pairs.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
    let more = pairs.len().saturating_sub(PAIRS);
    let mut lines: Vec<String> = pairs
        .into_iter()
        .take(PAIRS)
        .map(|(a, b, r)| {
            let correlation = percent(r.abs());
            format!(
                "{a} and {b} are hardly told apart by these motions (correlation {correlation})"
            )
        })
        .collect();
    if more > 0 {
        lines.push(format!("and {more} more such pairs"));
    }
    lines
}

/// "Coulomb friction at joint 1".
pub(crate) fn effect_name(effect: &FittedEffect) -> String {
    at_joint(&effect.title, effect.joint)
}

pub(crate) fn at_joint(title: &str, joint: Option<usize>) -> String {
    match joint {
        Some(joint) => format!("{title} at joint {joint}"),
        None => title.to_string(),
    }
}

/// Effects in a row: "A at joint 1, B and C".
pub(crate) fn joined(effects: &[FittedEffect]) -> String {
    listed(effects.iter().map(effect_name).collect())
}

pub(crate) fn listed(mut names: Vec<String>) -> String {
    match (names.pop(), names.as_slice()) {
        (None, _) => "nothing".into(),
        (Some(last), []) => last,
        (Some(last), rest) => format!("{} and {last}", rest.join(", ")),
    }
}

#[cfg(test)]
mod tests;
