//! Free values that stand in for what is missing.

use super::tests::evaluator;

/// Without a speed limit viscous friction becomes eight times what the file says, and beside so
/// much of it no speed limit helps.
#[test]
fn an_effect_that_a_free_value_stands_in_for_is_found_from_the_file() {
    let evaluator = evaluator(3_300_005, &["encoder_zero", "pre_sliding", "speed_limit"]);
    assert!(evaluator.is_bent());
    let all = evaluator.changes.iter();
    let limit = all.filter(|changes| changes[0].candidate.effect.info().id == "speed_limit");
    let limit: Vec<_> = limit.cloned().collect();
    let mut looks = evaluator.first_look(&evaluator.base, &limit, 2);
    let from_refitted = looks[0].search_mean;
    assert!(from_refitted > 0.8 * evaluator.base.search_mean);
    evaluator.restart_bent(&mut looks);
    assert!(looks[0].search_mean < 0.3 * from_refitted);
}

/// Of an arm that lacks an offset alone refitting changes no friction by much.
#[test]
fn values_near_those_of_the_file_are_not_bent() {
    assert!(!evaluator(1, &["torque_offset"]).is_bent());
}
