use super::*;
use crate::diagnose::{Alternative, SearchEnded};
use crate::fitting::{ErrorReduction, FittedValue};
use crate::model::MeasuredSignal;

fn value(path: &str, value: f64, on_bound: bool) -> FittedValue {
    FittedValue {
        path: path.to_owned(),
        key: path.rsplit('.').next().unwrap_or(path).to_owned(),
        unit: "N m".to_owned(),
        value,
        low: 0.9 * value,
        high: 1.1 * value,
        on_bound,
    }
}

pub(in crate::diagnose) fn effect(kind: &str, joint: Option<usize>) -> FittedEffect {
    FittedEffect {
        kind: kind.to_owned(),
        title: crate::effects::named(kind).unwrap().info().title.to_owned(),
        joint,
        parameters: vec![value(&format!("{kind}@1.torque_nm"), 0.05, false)],
    }
}

pub(in crate::diagnose) fn said(
    verdict: Verdict,
    effects: Vec<FittedEffect>,
    rivals: Vec<Vec<FittedEffect>>,
) -> Diagnosis {
    let alternatives = rivals.into_iter().map(|effects| Alternative {
        effects,
        wrong_values: Vec::new(),
        error_rad: 2e-3,
        same_law: false,
    });
    let mut diagnosis = Diagnosis {
        verdict,
        effects,
        wrong_values: Vec::new(),
        error: ErrorReduction {
            quantity: MeasuredSignal::Angle,
            before_rad: 40e-3,
            refitted_rad: Some(35e-3),
            after_rad: 2e-3,
            floor_rad: 1.5e-3,
            floor_interval_rad: None,
            held_out: true,
            reduction: Some([0.9, 0.96]),
        },
        budget: Vec::new(),
        alternatives: alternatives.collect(),
        base: Vec::new(),
        ruled_out: Vec::new(),
        residual_structure: None,
        motions: Vec::new(),
        folds: Vec::new(),
        collinear: Vec::new(),
        summary: Vec::new(),
        next: Vec::new(),
        warnings: Vec::new(),
        search_horizon_s: Some(1.0),
        horizon_s: None,
        shorter_step_s: None,
        windows: Vec::new(),
        search_ended: SearchEnded::Complete,
        left_out: Vec::new(),
        shows_alone: Vec::new(),
    };
    complete(&mut diagnosis);
    diagnosis
}

#[test]
fn a_named_effect_is_told_with_its_size_and_how_to_add_it() {
    let said = said(Verdict::Named, vec![effect("coulomb", Some(1))], vec![]);
    assert_eq!(
        said.summary,
        [
            "The model lacks Coulomb friction at joint 1.",
            "Coulomb friction at joint 1: torque_nm = 0.050 N m (0.045 to 0.055).",
            "The error on held-out motions falls from 40.0 to 2.00 mrad; the floor is 1.50 mrad.",
        ]
    );
    assert_eq!(
        said.next[0],
        "Add it: handstand add MODEL coulomb@1 --fit LOG... --holdout HELD_OUT... -o better.toml"
    );
}

#[test]
fn rivals_are_named_without_values_and_with_the_experiment_that_separates_them() {
    let first = vec![effect("coulomb", Some(1))];
    let second = vec![effect("dead_zone", Some(1))];
    let said = said(Verdict::Ambiguous, first, vec![second]);
    assert_eq!(
        said.summary[0],
        "Either Coulomb friction at joint 1 is missing, or dead zone of the drive at joint 1 is \
         missing."
    );
    assert_eq!(
        said.summary[1],
        "These logs cannot tell them apart; what parts them: with the torque off only friction \
         remains."
    );
    assert!(said.summary.iter().all(|line| !line.contains("torque_nm")));
    assert_eq!(said.next.len(), 2, "{:?}", said.next);
}

#[test]
fn what_is_common_to_all_rivals_needs_no_experiment() {
    let sure = || effect("air_drag", Some(1));
    let first = vec![sure(), effect("coulomb", Some(1))];
    let second = vec![sure(), effect("stribeck", Some(1))];
    let said = said(Verdict::Ambiguous, first, vec![second]);
    assert!(
        said.next.iter().all(|line| !line.contains("air drag")),
        "{:?}",
        said.next
    );
}

#[test]
fn a_partial_explanation_is_not_to_be_taken_for_the_cause() {
    let partial = said(
        Verdict::Unexplained,
        vec![effect("coulomb", Some(1))],
        vec![],
    );
    assert_eq!(
        partial.summary[0],
        "No known effect explains all of it; Coulomb friction at joint 1 comes closest and removes \
         99.7 % of the squared error that refitted values leave."
    );
    // Where no value is free the effect is all that changes.
    let mut alone = partial.clone();
    alone.error.refitted_rad = None;
    assert!(headline(&alone).ends_with("removes 99.8 % of the squared error."));
    assert!(partial.summary[1].contains("do not take it for the cause"));
    let nothing = said(Verdict::Unexplained, vec![], vec![]);
    assert_eq!(
        nothing.summary[0],
        "Something is missing, and no known effect explains it."
    );
}

pub(super) fn wrong(path: &str, given: f64, to: f64) -> WrongValue {
    WrongValue {
        given,
        free: path.starts_with("viscous"),
        within_uncertainty: false,
        fitted: value(path, to, false),
    }
}

#[test]
fn a_model_with_what_was_found_is_named_in_words() {
    let name = |effects: &[FittedEffect], wrong: &[WrongValue]| what_was_found(effects, wrong);
    let values = [
        wrong("link1.mass_kg", 0.2, 0.3),
        wrong("viscous@1.coefficient_nm_s_rad", 0.01, 0.06),
    ];
    let found = [effect("coulomb", Some(1))];
    assert_eq!(name(&[], &[]), None);
    let both = name(&found, &values).unwrap();
    assert_eq!(
        both,
        "Coulomb friction at joint 1, and other values of the mass of link 1 and viscous friction at \
         joint 1"
    );
    assert_eq!(
        name(&[], &values[..1]).unwrap(),
        "another value of the mass of link 1"
    );
    assert_eq!(name(&found, &[]).unwrap(), "Coulomb friction at joint 1");
}

#[test]
fn a_wrong_value_is_told_with_both_numbers_and_how_to_mend_it() {
    let mut said = said(Verdict::WrongValue, vec![], vec![]);
    said.wrong_values = vec![wrong("viscous@1.torque_nm", 0.01, 0.06)];
    said.horizon_s = Some(0.5);
    complete(&mut said);
    assert_eq!(
        said.summary,
        [
            "Your value of viscous@1.torque_nm is wrong: 0.0100 -> 0.060 N m (0.054 to 0.066).",
            "The error on held-out motions falls from 40.0 to 2.00 mrad; the floor is 1.50 mrad.",
        ]
    );
    assert_eq!(
        said.next,
        [
            "Mend it: handstand fit MODEL LOG... --free viscous@1.torque_nm --holdout HELD_OUT... --horizon 0.5 \
             -o better.toml",
            "See what it gains: handstand compare MODEL HELD_OUT... --model better.toml --horizon 0.5",
        ]
    );
}

#[test]
fn the_error_is_told_in_the_unit_that_is_asked_for() {
    let said = said(Verdict::Named, vec![effect("coulomb", Some(1))], vec![]);
    assert_eq!(
        error_line(&said, ("deg", 1f64.to_degrees())),
        "The error on held-out motions falls from 2.29 to 0.115 deg; the floor is 0.0859 deg."
    );
}

#[test]
fn several_wrong_values_are_told_together() {
    let mut said = said(Verdict::WrongValue, vec![], vec![]);
    said.wrong_values = vec![
        wrong("link1.mass_kg", 1.0, 2.0),
        wrong("coulomb@1.torque_nm", 3.0, 4.0),
    ];
    let told = headline(&said);
    let first = "Values of the model are wrong: the mass of link 1: 1.00 -> ";
    assert!(told.starts_with(first), "{told}");
    assert!(
        told.contains("; Coulomb friction at joint 1: 3.00 -> "),
        "{told}"
    );
    said.wrong_values.truncate(1);
    let told = headline(&said);
    assert!(
        told.starts_with("Your value of the mass of link 1 is wrong: 1.00 -> "),
        "{told}"
    );
}

#[test]
fn values_on_bounds_and_collinear_pairs_are_warned_of() {
    let mut effects = vec![effect("coulomb", Some(1))];
    effects[0].parameters[0].on_bound = true;
    let mut said = said(Verdict::Named, effects, vec![]);
    assert_eq!(said.warnings.len(), 1, "{:?}", said.warnings);
    assert!(said.warnings[0].contains("lies on its bound"));
    said.warnings.clear();
    for k in 0..5 {
        said.collinear
            .push((format!("a{k}"), format!("b{k}"), 0.96));
    }
    complete(&mut said);
    assert!(
        said.warnings.contains(&"and 2 more such pairs".to_owned()),
        "{:?}",
        said.warnings
    );
}

#[test]
fn values_known_only_together_are_warned_of() {
    let mut friction = effect("position_friction", Some(1));
    let parameter = |key: &str, low: f64, high: f64| FittedValue {
        low,
        high,
        ..value(&format!("position_friction@1.{key}"), 1.0, false)
    };
    friction.parameters = vec![
        parameter("below_nm", -5.0, 5.0),
        parameter("above_nm", -5.0, 0.1),
        parameter("span_rad", 0.05, 6.3),
    ];
    let together = said(Verdict::Named, vec![friction.clone()], vec![]);
    let expected = "position_friction@1.below_nm and position_friction@1.span_rad do not follow \
                    from these motions: they are known only together";
    assert_eq!(together.warnings, [expected]);
    friction.parameters.pop();
    let alone = said(Verdict::Named, vec![friction.clone()], vec![]);
    let expected = "position_friction@1.below_nm does not follow from these motions: it is known \
                    only together with others";
    assert_eq!(alone.warnings, [expected]);
    friction.parameters.remove(0);
    let known = said(Verdict::Named, vec![friction], vec![]);
    assert!(known.warnings.is_empty(), "{:?}", known.warnings);
}

#[test]
fn names_are_joined_as_in_a_sentence() {
    let names = |all: &[&str]| listed(all.iter().map(ToString::to_string).collect());
    assert_eq!(names(&[]), "nothing");
    assert_eq!(names(&["a"]), "a");
    assert_eq!(names(&["a", "b"]), "a and b");
    assert_eq!(names(&["a", "b", "c"]), "a, b and c");
    assert_eq!(effect("coulomb", Some(2)).address(), "coulomb@2");
    assert_eq!(effect("base_tilt", None).address(), "base_tilt");
}

#[test]
fn what_does_as_well_as_a_free_value_is_said() {
    let mut diagnosis = said(Verdict::WrongValue, vec![], vec![]);
    diagnosis.wrong_values = vec![wrong("link1.inertia_kg_m2", 0.001, 0.002)];
    diagnosis.alternatives = vec![Alternative {
        effects: vec![effect("armature", Some(1))],
        wrong_values: Vec::new(),
        error_rad: 2e-3,
        same_law: false,
    }];
    complete(&mut diagnosis);
    assert_eq!(
        diagnosis.summary[1],
        "These logs cannot tell this from armature inertia at joint 1; what parts them: swing link 1 off its \
         drive and time it."
    );
}

#[test]
fn an_open_verdict_says_each_explanation_as_a_clause() {
    let mut diagnosis = said(
        Verdict::Ambiguous,
        vec![],
        vec![vec![effect("armature", Some(1))]],
    );
    let mut headline = |wrong_values| {
        diagnosis.wrong_values = wrong_values;
        super::headline(&diagnosis)
    };
    let or = "what the file says, or armature inertia at joint 1 is missing.";
    let twice = wrong("link1.inertia_kg_m2", 0.001, 0.002);
    let damping = wrong("viscous@1.coefficient_nm_s_rad", 0.02, 0.017);
    assert_eq!(
        headline(vec![twice.clone()]),
        format!("Either the inertia of link 1 is twice {or}")
    );
    assert_eq!(
        headline(vec![twice.clone(), damping.clone()]),
        format!("Either the inertia of link 1 is twice {or}")
    );
    assert_eq!(
        headline(vec![damping]),
        format!("Either viscous friction at joint 1 is 0.850 times {or}")
    );
    let lighter = wrong("link1.mass_kg", 0.2, 0.17);
    assert_eq!(
        headline(vec![twice, lighter]),
        format!("Either the inertia of link 1 is twice and the mass of link 1 0.850 times {or}")
    );
    // No factor leads from nothing to something, nor across zero.
    assert_eq!(
        headline(vec![wrong("coulomb@1.torque_nm", 0.0, 0.03)]),
        format!("Either Coulomb friction at joint 1 is 0.0300 N m, not {or}")
    );
    assert_eq!(
        headline(vec![wrong("gear_backlash@1.gap_rad", 0.1, 0.05)]),
        format!("Either gap_rad of backlash of the gear at joint 1 is half {or}")
    );
}

#[test]
fn the_same_in_other_words_is_told_and_parted_by_nothing() {
    let mut diagnosis = said(Verdict::WrongValue, vec![], vec![]);
    diagnosis.wrong_values = vec![wrong("joint1.stall_torque_nm", 1.5, 1.2)];
    diagnosis.alternatives = vec![Alternative {
        effects: vec![effect("torque_scale", Some(1))],
        wrong_values: Vec::new(),
        error_rad: 2e-3,
        same_law: true,
    }];
    complete(&mut diagnosis);
    assert_eq!(
        diagnosis.summary[1],
        "In other words, which say the same of every experiment: torque scale at joint 1."
    );
    let cannot = diagnosis
        .summary
        .iter()
        .find(|line| line.contains("cannot tell"));
    assert_eq!(cannot, None);
}

/// An explanation that nothing rivals in a search that was ended is not called one of several.
#[test]
fn what_a_search_that_was_ended_has_found_is_told_as_that() {
    let mut ended = said(Verdict::Ambiguous, vec![effect("coulomb", Some(1))], vec![]);
    ended.left_out = vec!["sets of two effects".into()];
    complete(&mut ended);
    assert_eq!(
        ended.summary[0],
        "Explained by Coulomb friction at joint 1; what was not tried may explain it as well."
    );
    assert!(
        ended
            .summary
            .iter()
            .any(|line| line.starts_with("The error on held-out motions falls"))
    );
    assert_eq!(
        ended.next[0],
        "Search to the end: handstand diagnose MODEL LOG... --holdout HELD_OUT..."
    );
    let mut nothing = said(Verdict::Unexplained, vec![], vec![]);
    nothing.left_out = ended.left_out;
    complete(&mut nothing);
    assert_eq!(
        nothing.summary[0],
        "Something is missing, and what was tried so far does not explain it."
    );
}
