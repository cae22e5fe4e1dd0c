//! Words that the page and the text share.

use super::number::{given, interval, mrad, percent};
use crate::diagnose::{Diagnosis, ErrorFall, FittedEffect, FittedValue, RuledOut, Verdict};
use crate::effects::named;

/// One word for a verdict, as in JSON.
pub(super) fn verdict_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Nominal => "nominal",
        Verdict::Named => "named",
        Verdict::Ambiguous => "ambiguous",
        Verdict::Unexplained => "unexplained",
        Verdict::Unfit => "unfit",
    }
}

/// A verdict as a sentence without a full stop.
pub(super) fn verdict_sentence(diagnosis: &Diagnosis) -> String {
    let effects = joined(&diagnosis.effects);
    match diagnosis.verdict {
        Verdict::Nominal => "The model already explains the measurement".into(),
        Verdict::Named => format!("The model lacks {effects}"),
        Verdict::Ambiguous => format!("Equally good explanations: {}", rivals(diagnosis)),
        Verdict::Unexplained if diagnosis.effects.is_empty() => {
            "Something is missing, and no known effect explains it".into()
        }
        Verdict::Unexplained => format!("The model lacks more than {effects}"),
        Verdict::Unfit => "These data can't answer the question".into(),
    }
}

/// "A at joint 1, or B and C".
fn rivals(diagnosis: &Diagnosis) -> String {
    let others = diagnosis.alternatives.iter().map(|rival| &rival.effects);
    let sets: Vec<String> = std::iter::once(&diagnosis.effects)
        .chain(others)
        .map(|set| joined(set))
        .collect();
    sets.join(", or ")
}

/// "Coulomb friction at joint 1".
pub(super) fn effect_name(effect: &FittedEffect) -> String {
    at_joint(&effect.title, effect.joint)
}

fn at_joint(title: &str, joint: Option<usize>) -> String {
    match joint {
        Some(joint) => format!("{title} at joint {joint}"),
        None => title.to_string(),
    }
}

/// Effects in a row: "A at joint 1, B and C".
pub(super) fn joined(effects: &[FittedEffect]) -> String {
    listed(effects.iter().map(effect_name).collect())
}

fn listed(mut names: Vec<String>) -> String {
    match (names.pop(), names.as_slice()) {
        (None, _) => "nothing".into(),
        (Some(last), []) => last,
        (Some(last), rest) => format!("{} and {last}", rest.join(", ")),
    }
}

/// A set of `id@joint` by its effects' titles.
pub(super) fn set_name(set: &[String]) -> String {
    let name = |id: &String| {
        let (kind, joint) = match id.split_once('@') {
            Some((kind, joint)) => (kind, joint.parse().ok()),
            None => (id.as_str(), None),
        };
        match named(kind) {
            Some(effect) => at_joint(effect.card().title, joint),
            None => id.clone(),
        }
    };
    listed(set.iter().map(name).collect())
}

/// Tried sets, the smallest held-out error first; then those that never came that far.
pub(super) fn sorted(ruled_out: &[RuledOut]) -> Vec<&RuledOut> {
    let mut sorted: Vec<&RuledOut> = ruled_out.iter().collect();
    let key = |tried: &RuledOut| tried.held_out_error.unwrap_or(f64::INFINITY);
    sorted.sort_by(|a, b| {
        let held_out = key(a).total_cmp(&key(b));
        held_out.then(a.training_error.total_cmp(&b.training_error))
    });
    sorted
}

/// On which motions the error was taken.
pub(super) fn measured_on(error: &ErrorFall) -> &'static str {
    if error.held_out {
        "motions that took no part in the fit"
    } else {
        "the motions of the fit, as none were held out"
    }
}

/// "the error falls by 85 % (95 % interval 80 to 89 %)"; nothing if there is no error to fall.
pub(super) fn fall(error: &ErrorFall) -> Option<String> {
    let fall = 1.0 - error.after / error.before;
    let verb = if fall < 0.0 { "rises" } else { "falls" };
    let range = match (error.fall_low.is_finite(), error.fall_high.is_finite()) {
        (true, true) => format!(
            " (95 % interval of the fall: {} to {})",
            percent(error.fall_low),
            percent(error.fall_high)
        ),
        _ => String::new(),
    };
    fall.is_finite()
        .then(|| format!("the error {verb} by {}{range}", percent(fall.abs())))
}

/// "41.2 mrad".
pub(super) fn in_mrad(value_rad: f64) -> String {
    format!("{} mrad", mrad(value_rad))
}

/// "0.0821 N m (0.0794 to 0.0851)".
pub(super) fn with_interval(fitted: &FittedValue) -> String {
    let [value, low, high] = interval(fitted.value, fitted.low, fitted.high);
    let unit = unit(&fitted.unit);
    let space = if unit.is_empty() { "" } else { " " };
    format!("{value}{space}{unit} ({low} to {high})")
}

/// A unit as written behind a number: nothing for a pure number.
pub(super) fn unit(unit: &str) -> &str {
    if unit == "1" { "" } else { unit }
}

/// What limits the judgement in time, as a clause.
pub(super) fn window(horizon_s: Option<f64>) -> String {
    match horizon_s {
        Some(horizon_s) => format!("in windows of {} s", given(horizon_s)),
        None => "over whole motions".into(),
    }
}
