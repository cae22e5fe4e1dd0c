//! The examples of `host/examples`, as a user of the library runs them.

use handstand::diagnose::Verdict;

#[path = "../../examples/closed_loop.rs"]
#[allow(dead_code)] // its `main` is run by people
mod closed_loop;
#[path = "../../examples/compare.rs"]
#[allow(dead_code)] // its `main` is run by people
mod compare;
#[path = "../../examples/diagnose.rs"]
#[allow(dead_code)] // its `main` is run by people
mod diagnose;
#[path = "../../examples/gains.rs"]
#[allow(dead_code)] // its `main` is run by people
mod gains;

#[test]
fn the_comparison_shows_an_error_above_the_resolution() {
    let compared = compare::backlash_missing().unwrap();
    let error = &compared.signals[0];
    // A step of the encoder is 5.1 mrad, 1.5 mrad rms.
    assert!(error.rms > 2e-3, "{error:?}");
    assert!(!compared.failures.is_empty(), "{compared:?}");
}

#[test]
fn the_diagnosis_names_viscous_friction() {
    let diagnosis = diagnose::viscous_friction_missing().unwrap();
    assert_eq!(diagnosis.verdict, Verdict::Named, "{diagnosis:?}");
    assert_eq!(diagnosis.effects[0].kind, "viscous");
}

#[test]
fn the_gains_place_every_pole_within_the_unit_circle() {
    let design = gains::regulator().unwrap();
    let slowest = design.gains.poles[0].norm();
    assert!(slowest < 1.0, "{slowest}");
    assert!(design.fixed.is_some());
}

#[test]
fn the_loop_is_held_from_near_and_lost_from_afar() {
    let near = closed_loop::held_from(0.5).unwrap();
    assert!(near.stabilised, "{near:?}");
    let far = closed_loop::held_from(20.0).unwrap();
    assert!(far.fell_s.is_some(), "{far:?}");
}
