use super::*;
use crate::diagnose::findings::Verdict;
use crate::diagnose::words::tests::{effect, said};

fn with_motions(motions: &[(&str, bool, f64)]) -> Diagnosis {
    let mut diagnosis = said(Verdict::Unexplained, Vec::new(), Vec::new());
    diagnosis.error.floor_rad = 1e-3;
    let motion = |(name, held_out, after_rad): &(&str, bool, f64)| MotionError {
        motion: name.to_string(),
        held_out: *held_out,
        before_rad: *after_rad,
        after_rad: *after_rad,
    };
    diagnosis.motions = motions.iter().map(motion).collect();
    diagnosis
}

#[test]
fn a_motion_that_alone_shows_what_is_missing_is_named() {
    let fitted = with_motions(&[("a", false, 1e-3), ("b", false, 9e-3), ("c", true, 1.4e-3)]);
    let said = headline(&fitted).unwrap();
    assert!(said.contains("only fitted motions show (b)"), "{said}");
    assert!(
        next(&fitted)
            .unwrap()
            .starts_with("Hold out a motion like b")
    );
    let held_out = with_motions(&[("a", false, 1e-3), ("c", true, 1.6e-3), ("d", true, 2e-3)]);
    let said = headline(&held_out).unwrap();
    assert!(
        said.contains("only motions held out show (c and d)"),
        "{said}"
    );
    assert!(
        next(&held_out)
            .unwrap()
            .starts_with("Learn from a motion like c and d")
    );
}

#[test]
fn nothing_is_said_where_both_sides_show_it_or_none() {
    for motions in [
        [("a", false, 9e-3), ("c", true, 9e-3)],
        [("a", false, 1e-3), ("c", true, 1e-3)],
    ] {
        assert_eq!(headline(&with_motions(&motions)), None);
    }
    let mut nothing_held_out = with_motions(&[("a", false, 1e-3), ("b", false, 9e-3)]);
    nothing_held_out.error.held_out = false;
    assert_eq!(headline(&nothing_held_out), None);
}

#[test]
fn what_the_motions_held_out_do_not_show_is_not_proved() {
    let found = |before_rad: f64, after_rad: f64| {
        let effects = vec![effect("coulomb", Some(1))];
        let mut diagnosis = said(Verdict::Named, effects, Vec::new());
        diagnosis.motions = with_motions(&[("a", false, 9e-3), ("c", true, 1e-3)]).motions;
        (diagnosis.error.before_rad, diagnosis.error.after_rad) = (before_rad, after_rad);
        diagnosis
    };
    let warned = unproved(&found(1.5e-3, 1.49e-3)).unwrap();
    assert!(
        warned.contains("only fitted motions show this (a)"),
        "{warned}"
    );
    assert_eq!(unproved(&found(1.7e-3, 1.5e-3)), None);
}

#[test]
fn what_shows_in_one_motion_alone_is_said_with_its_values_or_its_rivals() {
    let limit = || vec![effect("torque_saturation", Some(1))];
    let alone = |rivals| {
        let mut diagnosis = said(Verdict::Ambiguous, limit(), rivals);
        diagnosis.shows_alone = vec!["c.csv".into()];
        crate::diagnose::words::complete(&mut diagnosis);
        diagnosis
    };
    let one = alone(Vec::new());
    assert_eq!(
        one.summary[0],
        "Shows in c.csv alone: torque saturation at joint 1 (torque_nm = 0.0500 N m); record \
         another motion like it to prove it."
    );
    assert!(one.next[0].contains("--holdout NEW.csv"), "{:?}", one.next);
    let several = alone(vec![vec![effect("coulomb", Some(1))]]);
    let said = &several.summary[0];
    assert!(
        said.starts_with("Shows in c.csv alone: either torque saturation"),
        "{said}"
    );
    assert!(
        said.contains(", or Coulomb friction at joint 1 is missing; record"),
        "{said}"
    );
}
