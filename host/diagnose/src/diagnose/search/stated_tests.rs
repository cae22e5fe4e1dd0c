//! Values as they are stated: on lower stairs, and of shorter steps, than they were searched with.

use super::tests::{evaluator, fitted};
use crate::fitting::stated;

/// What an arm that hides one effect leaves once it is evaluated, and once its values are stated:
/// length of the steps, s, and squared error in variances of a reading.
fn evaluated_and_stated(seed: u64, kind: &'static str, values: &[f64]) -> [(f64, f64); 2] {
    let evaluator = evaluator(seed, &[kind]);
    let mut set = fitted(&evaluator, &[kind], [values]);
    evaluator.evaluate(&mut set);
    let stated = stated(set.fit().clone(), &evaluator.training);
    [set.fit(), &stated].map(|fit| (fit.model.step_s, fit.residuals.cost()))
}

/// Some of what a breaking away tells is worth less than what explanations are told apart by.
#[test]
fn stated_values_lie_on_a_lower_stair() {
    let [evaluated, stated] = evaluated_and_stated(3, "stribeck", &[0.0394, 0.132]);
    assert_eq!(evaluated.0, stated.0);
    assert!(stated.1 < evaluated.1 - 2.0, "{stated:?} {evaluated:?}");
}

/// Torque that falls between two steps: less than a verdict hangs on, more than the values' errors.
#[test]
fn stated_values_are_those_of_shorter_steps() {
    let [evaluated, stated] = evaluated_and_stated(5, "fold_back", &[0.4195, 0.06056, 0.2389]);
    assert!(stated.0 < evaluated.0, "{stated:?} {evaluated:?}");
    assert!(stated.1 < evaluated.1, "{stated:?} {evaluated:?}");
}
