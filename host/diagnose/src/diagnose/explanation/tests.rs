use super::*;
use crate::diagnose::SearchEnded;
use crate::diagnose::search::tests::{candidate, evaluator, fitted};

/// What was found beside the effect that is missing.
#[derive(Default)]
struct Beside {
    hypotheses: Vec<Hypothesis>,
    equivalents: Vec<Hypothesis>,
    placebos: Vec<Hypothesis>,
}

/// The verdict on an arm that lacks viscous friction, with what is `found` beside it: that is told
/// an effect that does as well as the friction, and one that gains nothing.
fn verdict(found: impl FnOnce(Hypothesis, Hypothesis) -> Beside) -> Verdict {
    verdict_beside("air_drag", found)
}

/// The same with another effect beside the friction.
fn verdict_beside(kind: &str, found: impl FnOnce(Hypothesis, Hypothesis) -> Beside) -> Verdict {
    let evaluator = evaluator(1, &["viscous"]);
    let mut friction = fitted(&evaluator, &["viscous"], [&[0.02]]);
    evaluator.evaluate(&mut friction);
    let other = vec![candidate(&evaluator, kind)];
    let twin = Hypothesis {
        set: other.clone(),
        ..friction.clone()
    };
    let idle = Hypothesis {
        set: other,
        ..evaluator.base.clone()
    };
    let Beside {
        mut hypotheses,
        equivalents,
        placebos,
    } = found(twin, idle);
    hypotheses.push(friction.clone());
    let tried = SearchOutcome {
        hypotheses,
        best: Some(friction),
        ..SearchOutcome::default()
    };
    let explanation = tried.explanation(&evaluator);
    verdict_of(&evaluator, &tried, explanation, &equivalents, placebos)
}

fn verdict_of(
    evaluator: &Evaluator,
    tried: &SearchOutcome,
    explanation: Explanation,
    equivalents: &[Hypothesis],
    placebos: Vec<Hypothesis>,
) -> Verdict {
    let evidence = VerdictEvidence {
        evaluator,
        tried,
        explanation,
        equivalents: equivalents.to_vec(),
        placebos,
        residual_structure: None,
        per_motion_reduction: None,
        folds: Vec::new(),
        seed: 0,
        ended: SearchEnded::Complete,
        left_out: Vec::new(),
        shows_alone: Vec::new(),
    };
    evidence.verdict(&evidence.rivals())
}

#[test]
fn an_effect_that_does_as_well_leaves_the_verdict_open() {
    let beside = |hypotheses| Beside {
        hypotheses,
        ..Beside::default()
    };
    assert_eq!(verdict(|twin, _| beside(vec![twin])), Verdict::Ambiguous);
    assert_eq!(verdict(|_, idle| beside(vec![idle])), Verdict::Named);
}

/// Simplest first: what needs another value to do as well is no rival.
#[test]
fn an_effect_of_more_values_that_does_as_well_leaves_it_named() {
    let beside = |twin, _| Beside {
        hypotheses: vec![twin],
        ..Beside::default()
    };
    assert_eq!(verdict_beside("stribeck", beside), Verdict::Named);
}

#[test]
fn an_effect_of_the_same_predictions_leaves_the_verdict_open() {
    let beside = |equivalents| Beside {
        equivalents,
        ..Beside::default()
    };
    assert_eq!(verdict(|twin, _| beside(vec![twin])), Verdict::Ambiguous);
    assert_eq!(verdict(|_, _| beside(Vec::new())), Verdict::Named);
}

#[test]
fn nothing_is_named_where_a_placebo_gains_as_much() {
    let beside = |placebos| Beside {
        placebos,
        ..Beside::default()
    };
    assert_eq!(verdict(|twin, _| beside(vec![twin])), Verdict::Unexplained);
    assert_eq!(verdict(|_, idle| beside(vec![idle])), Verdict::Named);
}

/// A value that the file frees is what its owner does not know: where it explains all, an effect of
/// the same predictions is only mentioned. Beside a value that was taken for known it is a rival.
#[test]
fn a_value_that_the_file_frees_stays_the_answer() {
    let mut evaluator = evaluator(1, &["viscous"]);
    let mut found = fitted(&evaluator, &["viscous"], [&[0.02]]);
    evaluator.evaluate(&mut found);
    let twin = [found.clone()];
    let value = Hypothesis {
        set: Vec::new(),
        values: evaluator.base.search.free.clone(),
        ..found
    };
    let tried = SearchOutcome::default();
    let verdict = |evaluator: &Evaluator| {
        let explanation = Explanation::Value(&value);
        verdict_of(evaluator, &tried, explanation, &twin, Vec::new())
    };
    assert_eq!(verdict(&evaluator), Verdict::WrongValue);
    evaluator.base.search.free.clear();
    assert_eq!(verdict(&evaluator), Verdict::Ambiguous);
}

/// A link that would have to weigh many times what its owner says leaves open nothing that needs
/// less, and one that might weigh a little more does.
#[test]
fn a_value_that_no_one_would_believe_is_no_rival() {
    let evaluator = evaluator(1, &["viscous"]);
    let mut friction = fitted(&evaluator, &["viscous"], [&[0.02]]);
    evaluator.evaluate(&mut friction);
    let mass = "link1.mass_kg".parse().unwrap();
    let given_kg = evaluator.start.links[0].mass_kg;
    let weighing = |factor: f64| {
        let mut value = Hypothesis {
            set: Vec::new(),
            values: vec![mass],
            ..friction.clone()
        };
        assert!(mass.set(&mut value.search.model, factor * given_kg));
        value
    };
    let tried = SearchOutcome::default();
    let beside = |chosen: &Hypothesis, factor: f64| {
        let explanation = Explanation::ValueAndRefit(chosen);
        verdict_of(
            &evaluator,
            &tried,
            explanation,
            &[weighing(factor)],
            Vec::new(),
        )
    };
    let speed = Hypothesis {
        values: vec!["joint1.no_load_speed_rad_s".parse().unwrap()],
        ..weighing(1.0)
    };
    assert_eq!(beside(&speed, 1.2), Verdict::Ambiguous);
    assert_eq!(beside(&speed, 180.0), Verdict::WrongValue);
    // Where the explanation asks for as much, the rival may.
    let chosen = Hypothesis {
        values: vec![mass, "joint1.no_load_speed_rad_s".parse().unwrap()],
        ..weighing(180.0)
    };
    assert_eq!(beside(&chosen, 180.0), Verdict::Ambiguous);
}

/// Some other friction helps an arm that lacks viscous friction, by far not as much as that does.
#[test]
fn a_value_that_is_clearly_worse_is_not_the_explanation() {
    let evaluator = evaluator(1, &["viscous"]);
    let mut friction = fitted(&evaluator, &["viscous"], [&[0.02]]);
    evaluator.evaluate(&mut friction);
    let (given, base) = (&evaluator.given, &evaluator.base);
    let values = evaluator.try_values(None);
    assert!(evaluator.accepted(given, &values).is_some());
    let refitted = evaluator.try_values_refitted(None);
    assert!(evaluator.accepted(base, &refitted).is_some());
    let among = |values, values_refitted, best| {
        let tried = SearchOutcome {
            values,
            values_refitted,
            best,
            ..SearchOutcome::default()
        };
        let explanation = tried.explanation(&evaluator);
        explanation.hypothesis().names()
    };
    let best = Some(friction);
    assert_eq!(among(values, Vec::new(), best.clone()), ["viscous@1"]);
    assert_eq!(among(Vec::new(), refitted.clone(), best), ["viscous@1"]);
    assert_ne!(among(Vec::new(), refitted, None), [""; 0]);
}
