//! Words that the page and the text share.

use crate::diagnose::names::{at_joint, listed};
use crate::diagnose::words::headline;
use crate::diagnose::{BudgetShare, Diagnosis, RuledOut, Verdict};
use crate::effects::named;
use crate::fitting::ErrorReduction;
use crate::model::MeasuredSignal;
use crate::output::number::{mrad, percent};

/// One word for a verdict, as in JSON.
pub(super) fn verdict_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Nominal => "nominal",
        Verdict::Adequate => "adequate",
        Verdict::WrongValue => "wrong_value",
        Verdict::Named => "named",
        Verdict::Ambiguous => "ambiguous",
        Verdict::Unexplained => "unexplained",
        Verdict::Unfit => "unfit",
    }
}

/// A share with the ends of its interval: "96 % (94 % to 97 %)".
pub(super) fn with_ends(share: &BudgetShare) -> String {
    let [share, low, high] = [share.share, share.low, share.high].map(percent);
    format!("{share} ({low} to {high})")
}

/// A set of `id@joint` by its effects' titles.
pub(super) fn set_name(set: &[String]) -> String {
    let name = |id: &String| {
        let (kind, joint) = match id.split_once('@') {
            Some((kind, joint)) => (kind, joint.parse().ok()),
            None => (id.as_str(), None),
        };
        match named(kind) {
            Some(effect) => at_joint(kind, effect.info().title, joint),
            None => id.clone(),
        }
    };
    listed(set.iter().map(name).collect())
}

/// Tried sets, the smallest held-out error first; then those that never came that far.
pub(super) fn sorted(ruled_out: &[RuledOut]) -> Vec<&RuledOut> {
    let mut sorted: Vec<&RuledOut> = ruled_out.iter().collect();
    let key = |tried: &RuledOut| tried.held_out_error_rad.unwrap_or(f64::INFINITY);
    sorted.sort_by(|a, b| {
        let held_out = key(a).total_cmp(&key(b));
        held_out.then(a.training_error_rad.total_cmp(&b.training_error_rad))
    });
    sorted
}

/// On which motions the error was taken.
pub(super) fn measured_on(error: &ErrorReduction) -> &'static str {
    if error.held_out {
        "motions that took no part in the fit"
    } else {
        "the motions of the fit, as none were held out"
    }
}

/// " (1.42 to 1.55)", where the floor is an estimate.
pub(super) fn floor_interval(error: &ErrorReduction) -> String {
    error
        .floor_interval_rad
        .map_or(String::new(), |[low, high]| {
            format!(" ({} to {})", mrad(low), mrad(high))
        })
}

/// "the error falls by 85 % (95 % interval 80 to 89 %)"; nothing if there is no error to reduce.
pub(super) fn reduction(error: &ErrorReduction) -> Option<String> {
    let reduction = 1.0 - error.after_rad / error.before_rad;
    let verb = if reduction < 0.0 { "rises" } else { "falls" };
    let range = error
        .reduction
        .filter(|ends| ends.iter().all(|end| end.is_finite()));
    let range = range.map_or(String::new(), |ends| {
        let [low, high] = ends.map(percent);
        format!(" (95 % interval of the reduction: {low} to {high})")
    });
    let size = percent(reduction.abs());
    reduction
        .is_finite()
        .then(|| format!("the error {verb} by {size}{range}"))
}

/// "Before, mrad", or in thousandths of what else the quantity is measured in.
pub(super) fn in_columns<const N: usize>(
    headings: [&str; N],
    quantity: MeasuredSignal,
) -> [String; N] {
    headings.map(|heading| format!("{heading}, {}", quantity.milli()))
}

/// "41.2 mrad", or in thousandths of what else the quantity is measured in.
pub(super) fn in_milli(value: f64, quantity: MeasuredSignal) -> String {
    format!("{} {}", mrad(value), quantity.milli())
}

/// What the summary says beside the headline, which the writers set apart.
pub(super) fn sentences(diagnosis: &Diagnosis) -> impl Iterator<Item = &String> {
    let headline = headline(diagnosis);
    diagnosis
        .summary
        .iter()
        .filter(move |line| **line != headline)
}
