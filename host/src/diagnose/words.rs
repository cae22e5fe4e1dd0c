//! A diagnosis in sentences that a student understands.

use super::findings::{Diagnosis, FittedEffect, Verdict};
use super::verdict::effect_of;

/// Adds summary, next steps and warnings.
pub(super) fn complete(diagnosis: &mut Diagnosis) {
    diagnosis.summary = summary(diagnosis);
    diagnosis.next = next(diagnosis);
    let on_bound: Vec<String> = diagnosis
        .base
        .iter()
        .chain(diagnosis.effects.iter().flat_map(|e| &e.parameters))
        .filter(|v| v.on_bound)
        .map(|v| {
            format!(
                "{} = {:.4} {} lies on its bound: the data push it further than is physical, or it is not needed",
                v.path, v.value, v.unit
            )
        })
        .collect();
    diagnosis.warnings.extend(on_bound);
    if !diagnosis.error.held_out {
        diagnosis.warnings.push(
            "no motion was held out: the figures are of the motions that were fitted".to_string(),
        );
    }
    for (a, b, r) in &diagnosis.collinear {
        diagnosis.warnings.push(format!(
            "{a} and {b} are hardly told apart by these motions (correlation {r:.3})"
        ));
    }
}

fn summary(diagnosis: &Diagnosis) -> Vec<String> {
    let mut lines = Vec::new();
    let names = list(&diagnosis.effects);
    match diagnosis.verdict {
        Verdict::Nominal => lines.push(
            "Nothing is missing that these motions could show: no effect of the library lowers the error by more \
             than chance."
                .to_string(),
        ),
        Verdict::Named => lines.push(format!("Missing: {names}.")),
        Verdict::Ambiguous => {
            let others: Vec<String> = diagnosis.alternatives.iter().map(|a| list(&a.effects)).collect();
            lines.push(format!(
                "Something is missing, and these motions can't tell which: {names}, or {}.",
                others.join(", or ")
            ));
        }
        Verdict::Unexplained => {
            lines.push("Something is missing that no effect of the library explains.".to_string());
            if !diagnosis.effects.is_empty() {
                lines.push(format!(
                    "{names} comes closest and is not the whole of it: do not take it for the cause."
                ));
            }
        }
        Verdict::Unfit => lines.push("These logs can't answer the question.".to_string()),
    }
    for effect in &diagnosis.effects {
        for value in &effect.parameters {
            lines.push(format!(
                "{}: {} = {} {} (95 % interval {} to {}).",
                place(effect),
                value.key,
                number(value.value),
                value.unit,
                number(value.low),
                number(value.high)
            ));
        }
    }
    lines.push(error_line(diagnosis));
    if let Some(left) = &diagnosis.remainder {
        lines.push(format!(
            "Of what is left above the noise, a free-form term would still gain {:.0} % (at least {:.0} %): mostly {}.",
            100.0 * left.explainable_share.clamp(0.0, 1.0),
            100.0 * left.explainable_low.clamp(0.0, 1.0),
            left.shape
        ));
    }
    lines
}

fn error_line(diagnosis: &Diagnosis) -> String {
    let error = &diagnosis.error;
    let motions = if error.held_out { "held-out" } else { "fitted" };
    if diagnosis.effects.is_empty() {
        return format!(
            "The error on {motions} motions is {:.2} mrad; noise and resolution alone leave {:.2} mrad.",
            1e3 * error.before,
            1e3 * error.floor
        );
    }
    format!(
        "The error on {motions} motions falls from {:.2} to {:.2} mrad (by {:.0} %, 95 % interval {:.0} to {:.0} %); \
         noise and resolution alone leave {:.2} mrad.",
        1e3 * error.before,
        1e3 * error.after,
        100.0 * (1.0 - error.after / error.before),
        100.0 * error.fall_low,
        100.0 * error.fall_high,
        1e3 * error.floor
    )
}

fn next(diagnosis: &Diagnosis) -> Vec<String> {
    let experiment = |kind: &str| effect_of(kind).map(|e| e.card().experiment);
    match diagnosis.verdict {
        Verdict::Named => {
            let mut lines: Vec<String> = diagnosis
                .effects
                .iter()
                .map(|e| format!("Add it: handstand add MODEL {} --fit LOG... -o NEW.toml", address(e)))
                .collect();
            lines.push("Then compare the new model on motions that took no part.".to_string());
            lines
        }
        Verdict::Ambiguous => {
            let mut kinds: Vec<&str> = Vec::new();
            let all = diagnosis.alternatives.iter().flat_map(|a| &a.effects).chain(&diagnosis.effects);
            for effect in all {
                let common = diagnosis.effects.iter().any(|e| e == effect)
                    && diagnosis.alternatives.iter().all(|a| a.effects.iter().any(|e| e.kind == effect.kind));
                if !common && !kinds.contains(&effect.kind.as_str()) {
                    kinds.push(&effect.kind);
                }
            }
            kinds
                .iter()
                .filter_map(|kind| Some(format!("To tell {kind} apart: {}.", experiment(kind)?)))
                .collect()
        }
        Verdict::Unexplained => vec![
            "See where it fails: handstand compare MODEL LOG...".to_string(),
            "Record a motion that isolates those conditions, or write the missing effect as a file of its own."
                .to_string(),
        ],
        Verdict::Nominal => vec![
            "To look closer, record with finer resolution or with motions that reach further.".to_string(),
        ],
        Verdict::Unfit => vec!["Mend the logs as said, and try again.".to_string()],
    }
}

fn place(effect: &FittedEffect) -> String {
    match effect.joint {
        Some(joint) => format!("{} at joint {joint}", effect.title),
        None => effect.title.clone(),
    }
}

fn address(effect: &FittedEffect) -> String {
    match effect.joint {
        Some(joint) => format!("{}@{joint}", effect.kind),
        None => effect.kind.clone(),
    }
}

fn list(effects: &[FittedEffect]) -> String {
    effects.iter().map(place).collect::<Vec<_>>().join(" with ")
}

/// Four significant digits.
fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let digits = (3 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
    format!("{value:.digits$}")
}
