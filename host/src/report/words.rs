//! Words that the page and the text share.

use crate::diagnose::names::{at_joint, listed, value_name};
use crate::diagnose::words::headline;
use crate::diagnose::{BudgetShare, BudgetedPart, Diagnosis, FREE_VALUES, RuledOut, Verdict};
use crate::effects::named;
use crate::fitting::ErrorReduction;
use crate::model::{MeasuredSignal, ParameterPath};
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

/// A share with the ends of its interval: "96 % (94 to 97 %)".
pub(super) fn with_ends(share: &BudgetShare) -> String {
    let [share, low, high] = [share.share, share.low, share.high].map(percent);
    format!("{share} ({} to {high})", low.trim_end_matches(" %"))
}

/// A set of `id@joint`, and of values by their addresses, in words.
pub(super) fn set_name(set: &[String]) -> String {
    let name = |id: &String| {
        if id.parse::<ParameterPath>().is_ok() {
            return format!("another value of {}", value_name(id));
        }
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

/// What the shares of a budget mean that no one expects: those below none and above all of the
/// error.
pub(super) fn odd_shares(budget: &[BudgetedPart]) -> Vec<&'static str> {
    let any = |is: &dyn Fn(f64) -> bool| {
        let shares = budget.iter();
        let mut shares = shares.flat_map(|part| [part.alone.share, part.beyond_others.share]);
        shares.any(is)
    };
    let frees = budget.iter().any(|part| part.part == FREE_VALUES);
    let said = [
        (
            frees,
            "Free values are those that the model file lets every fit change (`[fit] free`): alone, \
             they are refitted and nothing is added.",
        ),
        (
            any(&|share| share < 0.0),
            "A negative share: with this part alone the error is larger than that of the model as \
             given.",
        ),
        (
            any(&|share| share > 1.0),
            "More than 100 %: without this part the rest of the explanation does worse than the \
             model as given.",
        ),
    ];
    let said = said.into_iter().filter(|(is_said, _)| *is_said);
    said.map(|(_, sentence)| sentence).collect()
}

/// Tried sets that do as well as what was chosen, or those that do not; the smallest held-out error
/// first, then those that never came that far.
pub(super) fn sorted(ruled_out: &[RuledOut], as_good: bool) -> Vec<&RuledOut> {
    let rows = ruled_out.iter().filter(|tried| tried.as_good == as_good);
    let mut sorted: Vec<&RuledOut> = rows.collect();
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
