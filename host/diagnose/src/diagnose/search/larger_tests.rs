//! Where larger sets are looked for.

use super::tests::{candidate, evaluator, fitted};
use super::*;
use crate::diagnose::budget::PARTNERS;

/// An arm that lacks an offset of its torque and cogging: without the offset it moves so
/// differently that cogging changes another motion.
#[test]
fn a_partner_is_sought_by_what_it_changes_beside_the_set() {
    let mut evaluator = evaluator(12, &["cogging", "torque_offset"]);
    let offset = candidate(&evaluator, "torque_offset");
    let finish = FitOptions::iterations(FINISH);
    let alone = (evaluator.base).with(offset, &[-0.04], &evaluator.search, finish);
    let leaves_rad = |sets: &[Hypothesis]| {
        let with = sets.iter().filter(|set| set.names()[1] == "cogging@1");
        with.map(Hypothesis::deciding_rms_rad)
            .fold(f64::INFINITY, f64::min)
    };
    let grown = evaluator.grow(std::slice::from_ref(&alone));
    assert!(leaves_rad(&grown) > 0.005);
    // Every other effect, not those alone that promise most.
    assert!(evaluator.tries_all);
    let mut found = SearchResults {
        sizes: vec![vec![alone], Vec::new()],
        ..SearchResults::default()
    };
    evaluator.grow_further(&mut found);
    let pairs = &found.sizes[1];
    let beside = pairs.iter().filter(|pair| pair.set[0] == offset).count();
    assert!(beside > 30, "{beside}");
    assert!(leaves_rad(pairs) < 0.002);
    // Pairs alone.
    found.sizes.push(Vec::new());
    evaluator.grow_further(&mut found);
    assert_eq!(found.sizes[2].len(), 0);
}

/// Load-dependent friction, an angle and stiction: in the prediction without the first two, which
/// is another motion, two dozen effects promise more than stiction does.
#[test]
fn a_partner_is_chosen_by_what_it_changes_with_the_set() {
    let evaluator = evaluator(3_400_001, &["com_angle", "load_friction", "stribeck"]);
    let pair = fitted(
        &evaluator,
        &["load_friction", "com_angle"],
        [&[0.2], &[0.1]],
    );
    let partners = evaluator.partners(&pair, &[]);
    assert_eq!(partners[0].candidate, candidate(&evaluator, "stribeck"));
    assert_eq!(partners.len(), PARTNERS);
}
