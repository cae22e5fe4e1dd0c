//! A sample of `cargo xtask next`: what a proposed experiment settles on a true arm.

use handstand::diagnose::Verdict;
use handstand_measure::experiment::{ExperimentCase, try_experiment};

/// The case tried: what was proposed, and that the first diagnosis was open and the last is not.
fn settled(kind: &'static str, seed: u64) -> String {
    let outcome = try_experiment(ExperimentCase { kind, seed }).unwrap();
    assert_eq!(outcome.first_verdict, Verdict::Ambiguous, "{outcome:#?}");
    let settled = outcome
        .settled
        .clone()
        .expect("what is hidden is among the sets");
    assert!(settled.settled, "{outcome:#?}");
    settled.proposed
}

#[test]
fn a_turned_centre_of_mass_is_named_after_one_experiment() {
    let proposed = settled("com_angle", 1);
    assert!(proposed.contains("add"), "{proposed}");
}

#[test]
fn a_rotor_is_named_after_one_measurement() {
    assert_eq!(settled("armature", 2), "measure link1.inertia_kg_m2");
}
