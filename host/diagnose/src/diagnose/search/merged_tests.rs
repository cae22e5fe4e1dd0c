use super::tests::evaluator_of;
use super::*;
use crate::challenge::{Motions, bench};
use crate::fitting::Candidate;

/// A robot with a delay at each of its drives is tried with one of all of them, fitted as well as
/// by itself.
#[test]
fn what_every_joint_has_is_tried_as_one_effect_of_all() {
    let evaluator = evaluator_of(&bench(Motions::Hanging, 1, &["delay"]).unwrap());
    let at = |joint: Option<usize>| {
        let mut known = evaluator.candidates.iter();
        let is_it = |it: &&Candidate| it.effect.info().id == "delay" && it.joint == joint;
        *known.find(is_it).unwrap()
    };
    let (search, finish) = (&evaluator.search, FitOptions::iterations(FINISH));
    let delayed = |from: &Hypothesis, joint| from.with(at(joint), &[0.01], search, finish);
    let one = delayed(&evaluator.base, Some(1));
    assert!(evaluator.merged(&one).is_empty());

    let mut both = delayed(&one, Some(2));
    evaluator.evaluate(&mut both);
    let mut found = SearchResults {
        sizes: vec![vec![one], vec![both]],
        ..SearchResults::default()
    };
    evaluator.prune(&mut found);
    let tried = found.sizes[0]
        .iter()
        .find(|set| set.names() == ["delay@all"]);
    let by_itself = delayed(&evaluator.base, None);
    assert!(tried.unwrap().search_mean < 1.01 * by_itself.search_mean);
}
