//! Words that the page and the text share.

use crate::diagnose::names::{at_joint, listed, value_name};
use crate::diagnose::words::headline;
use crate::diagnose::{BudgetShare, BudgetedPart, Diagnosis, FREE_VALUES, RuledOut};
use crate::effects::named;
use crate::fitting::ErrorReduction;
use crate::model::{MeasuredSignal, ParameterPath};
use crate::output::number::{mrad, percent};

/// A share with the ends of its interval: "96 % (94 to 97)"; without them where they show no
/// difference.
pub(super) fn with_ends(share: &BudgetShare) -> String {
    let [share, low, high] = [share.share, share.low, share.high].map(percent);
    if low == share && high == share {
        return share;
    }
    let [low, high] = [&low, &high].map(|end| end.trim_end_matches(" %"));
    format!("{share} ({low} to {high})")
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

/// A share that a table shows.
const SEEN: f64 = 5e-4;

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
            any(&|share| share < -SEEN),
            "A negative share: with this part alone the error is larger than that of the model as \
             given.",
        ),
        (
            any(&|share| share > 1.0 + SEEN),
            "More than 100 %: without this part the rest of the explanation does worse than the \
             model as given.",
        ),
    ];
    let said = said.into_iter().filter(|(is_said, _)| *is_said);
    said.map(|(_, sentence)| sentence).collect()
}

/// Tried sets that do as well as what was chosen, or those that do not.
pub(super) fn sorted(diagnosis: &Diagnosis, as_good: bool) -> Vec<&RuledOut> {
    let tried = diagnosis.tried().into_iter();
    tried.filter(|tried| tried.as_good == as_good).collect()
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
    let size = percent(reduction.abs());
    let range = range.map(|ends| ends.map(percent));
    let range = range.filter(|ends| ends.iter().any(|end| *end != size));
    let range = range.map_or(String::new(), |[low, high]| {
        format!(" (95 % interval of the reduction: {low} to {high})")
    });
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

#[cfg(test)]
mod tests {
    use super::*;

    fn share(share: f64, low: f64, high: f64) -> BudgetShare {
        BudgetShare {
            error_rad: 1e-3,
            share,
            low,
            high,
        }
    }

    #[test]
    fn a_value_of_an_effect_is_no_effect_at_every_joint() {
        let name =
            |set: &[&str]| set_name(&set.iter().map(ToString::to_string).collect::<Vec<_>>());
        assert_eq!(
            name(&["coulomb@1.torque_nm"]),
            "another value of Coulomb friction at joint 1"
        );
        assert_eq!(
            name(&["link1.mass_kg", "coulomb@1"]),
            "another value of the mass of link 1 and Coulomb friction at joint 1"
        );
        assert_eq!(
            name(&["coulomb@all"]),
            "Coulomb friction at all driven joints"
        );
    }

    #[test]
    fn a_share_has_its_ends_where_they_differ() {
        assert_eq!(with_ends(&share(0.25, 0.16, 0.38)), "25 % (16 to 38)");
        assert_eq!(with_ends(&share(0.99999, 0.99998, 0.999999)), "> 99.99 %");
    }

    #[test]
    fn shares_that_no_one_expects_are_explained() {
        let part = |part: &str, alone: f64, beyond: f64| BudgetedPart {
            part: part.to_owned(),
            alone: share(alone, alone, alone),
            beyond_others: share(beyond, beyond, beyond),
        };
        assert!(odd_shares(&[part("coulomb@1", 0.9, 0.5)]).is_empty());
        let odd = |budget: &[BudgetedPart]| odd_shares(budget).join(" ");
        assert!(odd(&[part(FREE_VALUES, 0.9, 0.5)]).contains("[fit] free"));
        assert!(odd(&[part("coulomb@1", -0.59, 0.5)]).starts_with("A negative share"));
        assert!(odd(&[part("coulomb@1", 0.9, 1.07)]).starts_with("More than 100 %"));
        // What a table shows as 0.0 %, or as 100 %, needs no word.
        assert!(odd_shares(&[part("coulomb@1", 1.0001, -0.0001)]).is_empty());
    }
}
