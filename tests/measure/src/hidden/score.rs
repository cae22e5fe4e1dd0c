//! What a verdict is worth, and which of its intervals hold the truth.

use super::case::{Case, HiddenEffect};
use super::family::Family;
use super::outcome::{Answer, Value};
use super::said::Said;
use std::f64::consts::{PI, TAU};

/// What the answer is worth.
pub(super) fn answer(case: &Case, hidden: &[String], said: &Said) -> Answer {
    let sorted = |set: &[String]| {
        let mut set = set.to_vec();
        set.sort();
        set
    };
    let truth = sorted(hidden);
    let best = said.sets.first().map(|set| sorted(set)).unwrap_or_default();
    let nothing = match said.verdict.as_str() {
        "nominal" | "adequate" => true,
        // Wrong are only the values of friction that the owner guesses.
        "wrong_value" => best.is_empty(),
        _ => false,
    };
    match said.verdict.as_str() {
        "unfit" => Answer::Unfit,
        _ if nothing && case.family.hides_nothing() => Answer::Right,
        _ if nothing => Answer::Nominal,
        "unexplained" if case.family == Family::Outside => Answer::Right,
        "unexplained" => Answer::Unexplained,
        _ if case.family == Family::Outside => Answer::Wrong,
        "ambiguous" if said.sets.iter().any(|set| sorted(set) == truth) => Answer::Equivalent,
        "named" | "wrong_value" if best == truth => Answer::Right,
        _ => Answer::Wrong,
    }
}

/// The values of hidden effects beside what was said of them.
pub(super) fn values(hidden: &[HiddenEffect], said: &Said) -> Vec<Value> {
    let mut values = Vec::new();
    for effect in hidden {
        let address = effect.address();
        let fitted = said.effects.iter().find(|said| said.address() == address);
        for (key, truth) in &effect.parameters {
            let Some(truth) = truth.as_f64() else {
                continue;
            };
            let fitted = fitted.and_then(|fitted| fitted.parameters.get(key));
            values.push(Value {
                path: format!("{address}.{key}"),
                true_value: truth,
                estimate: fitted.map(|fitted| fitted.value),
                interval: fitted.map(|fitted| (fitted.low, fitted.high)),
                covered: fitted.is_some_and(|fitted| {
                    covers(key, fitted.value, (fitted.low, fitted.high), truth)
                }),
            });
        }
    }
    values
}

/// Whether the interval holds the truth; a phase is known but for whole turns.
fn covers(key: &str, value: f64, (low, high): (f64, f64), truth: f64) -> bool {
    let truth = if key.contains("phase") {
        value + (truth - value + PI).rem_euclid(TAU) - PI
    } else {
        truth
    };
    (low..=high).contains(&truth)
}

#[cfg(test)]
mod tests {
    use super::super::case::Truth;
    use super::*;

    fn case(family: Family, hidden: &[&'static str]) -> Case {
        Case {
            truth: Truth::Own,
            family,
            hidden: hidden.to_vec(),
            seed: 1,
            skipped: Vec::new(),
        }
    }

    fn heard(verdict: &str, sets: &[&[&str]]) -> Said {
        let own = |set: &&[&str]| set.iter().map(|name| name.to_string()).collect();
        Said {
            verdict: verdict.to_string(),
            sets: sets.iter().map(own).collect(),
            ..Said::default()
        }
    }

    #[test]
    fn a_phase_is_covered_but_for_whole_turns() {
        assert!(covers("phase_rad", 3.1, (2.9, 3.3), -3.1));
        assert!(!covers("phase_rad", 3.1, (2.9, 3.3), -2.8));
        assert!(!covers("angle_rad", 3.1, (2.9, 3.3), -3.1));
    }

    #[test]
    fn only_the_hidden_set_is_right() {
        let pair = case(Family::Pairs, &["delay", "mass"]);
        let hidden = ["delay@1".to_string(), "mass@1".to_string()];
        let worth = |said: &Said| answer(&pair, &hidden, said);
        assert_eq!(
            worth(&heard("named", &[&["mass@1", "delay@1"]])),
            Answer::Right
        );
        assert_eq!(worth(&heard("named", &[&["delay@1"]])), Answer::Wrong);
        assert_eq!(
            worth(&heard("named", &[&["delay@2", "mass@1"]])),
            Answer::Wrong
        );
        let with = heard("ambiguous", &[&["delay@1"], &["delay@1", "mass@1"]]);
        assert_eq!(worth(&with), Answer::Equivalent);
        let lacks = heard("ambiguous", &[&["delay@1"], &["mass@1"]]);
        assert_eq!(worth(&lacks), Answer::Wrong);
        assert_eq!(
            worth(&heard("unexplained", &[&["delay@1", "mass@1"]])),
            Answer::Unexplained
        );
        assert_eq!(worth(&heard("nominal", &[])), Answer::Nominal);
        assert_eq!(worth(&heard("wrong_value", &[&[]])), Answer::Nominal);
        assert_eq!(worth(&heard("unfit", &[])), Answer::Unfit);
    }

    #[test]
    fn nothing_and_what_the_library_lacks_have_answers_of_their_own() {
        let nothing = case(Family::Nothing, &[]);
        assert_eq!(answer(&nothing, &[], &heard("nominal", &[])), Answer::Right);
        assert_eq!(
            answer(&nothing, &[], &heard("named", &[&["mass@1"]])),
            Answer::Wrong
        );
        let guessed = heard("wrong_value", &[&[]]);
        assert_eq!(answer(&nothing, &[], &guessed), Answer::Right);
        let heavy = heard("wrong_value", &[&["mass@1"]]);
        assert_eq!(answer(&nothing, &[], &heavy), Answer::Wrong);
        let none = heard("unexplained", &[&[]]);
        assert_eq!(answer(&nothing, &[], &none), Answer::Unexplained);
        let outside = case(Family::Outside, &["mass"]);
        let hidden = ["mass@1".to_string()];
        assert_eq!(
            answer(&outside, &hidden, &heard("unexplained", &[])),
            Answer::Right
        );
        let sets: &[&[&str]] = &[&["mass@1"], &["delay@1"]];
        assert_eq!(
            answer(&outside, &hidden, &heard("ambiguous", sets)),
            Answer::Wrong
        );
        assert_eq!(
            answer(&outside, &hidden, &heard("nominal", &[])),
            Answer::Nominal
        );
    }
}
