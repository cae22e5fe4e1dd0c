use super::*;
use crate::challenge::weakened_arm;
use crate::diagnose::search::tests::{evaluator, evaluator_of, fitted};
use crate::diagnose::verdict::{UNEXPLAINED_LOW, UNEXPLAINED_SHARE};
use crate::fitting::Candidate;

/// An arm that lacks little viscous friction: nearly all of what the model leaves without it can be
/// explained, and with it nothing is left to explain.
#[test]
fn a_missing_law_leaves_structure_and_the_right_one_none() {
    let evaluator = evaluator_of(&weakened_arm(1, &["viscous"], 0.1));
    let structure = evaluator.residual_structure(&evaluator.base).unwrap();
    assert!(
        structure.explainable_share > 2.0 * UNEXPLAINED_SHARE,
        "{structure:?}"
    );
    assert!(structure.explainable_low > UNEXPLAINED_LOW, "{structure:?}");
    assert!(structure.shape.contains("speed"), "{structure:?}");
    let mut friction = fitted(&evaluator, &["viscous"], [&[0.002]]);
    evaluator.evaluate(&mut friction);
    assert_eq!(evaluator.residual_structure(&friction), None);
}

/// What a model leaves of motions whose readings run backwards is large, and is not what it leaves
/// of those it was fitted to.
#[test]
fn what_returns_in_no_other_motion_is_no_structure() {
    let evaluator = evaluator(1, &["viscous"]);
    let fit = evaluator.base.fit();
    let mut unseen = evaluator.training.clone();
    for motion in &mut unseen.motions {
        motion.position_rad[0].reverse();
    }
    let structure = residual_structure(fit, &evaluator.training, &unseen, 0);
    let low = structure.map_or(0.0, |structure| structure.explainable_low);
    assert!(low < UNEXPLAINED_LOW, "{low}");
}

fn term(variable: ProbeVariable) -> Term {
    Term {
        variable,
        candidate: Candidate {
            effect: variable.probe(),
            joint: Some(0),
        },
        values: [1.0, variable.index(), 0.0, 1.0],
    }
}

#[test]
fn probes_that_one_side_hardly_shows_are_left_out() {
    use ProbeVariable::{Angle, Speed};
    let terms = [Speed, Speed, Speed, Angle, Angle].map(term);
    let column = |size: f64| DVector::from_element(4, size);
    // The second is weak beside the first of its kind, the third is not; one of the angle is
    // three times as strong on motions held out, one acts on nothing.
    let seen = [1.0, 0.09, 0.11, 1.0, 1e-10].map(column);
    let unseen = [1.0, 0.09, 0.11, 3.1, 1e-10].map(column);
    let kept = comparable(&terms, &seen, &unseen);
    assert_eq!(kept, [true, false, true, false, false]);
    let unseen = [2.9, 0.09, 0.11, 2.9, 1e-10].map(column);
    assert!(comparable(&terms, &seen, &unseen)[3]);
}

/// A probe that explains all of a large residual gets all of it, one of a residual that is noise
/// next to nothing.
#[test]
fn probes_share_what_lies_above_the_noise() {
    let shape = DVector::from_fn(400, |k, _| (k as f64 / 20.0).sin());
    let weight = |residual: DVector<f64>| {
        let linearised = Linearised {
            residual,
            probes: vec![shape.clone()],
            parameters: Vec::new(),
        };
        regress(&linearised)[0]
    };
    assert!((weight(10.0 * &shape) - 10.0).abs() < 0.2);
    let noise = DVector::from_fn(400, |k, _| if k % 2 == 0 { 1.0 } else { -1.0 });
    let weak = weight(0.1 * &shape + noise);
    assert!((0.02..0.08).contains(&weak), "{weak}");
}
