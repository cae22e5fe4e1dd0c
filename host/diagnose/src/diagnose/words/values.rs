//! Values of the file that are wrong, or told better, in words.

use super::super::findings::WrongValue;
use super::super::names::value_name;
use crate::output::number::{measured, short, with_unit};

/// "Your value of the mass of link 1 is wrong: 0.2 -> 0.246 kg (0.244 to 0.248)."
pub(super) fn wrong_values(wrong: &[WrongValue]) -> String {
    let one = |w: &WrongValue| format!("{}: {}", value_name(&w.fitted.path), change(w));
    let all = |wrong: &[&WrongValue]| {
        let all: Vec<String> = wrong.iter().map(|w| one(w)).collect();
        all.join("; ")
    };
    let beyond: Vec<&WrongValue> = wrong.iter().filter(|w| !w.within_uncertainty).collect();
    match beyond.as_slice() {
        [] => format!(
            "Nothing is missing, and no value is off by more than its uncertainty; these motions \
             tell better: {}.",
            all(&wrong.iter().collect::<Vec<_>>())
        ),
        [one] => format!(
            "Your value of {} is wrong: {}.",
            value_name(&one.fitted.path),
            change(one)
        ),
        several => format!("Values of the model are wrong: {}.", all(several)),
    }
}

/// "0.2 -> 0.246 kg (0.244 to 0.248)".
pub fn change(wrong: &WrongValue) -> String {
    let fitted = &wrong.fitted;
    let to = measured(fitted.value, fitted.low, fitted.high, &fitted.unit);
    format!("{} -> {to}", short(wrong.given))
}

/// "twice", "0.85 times"; of a value that is 0 in the file, or changes its sign, what it is
/// instead: "0.02 kg, not".
pub(super) fn size(wrong: &WrongValue) -> String {
    let (ratio, fitted) = (wrong.fitted.value / wrong.given, &wrong.fitted);
    match ratio {
        ratio if !(ratio > 0.0 && ratio.is_finite()) => {
            format!("{}, not", with_unit(&short(fitted.value), &fitted.unit))
        }
        ratio if (1.95..2.05).contains(&ratio) => "twice".to_string(),
        ratio if (0.49..0.51).contains(&ratio) => "half".to_string(),
        ratio => format!("{} times", short(ratio)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::complete;
    use super::super::tests::{said, wrong};
    use super::*;
    use crate::diagnose::Verdict;

    #[test]
    fn values_within_their_uncertainty_are_not_called_wrong() {
        let within = |path: &str| WrongValue {
            within_uncertainty: true,
            ..wrong(path, 0.2, 0.21)
        };
        let of = |wrong: Vec<WrongValue>| {
            let mut diagnosis = said(Verdict::WrongValue, vec![], vec![]);
            diagnosis.wrong_values = wrong;
            diagnosis.next.clear();
            complete(&mut diagnosis);
            (diagnosis.summary[0].clone(), diagnosis.next[0].clone())
        };
        let (said_of_all, next) = of(vec![within("link1.mass_kg"), within("link1.com_m")]);
        assert!(said_of_all.starts_with("Nothing is missing, and no value is off by more"));
        assert!(
            said_of_all.contains("the mass of link 1: 0.200 -> "),
            "{said_of_all}"
        );
        assert!(!next.contains("--free"), "{next}");
        let mut unexplained = said(Verdict::Unexplained, vec![], vec![]);
        unexplained.wrong_values = vec![within("link1.mass_kg")];
        complete(&mut unexplained);
        let headline = &unexplained.summary[0];
        assert!(
            headline.starts_with("Something is missing: other values"),
            "{headline}"
        );
        let (said_of_both, next) = of(vec![
            within("link1.mass_kg"),
            wrong("link1.com_m", 0.1, 0.2),
        ]);
        assert!(
            said_of_both
                .starts_with("Your value of the centre-of-mass distance of link 1 is wrong")
        );
        assert!(
            !said_of_both.contains("the mass of link 1"),
            "{said_of_both}"
        );
        assert!(next.contains("--free link1.com_m"), "{next}");
    }
}
