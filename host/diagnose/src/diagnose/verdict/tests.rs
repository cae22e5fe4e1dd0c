use super::*;

/// Effects that explain all but noise.
const FOUND: Signs = Signs {
    kind: Kind::Effects,
    before: 400.0,
    left: 1.3,
    worst_motion: 1.3,
    at_noise_floor: true,
    held_out: true,
    tolerated: false,
    free_form_share: 0.0,
    free_form_low: 0.0,
    per_motion_reduction: 0.0,
    worst_fold: 1.0,
    worst_fold_floors: 1.0,
    spans_bounds: false,
    placebo_ranks: false,
    rivals: false,
    is_examined: true,
    is_provable: true,
};
/// The same with something left above the noise.
const ABOVE: Signs = Signs {
    left: 1.8,
    at_noise_floor: false,
    ..FOUND
};
const GIVEN: Signs = Signs {
    kind: Kind::Given,
    before: 1.1,
    left: 1.1,
    worst_motion: 1.1,
    ..FOUND
};

#[test]
fn what_explains_all_is_named_by_its_kind() {
    assert_eq!(FOUND.verdict(), Verdict::Named);
    assert_eq!(ABOVE.verdict(), Verdict::Named);
    let values = Signs {
        kind: Kind::Values,
        ..FOUND
    };
    assert_eq!(values.verdict(), Verdict::WrongValue);
    assert_eq!(GIVEN.verdict(), Verdict::Nominal);
}

#[test]
fn with_rivals_nothing_is_named() {
    for kind in [Kind::Values, Kind::Effects] {
        let signs = Signs {
            kind,
            rivals: true,
            ..FOUND
        };
        assert_eq!(signs.verdict(), Verdict::Ambiguous);
    }
}

#[test]
fn what_makes_other_held_out_motions_worse_is_not_named() {
    let raised = |worst_fold, signs| {
        Signs {
            worst_fold,
            ..signs
        }
        .verdict()
    };
    assert_eq!(raised(1.4, ABOVE), Verdict::Named);
    assert_eq!(raised(1.6, ABOVE), Verdict::Unexplained);
    assert_eq!(raised(1.6, FOUND), Verdict::Named);
}

/// What is true leaves hardly more than the noise whichever motions are held out.
#[test]
fn what_leaves_much_of_other_held_out_motions_is_not_named() {
    let left = |worst_fold_floors, signs| {
        Signs {
            worst_fold_floors,
            ..signs
        }
        .verdict()
    };
    assert_eq!(left(1.9, ABOVE), Verdict::Named);
    assert_eq!(left(2.1, ABOVE), Verdict::Unexplained);
    assert_eq!(left(2.1, FOUND), Verdict::Named);
}

#[test]
fn what_a_placebo_gains_too_proves_nothing() {
    let signs = Signs {
        placebo_ranks: true,
        ..FOUND
    };
    assert_eq!(signs.verdict(), Verdict::Unexplained);
}

#[test]
fn a_model_as_given_is_nominal_only_near_the_floor() {
    let left = |left: f64| Signs {
        left,
        worst_motion: left,
        at_noise_floor: false,
        ..GIVEN
    };
    assert_eq!(left(1.49 * 1.49).verdict(), Verdict::Nominal);
    assert_eq!(left(1.51 * 1.51).verdict(), Verdict::Unexplained);
    let fitted = Signs {
        held_out: false,
        ..left(4.0)
    };
    assert_eq!(fitted.verdict(), Verdict::Unexplained);
}

/// What the motions held out do not show, one that was fitted does.
#[test]
fn a_model_is_not_nominal_where_any_motion_shows_more() {
    let worst = |rms: f64| Signs {
        worst_motion: rms * rms,
        ..GIVEN
    };
    assert_eq!(worst(1.49).verdict(), Verdict::Nominal);
    assert_eq!(worst(1.51).verdict(), Verdict::Unexplained);
}

#[test]
fn a_tolerance_makes_a_model_adequate_but_not_nominal() {
    let above = Signs {
        left: 9.0,
        at_noise_floor: false,
        tolerated: true,
        ..GIVEN
    };
    assert_eq!(above.verdict(), Verdict::Adequate);
    assert_eq!(
        Signs {
            tolerated: true,
            ..GIVEN
        }
        .verdict(),
        Verdict::Nominal
    );
}

#[test]
fn structure_in_what_is_left_must_be_sure_and_large() {
    let structured = |share: f64, low: f64| Signs {
        free_form_share: share,
        free_form_low: low,
        ..ABOVE
    };
    assert_eq!(structured(0.4, 0.21).verdict(), Verdict::Unexplained);
    assert_eq!(structured(0.3, 0.21).verdict(), Verdict::Named);
    assert_eq!(structured(0.4, 0.19).verdict(), Verdict::Named);
}

#[test]
fn an_eighth_of_the_squared_error_may_be_left() {
    let left = |left: f64| Signs {
        before: 17.0,
        left,
        ..ABOVE
    };
    assert_eq!(left(2.9).verdict(), Verdict::Named);
    assert_eq!(left(3.1).verdict(), Verdict::Unexplained);
    // Near the noise a larger share may.
    assert_eq!(
        Signs {
            before: 4.0,
            ..left(1.9)
        }
        .verdict(),
        Verdict::Named
    );
    assert_eq!(
        Signs {
            before: 4.0,
            ..left(2.1)
        }
        .verdict(),
        Verdict::Unexplained
    );
}

#[test]
fn what_leaves_twice_the_noise_is_not_the_whole_however_much_it_removes() {
    let left = |rms: f64| Signs {
        before: 1e6,
        left: rms * rms,
        ..ABOVE
    };
    assert_eq!(left(1.9).verdict(), Verdict::Named);
    assert_eq!(left(2.1).verdict(), Verdict::Unexplained);
    // Motions that were fitted prove less.
    let fitted = |rms| Signs {
        held_out: false,
        ..left(rms)
    };
    assert_eq!(fitted(4.9).verdict(), Verdict::Named);
    assert_eq!(fitted(5.1).verdict(), Verdict::Unexplained);
}

#[test]
fn a_law_has_the_same_values_in_all_motions() {
    let varying = Signs {
        per_motion_reduction: 0.51,
        ..ABOVE
    };
    assert_eq!(varying.verdict(), Verdict::Unexplained);
    assert_eq!(
        Signs {
            per_motion_reduction: 0.49,
            ..ABOVE
        }
        .verdict(),
        Verdict::Named
    );
    // Motions that were fitted show too little of it.
    assert_eq!(
        Signs {
            held_out: false,
            ..varying
        }
        .verdict(),
        Verdict::Named
    );
}

/// What was not examined may contradict: nothing is named alone, and nothing nominal, but what
/// leaves only noise.
#[test]
fn what_was_not_examined_is_not_claimed() {
    let unexamined = |signs: Signs| Signs {
        is_examined: false,
        ..signs
    };
    assert_eq!(unexamined(FOUND).verdict(), Verdict::Ambiguous);
    let values = Signs {
        kind: Kind::Values,
        ..FOUND
    };
    assert_eq!(unexamined(values).verdict(), Verdict::Ambiguous);
    let given = Signs {
        kind: Kind::Given,
        ..ABOVE
    };
    assert_eq!(given.verdict(), Verdict::Nominal);
    assert_eq!(unexamined(given).verdict(), Verdict::Unexplained);
    let noise = Signs {
        kind: Kind::Given,
        ..FOUND
    };
    assert_eq!(unexamined(noise).verdict(), Verdict::Nominal);
}

/// A flexible effect that takes on what another leaves has a value that may be anything.
#[test]
fn an_effect_with_a_value_that_may_be_anything_is_named_only_where_nothing_is_left() {
    let spans = |signs| Signs {
        spans_bounds: true,
        ..signs
    };
    assert_eq!(spans(ABOVE).verdict(), Verdict::Unexplained);
    assert_eq!(spans(FOUND).verdict(), Verdict::Named);
    let fitted = Signs {
        held_out: false,
        ..spans(ABOVE)
    };
    assert_eq!(fitted.verdict(), Verdict::Named);
}
