//! A law given as text is the law.

use super::*;
use crate::effects::{AtRest, FrictionState, Signals};

fn definition(torque: &str) -> LawDefinition {
    let parameter = |key: &str| LawParameter {
        key: key.into(),
        unit: "N m".into(),
        meaning: String::new(),
        starts: vec![0.5],
        bounds: (0.0, 10.0),
    };
    LawDefinition {
        name: "users_law".into(),
        site: LawSite::Torque,
        expression: torque.into(),
        parameters: vec![parameter("c"), parameter("exponent")],
        slides: true,
    }
}

fn at(angle_rad: f64, speed_rad_s: f64) -> JointState {
    JointState {
        drive_nm: 0.25,
        ..JointState::undriven(angle_rad, speed_rad_s)
    }
}

#[test]
fn laws_are_evaluated_as_in_mathematics() {
    let (c, exponent, q, w, tau) = (2.0, 3.0, 0.7_f64, -1.5_f64, 0.25);
    for (law, wanted) in [
        ("-c * w * abs(w)", -c * w * w.abs()),
        ("-w^2", -(w * w)),
        ("c - w - q", c - w - q),
        ("c / 2 / w", c / 2.0 / w),
        ("c - w * q + tau / c", c - w * q + tau / c),
        ("2^exponent^2", 2f64.powf(exponent).powf(2.0)),
        ("2 * c^2 * w", 2.0 * c * c * w),
        ("-(-c + (w - (q)))", -(-c + (w - q))),
        (
            "-c * signum(w) * abs(w)^exponent",
            -c * w.signum() * w.abs().powf(exponent),
        ),
        (
            "c * sin(2 * PI * q) + 1e-2",
            c * (std::f64::consts::TAU * q).sin() + 0.01,
        ),
        ("tau * (-c + exp(-abs(w)))", tau * (-c + (-w.abs()).exp())),
    ] {
        let effect = effect(&definition(law)).unwrap();
        let found = effect.torque(&[c, exponent], &at(q, w));
        assert!(
            (found - wanted).abs() < 1e-12,
            "{law}: {found} and not {wanted}"
        );
    }
}

#[test]
fn equal_definitions_are_one_effect_and_the_last_of_a_name_counts() {
    let first = effect(&definition("c * q")).unwrap();
    let second = effect(&definition("c * w")).unwrap();
    assert!(!std::ptr::addr_eq(&raw const *first, &raw const *second));
    assert!(std::ptr::addr_eq(
        &raw const *first,
        &raw const *effect(&definition("c * q")).unwrap()
    ));
}

#[test]
fn a_value_at_which_the_law_vanishes_is_known() {
    let parameters = effect(&definition("-c * abs(w)^exponent"))
        .unwrap()
        .info()
        .parameters;
    assert_eq!((parameters[0].off, parameters[1].off), (Some(0.0), None));
}

#[test]
fn smooth_laws_are_linearised_and_others_are_not() {
    let rest = AtRest {
        angle_rad: 0.5,
        duty: 0.0,
        torque_nm: 0.0,
        full_torque_nm: 1.0,
    };
    let slope = |law: &str| effect(&definition(law)).unwrap().slope(&[2.0, 0.0], &rest);
    let found = slope("-c * q^2 - 0.1 * w").unwrap();
    assert!((found.per_rad + 2.0).abs() < 1e-4, "{found:?}");
    assert!((found.per_rad_s + 0.1).abs() < 1e-6, "{found:?}");
    assert_eq!(slope("-c * signum(w)"), None);
    assert_eq!(slope("-c * tau"), None);
}

#[test]
fn frictions_see_their_direction_and_laws_what_is_commanded() {
    let friction = LawDefinition {
        site: LawSite::Friction,
        ..definition("c + exponent * dir * abs(w) + input * supply + time")
    };
    let law = effect(&friction).unwrap();
    let signals = Signals {
        input: 0.5,
        supply_ratio: 0.8,
        time_s: 3.0,
    };
    let at = FrictionState {
        angle_rad: 0.1,
        speed_rad_s: 0.2,
        direction: -1.0,
        gear_load_nm: 0.0,
        motor_nm: 0.0,
        outside_nm: 0.0,
        bearing_load_n: 0.0,
        signals,
    };
    let found = law.friction(&[2.0, 0.5], &at);
    assert!((found - (2.0 - 0.1 + 0.4 + 3.0)).abs() < 1e-12, "{found}");
    assert_eq!(law.info().site, Site::Friction);
    assert_eq!(
        law.torque(&[2.0, 0.5], &JointState::undriven(0.1, 0.2)),
        0.0
    );
    let rest = JointState::undriven(0.1, 0.0);
    let rest = JointState { signals, ..rest };
    let law = effect(&definition("dir + c * time")).unwrap();
    assert_eq!(law.torque(&[2.0, 0.5], &rest), 6.0);
}

#[test]
fn names_and_bounds_are_judged() {
    let fault = |change: &dyn Fn(&mut LawDefinition)| {
        let mut wrong = definition("c * w");
        change(&mut wrong);
        effect(&wrong).unwrap_err()
    };
    let taken =
        |name: &str| Problem::new(format!("the name `{name}` is taken"), "choose another name");
    assert_eq!(
        fault(&|d| d.name = "coulomb".into()),
        DefinitionFault::Name(taken("coulomb"))
    );
    let found = fault(&|d| d.parameters[1].key = "w".into());
    assert_eq!(found, DefinitionFault::Parameter(1, taken("w")));
    let DefinitionFault::Parameter(0, found) = fault(&|d| d.parameters[0].bounds = (1.0, 0.0))
    else {
        panic!("not the first parameter's");
    };
    assert_eq!(
        found.what,
        "the bounds are not in order, or a start lies outside them"
    );
    let found = fault(&|d| d.expression = "c * ".into());
    assert!(
        matches!(found, DefinitionFault::Expression(Misplaced { at: 4, .. })),
        "{found:?}"
    );
}
