//! What every controller is worth under every condition.

use super::super::*;
use crate::effects::named;
use crate::model::EffectInstance;
use crate::model::Model;
use crate::synth::controllers::{
    DEFAULT, DESIGNS, DesignModel, MASS_ERROR, MultiModel, WEIGHT, design,
};
use crate::synth::{
    CostWeights, Design, Format, Readings, Request, Time, Weight, dlqr, upright, zoh,
};
use nalgebra::DMatrix;
use std::path::Path;

fn model() -> Model {
    let text = include_str!("../../../models/handstand.toml");
    Model::parse(text, Path::new("handstand.toml")).unwrap()
}

/// Judges a controller on 100 robots that start within 2 deg.
fn judged(id: &str, under: &str) -> Figures {
    let judging = Judging {
        runs: 100,
        start_rad: 2f64.to_radians(),
        seconds: 5.0,
        seed: 7,
    };
    let mut case = Case::ideal(model(), design(id).unwrap(), 0.01);
    let uncertain = condition(under).unwrap().apply(&mut case);
    judge(&case, &uncertain, &judging, &|| ()).unwrap()
}

#[test]
fn under_everything_at_once_the_paper_s_regulator_fails_and_the_best_holds() {
    let best = judged("best", "all");
    assert!(best.stabilised_share >= 0.94, "{best:?}");
    for paper in ["dlqr", "dlqr-compensated"] {
        let paper = judged(paper, "all");
        assert!(paper.stabilised_share < 0.05, "{paper:?}");
    }
}

#[test]
fn the_paper_s_findings_hold() {
    // Figure 13: the sampled regulator holds, with 10-bit angles too.
    assert!(judged("dlqr", "ideal").stabilised_share >= 0.95);
    assert!(judged("dlqr", "positions").stabilised_share >= 0.95);
    // Figure 12: eccentric masses need the compensation.
    let (plain, known) = (
        judged("dlqr", "eccentric"),
        judged("dlqr-compensated", "eccentric"),
    );
    assert!(
        plain.stabilised_share < 0.7 && known.stabilised_share >= 0.95,
        "{plain:?} {known:?}"
    );
    // Figure 14: the gyro is survived by most, the dead zone by none.
    assert!(judged("dlqr", "gyro").stabilised_share >= 0.7);
    assert!(judged("dlqr", "dead-zone").stabilised_share < 0.05);
    // Equation 1 is no way to tell speeds to this regulator.
    assert!(judged("dlqr-differences", "ideal").stabilised_share < 0.05);
}

#[test]
fn each_remedy_mends_what_it_is_made_for() {
    for (id, under) in [
        ("dead-zone-inverse", "dead-zone"),
        ("offset-observer", "eccentric"),
        ("lqg", "delay"),
        ("lqg", "gyro"),
        ("servo-model", "servo"),
        ("sliding", "delay"),
        ("robust", "masses"),
    ] {
        let judged = judged(id, under);
        assert!(
            judged.stabilised_share >= 0.9,
            "{id} under {under}: {judged:?}"
        );
    }
    assert!(judged("dlqr", "servo").stabilised_share < 0.05);
    assert!(judged("dlqr", "delay").stabilised_share < 0.05);
}

#[test]
fn names_are_told_once_and_found() {
    for (index, one) in DESIGNS.iter().enumerate() {
        let card = one.info();
        assert_eq!(design(card.id).unwrap().info().title, card.title);
        assert!(
            DESIGNS[..index]
                .iter()
                .all(|other| other.info().id != card.id)
        );
        assert!(!card.law.is_empty() && !card.reference.is_empty());
    }
    assert!(design("pid").is_none() && condition("rain").is_none());
}

#[test]
fn wrong_masses_destabilise_the_paper_s_gain_and_not_the_multi_model_one() {
    let model = model();
    let nominal = DesignModel::new(&model, &upright(&model), 0.01).unwrap();
    let sampled = zoh(&nominal.plant, 0.01, 0.0).unwrap();
    let (q, r) = (DMatrix::identity(6, 6), DMatrix::identity(2, 2));
    let multi = MultiModel {
        mass_error: MASS_ERROR,
        with_inertia: false,
        weight: WEIGHT,
    };
    let robust = multi.gain(&nominal, 0.0).unwrap();
    let case = Case::ideal(model, DEFAULT, 0.01);
    for with_inertia in [false, true] {
        let errors = MassErrors {
            case: &case,
            with_inertia,
            draws: 600,
            seed: 5,
        };
        let robots = errors.plants(0.1).unwrap();
        let unstable =
            |q: DMatrix<f64>| unstable_share(&radii(&robots, &dlqr(&sampled, &q, &r).unwrap().k));
        let (hundred, one) = (unstable(100.0 * &q), unstable(q.clone()));
        assert!((0.19..0.29).contains(&hundred), "{hundred}");
        assert!((0.12..0.22).contains(&one), "{one}");
        assert!(unstable_share(&radii(&robots, &robust)) <= 0.02);
    }
}

#[test]
fn the_longest_delay_is_the_one_of_the_eigenvalues() {
    let model = model();
    let pose = upright(&model);
    let known = DesignModel::new(&model, &pose, 0.01).unwrap();
    let longest = |id: &str, told: Option<f64>| {
        longest_linear(design(id).unwrap(), &known, told, 1e-3, 0.03).unwrap()
    };
    let dlqr_longest = longest("dlqr", Some(0.0));
    let (q, r) = known.weights().unwrap();
    let k = dlqr(&zoh(&known.plant, 0.01, 0.0).unwrap(), &q, &r)
        .unwrap()
        .k;
    // By eigenvalues of the loop with the late inputs as states.
    let stable = |delay_s: f64| {
        let plant = zoh(&known.plant, 0.01, delay_s).unwrap();
        let k = k.clone().resize(2, plant.a.nrows(), 0.0);
        let closed = &plant.a - &plant.b * k;
        closed
            .complex_eigenvalues()
            .iter()
            .all(|pole| pole.norm() < 1.0)
    };
    let most = dlqr_longest.delay_s.unwrap();
    assert!(stable(most) && !stable(most + 1e-3), "{most}");
    assert!(
        most < 0.01,
        "one sample of delay is too much for the paper's regulator"
    );
    let told = longest("best", None);
    assert!(told.open, "{told:?}");
    let one = longest("best", Some(0.01));
    assert!(one.tolerates(0.01) && !one.tolerates(0.0), "{one:?}");
}

#[test]
fn figures_are_the_same_on_any_number_of_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| judged("best", "all-masses"))
    };
    assert_eq!(on(1), on(3));
}

/// A model that `add` has written: servos, viscous and Coulomb friction.
#[test]
fn controllers_take_the_robot_behind_its_servos() {
    let text = include_str!("../../../models/robot.toml");
    let model = Model::parse(text, Path::new("robot.toml")).unwrap();
    let nominal = DesignModel::new(&model, &upright(&model), 0.01).unwrap();
    let omitted: Vec<_> = nominal
        .omitted
        .iter()
        .map(|o| (o.effect.info().id, o.joint.unwrap()))
        .collect();
    assert_eq!(omitted, [("coulomb", 1), ("coulomb", 2)]);
    assert_eq!(nominal.limit_nm, 2.0);
    let mut case = Case::ideal(model, design("dlqr").unwrap(), 0.01);
    let judging = Judging {
        runs: 20,
        start_rad: 0.5f64.to_radians(),
        seconds: 5.0,
        seed: 7,
    };
    let share = |case: &Case| judge(case, &[], &judging, &|| ()).unwrap().stabilised_share;
    let with_friction = share(&case);
    case.robot
        .effects
        .retain(|e| e.effect.info().id != "coulomb");
    assert!(
        share(&case) > with_friction,
        "friction that sticks must cost something"
    );
}

/// The paper's loop of a model that has these effects at these joints, from 0.
fn verified(effects: &[(&str, usize, &[f64])]) -> Verification {
    let mut model = model();
    model
        .effects
        .extend(effects.iter().map(|&(id, joint, values)| EffectInstance {
            effect: named(id).unwrap(),
            joint: Some(joint),
            values: values.to_vec(),
        }));
    let request = Request {
        pose_rad: upright(&model),
        weights: CostWeights::PAPER,
        integral: None,
        time: Time::Sampled {
            ts_s: 0.01,
            delay_s: None,
        },
        sensors: None,
        readings: Readings::default(),
        state_range: Weight::Diagonal(vec![0.5, 0.5, 0.5, 10.0, 10.0, 10.0]),
        input_range: None,
        format: Format::default(),
    };
    let made = Design::of(&model, &request).unwrap();
    let left_out = left_out(&model, &model, &made);
    assert_eq!(left_out.len(), effects.len());
    verify(&model, &made, &request, &left_out, &|| ()).unwrap()
}

/// Two joints of different servos, in one loop.
#[test]
fn what_limits_a_design_is_named() {
    let verified = verified(&[("coulomb", 0, &[1e-4]), ("dead_zone", 1, &[0.2, 0.0])]);
    let limiting = verified.limiting(LimitedFigure::Region).unwrap();
    assert_eq!(
        (limiting.effect, limiting.joint),
        ("dead_zone", Some(2)),
        "{verified:?}"
    );
    assert!(
        verified.region_as_designed_rad > verified.region_rad,
        "{verified:?}"
    );
    assert!(!verified.stabilised && verified.without.len() == 2);
}

/// Friction beyond the weight's torque near upright holds the robot without any gains.
#[test]
fn a_robot_that_friction_holds_is_said_to_stay_without_control() {
    let stuck = verified(&[
        ("coulomb", 0, &[2.0]),
        ("coulomb", 1, &[2.0]),
        ("coulomb", 2, &[2.0]),
    ]);
    assert!(stuck.stays_uncontrolled && stuck.held, "{stuck:?}");
    assert!(!stuck.stabilised && stuck.lasting.is_stable(), "{stuck:?}");
    assert_eq!(stuck.uncontrolled.stabilised, stuck.uncontrolled.runs);
    let free = verified(&[("coulomb", 0, &[1e-4])]);
    assert!(!free.stays_uncontrolled, "{free:?}");
    assert_eq!(free.uncontrolled.stabilised, 0, "{free:?}");
}

/// A design has the motor's inertia: without the gear the loop is the one designed, not one of a
/// motor less.
#[test]
fn a_gear_that_gives_limits_a_design_that_holds_with_a_rigid_one() {
    let soft: &[f64] = &[2e-3, 20.0, 0.2];
    let verified = verified(&[("gear_compliance", 1, soft), ("gear_compliance", 2, soft)]);
    assert!(!verified.stabilised, "{verified:?}");
    assert!(verified.region_as_designed_rad > 0.02, "{verified:?}");
}
